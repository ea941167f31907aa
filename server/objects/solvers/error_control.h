/// Common parts of solvers that choose internal steps by an error estimate: parameters, counts, and giving up.
#pragma once

#include <string_view>

#include "plab/registrar.h"

namespace plab::solvers
{

struct SubstepCounts
{
    std::int64_t accepted = 0, refused = 0, evaluations = 0;
    double reached = 0;  ///< s, the end of the last accepted internal step
};

struct ErrorControlRows
{
    Column<double> relative_tolerance, absolute_tolerance;
    Column<std::int64_t> max_substeps;
    Column<std::int64_t> substeps, refused, evaluations;

    void describe_control(Schema& schema);
    void report(Row row, const SubstepCounts& counts);
};

/// Emits the event solver.gave_up; `advice` is the end of its message.
void report_gave_up(const StepContext& start, Row row, const SubstepCounts& counts, std::string_view advice);

}  // namespace plab::solvers
