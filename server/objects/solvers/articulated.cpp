#include "articulated.h"

#include "plab/minimal_coordinates.h"

namespace plab::solvers
{

void ArticulatedRows::describe(Schema& schema)
{
    DormandPrince54Rows::describe(schema);
    ResolvedColumns::describe(schema);
}

void advance_articulated(const StepContext& context, Row row, ArticulatedRows& rows, DynamicSystem& system)
{
    const StepContext start = context;  // evaluations change the host's context
    auto* const minimal = dynamic_cast<MinimalCoordinates*>(&system);
    const std::string_view reason = minimal ? minimal->use_minimal_coordinates() : "the host has no minimal coordinates";
    if (reason.empty())
        rows.say(start, row, system.is_constrained() ? "Articulated" : "DormandPrince54");
    else
        rows.fall_back(start, row, Fallback::NotTree, "DormandPrince54", reason);
    advance_dormand_prince54(start, row, rows, system);
}

}  // namespace plab::solvers
