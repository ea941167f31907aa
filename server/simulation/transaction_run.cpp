// A transaction's course: backup, operations, trial steps, commit or rollback.
#include "simulation/clock.h"
#include "simulation/transaction.h"

namespace plab::simulation
{
namespace
{

/// Requests to the clock touch no component.
bool concerns_the_scene(const Operation& op)
{
    return std::holds_alternative<AddOperation>(op) || std::holds_alternative<RemoveOperation>(op) ||
           std::holds_alternative<SwapOperation>(op) || std::holds_alternative<SetOperation>(op) ||
           std::holds_alternative<PushOperation>(op);
}

bool starts_anew(const Operation& op) { return std::holds_alternative<ResetOperation>(op) || std::holds_alternative<LoadOperation>(op); }

std::string failure_in(const std::vector<Event>& events)
{
    for (const Event& e : events)
        if (e.severity == Severity::Failure) return e.kind + (e.message.empty() ? "" : ": " + e.message);
    return {};
}

}  // namespace

StepOutcome Transaction::try_step(std::string& failure)
{
    const std::uint64_t before = now_ns();
    s_->run_step(true);
    failure = failure_in(s_->stepper_->events());
    StepOutcome outcome;
    outcome.cost_ns = static_cast<double>(now_ns() - before);
    const Totals totals = s_->totals();
    outcome.energy = totals.kinetic + totals.stored, outcome.momentum = totals.momentum;
    return outcome;
}

void Transaction::compare_with_old(const State& before)
{
    std::string failure;
    outcome_old_ = try_step(failure);
    old_fails_ = !failure.empty();
    for (const Operation& op : request_->operations)
        if (const auto* swap = std::get_if<SwapOperation>(&op))
            if (auto component = find_typed(swap->id)) old_errors_.push_back(s_->error_of(*component));
    restore(before, false);
    energy_before_ = [&]
    {
        const Totals t = s_->totals();
        return t.kinetic + t.stored;
    }();
}

Result<void> Transaction::try_new()
{
    if (auto built = s_->stepper_->rebuild(); !built) return built;
    const State after = capture();
    std::string failure;
    const StepOutcome outcome = try_step(failure);
    std::size_t k = 0;
    for (SwapReport& report : reply_.swaps)
    {
        report.energy_before = energy_before_, report.with_old = outcome_old_, report.with_new = outcome;
        if (k < old_errors_.size()) report.with_old.error = old_errors_[k++];
        report.with_new.error = s_->error_of(s_->world_->find(report.id));
    }
    if (!failure.empty() && !old_fails_) return reason("the first step failed: " + failure);
    restore(after, false);
    return {};
}

Reply Transaction::run()
{
    const std::uint64_t begin = now_ns();
    bool scene = false, anew = false, swaps = false;
    for (const Operation& op : request_->operations)
    {
        scene = scene || concerns_the_scene(op), anew = anew || starts_anew(op);
        swaps = swaps || std::holds_alternative<SwapOperation>(op);
    }
    if (anew && request_->operations.size() > 1)
        reply_.errors = {reason("reset and load stand alone in a request")};
    else if (scene)
        run_on_scene(swaps);
    else
        for (const Operation& op : request_->operations)
            if (auto done = apply(op); !done) reply_.errors.insert(reply_.errors.end(), done.errors().begin(), done.errors().end());
    reply_.done = reply_.errors.empty();
    if (reply_.done && structural_) ++s_->revision_;
    if (!reply_.done) reply_.swaps.clear();
    reply_.revision = s_->revision_;
    reply_.pause_ns = static_cast<double>(now_ns() - begin);
    return std::move(reply_);
}

void Transaction::run_on_scene(bool swaps)
{
    const State before = capture();
    const auto clock = std::tuple(s_->paused_, s_->steps_left_, s_->rate_, s_->dt_, s_->base_tick_, s_->base_time_);
    if (swaps) compare_with_old(before);
    for (const Operation& op : request_->operations)
        if (auto done = apply(op); !done)
        {
            reply_.errors = done.errors();
            break;
        }
    if (reply_.errors.empty())
        if (auto done = try_new(); !done) reply_.errors = done.errors();
    if (reply_.errors.empty())
    {
        s_->world_->release_parked();
        return;
    }
    restore(before, true);
    std::tie(s_->paused_, s_->steps_left_, s_->rate_, s_->dt_, s_->base_tick_, s_->base_time_) = clock;
}

}  // namespace plab::simulation
