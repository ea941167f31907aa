#include "automatic.h"

namespace plab::response
{

void AutomaticRows::describe(Schema& s)
{
    s.role(manager, "manager", {Facet::Component}, "advances the islands of these contacts")
        .family("Manager/")
        .default_type("Manager/Automatic");
    impulse.describe(s);
}

void respond_automatically(const StepContext& context, Row row, AutomaticRows& rows, Bodies& bodies, Impact& impact)
{
    respond(context, row, rows.impulse, bodies, impact);
}

}  // namespace plab::response
