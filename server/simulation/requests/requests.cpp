#include "simulation/requests/requests.h"

#include <algorithm>

namespace plab::simulation
{
namespace
{

template <class... Kinds>
bool is_any_of(const Operation& operation)
{
    return (std::holds_alternative<Kinds>(operation) || ...);
}

}  // namespace

bool begins_a_run(const Operation& operation)
{
    return is_any_of<ResetOperation, LoadOperation, RestoreOperation, RewindOperation>(operation);
}

bool concerns_the_course(const Operation& operation)
{
    return !is_any_of<PauseOperation, ResumeOperation, StepOperation, RateOperation, SnapshotOperation, ForgetOperation>(operation);
}

bool concerns_the_course(const Request& request)
{
    return std::any_of(request.operations.begin(), request.operations.end(), [](const Operation& op) { return concerns_the_course(op); });
}

}  // namespace plab::simulation
