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

bool affects_the_run(const Operation& operation)
{
    return !is_any_of<PauseOperation, ResumeOperation, StepOperation, RateOperation, SnapshotOperation, ForgetOperation>(operation);
}

bool affects_the_run(const Request& request)
{
    return std::any_of(request.operations.begin(), request.operations.end(), [](const Operation& op) { return affects_the_run(op); });
}

}  // namespace plab::simulation
