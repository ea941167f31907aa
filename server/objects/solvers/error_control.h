/// What solvers that choose their internal steps by an error estimate have in common: parameters, counts, giving up.
#pragma once

#include <string_view>

#include "plab/registrar.h"

namespace plab::solvers
{

struct SubstepCounts
{
    std::int64_t accepted = 0, refused = 0, evaluations = 0;
    double reached = 0;  ///< s, where the last accepted internal step ended
};

struct ErrorControlRows
{
    Column<double> relative_tolerance, absolute_tolerance;
    Column<std::int64_t> max_substeps;
    Column<std::int64_t> substeps, refused, evaluations;

    void describe_control(Schema& schema);
    void report(Row row, const SubstepCounts& counts);
};

/// The event solver.gave_up; `advice` ends its message.
void tell_gave_up(const StepContext& start, Row row, const SubstepCounts& counts, std::string_view advice);

}  // namespace plab::solvers
