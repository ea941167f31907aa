// A transaction's course: backup, operations, trial steps, commit or rollback.
#include <algorithm>

#include "simulation/clock.h"
#include "simulation/requests/transaction.h"

namespace plab::simulation
{
namespace
{

/// Requests to the clock touch no component.
bool concerns_the_scene(const Operation& op)
{
    return std::holds_alternative<AddOperation>(op) || std::holds_alternative<AddBlueprintOperation>(op) ||
           std::holds_alternative<RemoveOperation>(op) || std::holds_alternative<SwapOperation>(op) ||
           std::holds_alternative<SetOperation>(op) || std::holds_alternative<PushOperation>(op);
}

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

void Transaction::measure_again(const State& state, StepOutcome& outcome)
{
    // The first step after a copy of everything finds cold caches, and a new
    // component allocates: not what it will cost. A long step hardly shows that,
    // and is not worth holding the loop up twice.
    constexpr double kShort = 1e6;  // ns
    if (outcome.cost_ns >= kShort) return;
    restore(state, false);
    std::string failure;
    outcome.cost_ns = std::min(outcome.cost_ns, try_step(failure).cost_ns);
}

void Transaction::compare_with_old(const State& before)
{
    std::string failure;
    outcome_old_ = try_step(failure);
    measure_again(before, outcome_old_);
    old_fails_ = !failure.empty();
    for (const Operation& op : request_->operations)
        if (const auto* swap = std::get_if<SwapOperation>(&op))
        {
            // What an earlier operation of the request adds is not there yet: it had
            // no error.
            const auto component = find_typed(swap->id);
            old_errors_.push_back(component ? s_->error_of(*component) : 0.0);
        }
    restore(before, false);
    energy_before_ = [&]
    {
        const Totals t = s_->totals();
        return t.kinetic + t.stored;
    }();
}

std::size_t Transaction::held_points(std::uint32_t component) const
{
    const Stepper& stepper = *s_->stepper_;
    const auto concerned = [&](std::uint32_t detector)
    {
        const auto is_it = [&](const Detector& d)
        {
            const bool part = d.component == component || d.resolution == component || d.response == component || d.manager == component;
            return d.component == detector && part;
        };
        return std::any_of(stepper.detectors().begin(), stepper.detectors().end(), is_it);
    };
    std::size_t n = 0;
    for (const PairState& p : stepper.contacts().pairs()) n += p.resting && !p.ahead && concerned(p.detector) ? p.count : 0;
    for (const ForcePair& p : stepper.contacts().force_pairs()) n += concerned(p.detector) ? p.count : 0;
    return n;
}

void Transaction::tell_contacts()
{
    const auto tell = [](SwapReport& report, std::size_t n, Fate fate)
    {
        if (n > 0) report.fields.push_back({"contacts (" + std::to_string(n) + " points)", fate});
    };
    for (std::size_t k = 0; k < reply_.swaps.size(); ++k)
    {
        SwapReport& report = reply_.swaps[k];
        const std::uint32_t i = s_->world_->find(report.id);
        if (i == kNoIndex) continue;
        const std::size_t converted = s_->stepper_->forces().converted(i), held = held_points(i);
        tell(report, converted, Fate::Converted);
        if (converted > 0) continue;
        tell(report, held, Fate::Kept);
        if (k < held_before_.size() && held_before_[k] > held) tell(report, held_before_[k] - held, Fate::Lost);
    }
}

Result<void> Transaction::try_new()
{
    if (auto built = s_->stepper_->rebuild(); !built) return built;
    tell_contacts();
    const State after = capture();
    std::string failure;
    StepOutcome outcome = try_step(failure);
    if (failure.empty() && !reply_.swaps.empty()) measure_again(after, outcome);
    std::size_t k = 0;
    for (SwapReport& report : reply_.swaps)
    {
        report.energy_before = energy_before_, report.with_old = outcome_old_, report.with_new = outcome;
        if (k < old_errors_.size()) report.with_old.error = old_errors_[k++];
        // A later operation of the request may have removed it.
        if (const std::uint32_t i = s_->world_->find(report.id); i != kNoIndex) report.with_new.error = s_->error_of(i);
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
        scene = scene || concerns_the_scene(op), anew = anew || begins_a_run(op);
        swaps = swaps || std::holds_alternative<SwapOperation>(op);
    }
    if (request_->operations.empty())
        reply_.errors = {reason("a request without operations")};
    else if (anew && request_->operations.size() > 1)
        reply_.errors = {reason("reset, load, restore and rewind stand alone in a request")};
    else if (scene)
        run_on_scene(swaps);
    else
        run_on_clock();
    reply_.done = reply_.errors.empty();
    if (reply_.done && (structural_ || anew)) ++s_->revision_;
    if (reply_.done) s_->changes_.touched.insert(s_->changes_.touched.end(), touched_.begin(), touched_.end());
    if (!reply_.done) reply_.swaps.clear();
    reply_.revision = s_->revision_;
    if (reply_.done && anew) reply_.step = s_->tick_;
    reply_.pause_ns = static_cast<double>(now_ns() - begin);
    return std::move(reply_);
}

Transaction::Clock Transaction::read_clock() const
{
    return {s_->paused_, s_->steps_left_, s_->rate_, s_->dt_, s_->base_tick_, s_->base_time_};
}

void Transaction::write_clock(const Clock& clock)
{
    std::tie(s_->paused_, s_->steps_left_, s_->rate_, s_->dt_, s_->base_tick_, s_->base_time_) = clock;
}

void Transaction::apply_all()
{
    for (const Operation& op : request_->operations)
        if (auto done = apply(op); !done)
        {
            reply_.errors = done.errors();
            return;
        }
}

void Transaction::run_on_clock()
{
    const Clock clock = read_clock();
    const bool anew = begins_a_run(request_->operations.front());
    apply_all();
    if (!reply_.errors.empty() && !anew) write_clock(clock);
}

void Transaction::run_on_scene(bool swaps)
{
    const State before = capture();
    const Clock clock = read_clock();
    const double kinetic = s_->totals().kinetic;
    if (swaps) compare_with_old(before);
    apply_all();
    if (reply_.errors.empty()) s_->stepper_->requests_work() += s_->totals().kinetic - kinetic;
    if (reply_.errors.empty())
        if (auto done = try_new(); !done) reply_.errors = done.errors();
    if (reply_.errors.empty())
    {
        s_->world_->release_parked();
        return;
    }
    restore(before, true);
    write_clock(clock);
}

}  // namespace plab::simulation
