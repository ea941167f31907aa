// The order of a transaction: backup, operations, commit or rollback. The trials are in transaction_trial.cpp.
#include <algorithm>

#include "model/alike.h"
#include "simulation/costs/clock.h"
#include "simulation/transaction/transaction.h"

namespace plab::simulation
{
namespace
{

/// Operations on the clock affect no component.
bool concerns_the_scene(const Operation& op)
{
    return std::holds_alternative<AddOperation>(op) || std::holds_alternative<AddBlueprintOperation>(op) ||
           std::holds_alternative<RemoveOperation>(op) || std::holds_alternative<SwapOperation>(op) ||
           std::holds_alternative<SetOperation>(op) || std::holds_alternative<PushOperation>(op);
}

}  // namespace

std::size_t Transaction::held_points(std::uint32_t component) const
{
    const Stepper& stepper = run_->stepper();
    const auto concerned = [&](std::uint32_t detector)
    {
        const auto is_it = [&](const Detector& d)
        {
            const bool part = d.component == component || d.resolution == component || d.response == component || d.manager == component;
            return d.component == detector && part;
        };
        return std::any_of(stepper.detectors().begin(), stepper.detectors().end(), is_it);
    };
    if (!concerns_contacts(run_->world(), component)) return 0;
    std::size_t n = 0;
    for (const PairState& p : stepper.contacts().pairs()) n += p.resting && !p.ahead && concerned(p.detector) ? p.count : 0;
    for (const ForcePair& p : stepper.contacts().force_pairs()) n += concerned(p.detector) ? p.count : 0;
    return n;
}

void Transaction::report_contacts()
{
    const auto report_points = [](SwapReport& report, std::size_t n, FieldTransfer transfer)
    {
        if (n > 0) report.fields.push_back({"contacts (" + std::to_string(n) + " points)", transfer});
    };
    for (std::size_t k = 0; k < reply_.swaps.size(); ++k)
    {
        SwapReport& report = reply_.swaps[k];
        const std::uint32_t i = run_->world().find(report.id);
        if (i == kNoIndex) continue;
        const std::size_t converted = run_->stepper().forces().converted(i), held = held_points(i);
        report_points(report, converted, FieldTransfer::Converted);
        if (converted > 0) continue;
        report_points(report, held, FieldTransfer::Kept);
        if (k < held_before_.size() && held_before_[k] > held) report_points(report, held_before_[k] - held, FieldTransfer::Lost);
    }
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
        reply_.errors = {reason("the request has no operations")};
    else if (anew && request_->operations.size() > 1)
        reply_.errors = {reason("reset, load, restore and rewind must be the only operation of a request")};
    else if (scene)
        run_on_scene(swaps);
    else
        run_on_clock();
    reply_.done = reply_.errors.empty();
    if (reply_.done && (structural_ || anew)) ++run_->revision;
    if (reply_.done) run_->changes.touched.insert(run_->changes.touched.end(), touched_.begin(), touched_.end());
    if (!reply_.done) reply_.swaps.clear();
    reply_.revision = run_->revision;
    if (reply_.done && anew) reply_.step = run_->clock.tick;
    reply_.pause_ns = static_cast<double>(now_ns() - begin);
    return std::move(reply_);
}

Transaction::Clock Transaction::read_clock() const
{
    return {run_->clock.paused, run_->clock.steps_left, run_->clock.rate, run_->clock.dt, run_->clock.base_tick, run_->clock.base_time};
}

void Transaction::write_clock(const Clock& clock)
{
    std::tie(run_->clock.paused, run_->clock.steps_left, run_->clock.rate, run_->clock.dt, run_->clock.base_tick, run_->clock.base_time) =
        clock;
}

/// Whether the contacts may change, apart from additions and removals.
bool Transaction::changes_contacts() const
{
    const auto concerned = [&](const std::string& id)
    {
        const auto component = find_typed(id);
        return !component || concerns_contacts(run_->world(), *component);
    };
    for (const Operation& op : operations())
    {
        if (const auto* swap = std::get_if<SwapOperation>(&op); swap && concerned(swap->id)) return true;
        if (const auto* set = std::get_if<SetOperation>(&op); set && concerned(set->id)) return true;
    }
    return false;
}

void Transaction::apply_all()
{
    for (const Operation& op : operations())
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

Result<void> Transaction::build_and_try(TrialScope& scope, bool swaps)
{
    if (auto built = run_->live.rebuild(); !built) return model::first_of_alike(built.errors());
    report_contacts();
    energy_applied_ = energy_before_;
    if (!run_->world().revisions().only_solvers_since(revisions_before_))
    {
        const Energies now = energies_of(run_->world(), run_->stepper(), run_->clock.time(), run_->clock.tick);
        energy_applied_ = now.kinetic + now.stored;
        run_->stepper().requests_work() += now.kinetic - kinetic_before_;
    }
    if (!request_->trial.is_wanted())
    {
        if (swaps) write_reports({});
        return {};
    }
    mark_touched(scope);
    return try_new(scope);
}

void Transaction::run_on_scene(bool swaps)
{
    if (auto expanded = expand_patterns(); !expanded)
    {
        reply_.errors = expanded.errors();
        return;
    }
    trial_begin_ = now_ns();
    run_->stepper().contacts().bring_back(run_->world());
    saved_.begin(*run_, changes_contacts());
    const Clock clock = read_clock();
    const Energies first = energies_of(run_->world(), run_->stepper(), run_->clock.time(), run_->clock.tick);
    energy_before_ = first.kinetic + first.stored, kinetic_before_ = first.kinetic;
    revisions_before_ = run_->world().revisions();
    looked_ = request_->trial.is_wanted() && run_->stepper().has_looked_at_all();
    TrialScope scope(run_->world());
    if (swaps && request_->trial.is_wanted()) mark_touched(scope), try_old(scope);
    apply_all();
    if (reply_.errors.empty())
        if (auto done = build_and_try(scope, swaps); !done) reply_.errors = done.errors();
    if (reply_.errors.empty())
    {
        saved_.end();
        run_->world().release_parked();
        return;
    }
    saved_.restore(prepared_);
    write_clock(clock);
}

Result<FirstStep> Transaction::first_step(const FirstStepChoice& choice)
{
    if (auto expanded = expand_patterns(); !expanded) return expanded.errors();
    saved_.begin(*run_, changes_contacts());
    revisions_before_ = run_->world().revisions(), looked_ = run_->stepper().has_looked_at_all();
    TrialScope scope(run_->world());
    mark_touched(scope);
    FirstStep out;
    apply_all();
    if (reply_.errors.empty())
    {
        Interruption deadline(context_->interruption);
        if (request_->trial.budget == TrialChoice::Budget::Given)
            deadline.ask(std::chrono::nanoseconds(static_cast<std::int64_t>(budget_ns())));
        TrialStep step = next_step();
        step.count = choice.steps, step.course = true, step.energies = choice.energies, step.end = choice.end,
        step.measure_ns = choice.measure_ns;
        // The scene's stepper is not rebuilt, so what depends on the structure, such as the anchors of coupled shafts, is the trial's own.
        step.derives = !run_->world().revisions().only_solvers_since(revisions_before_);
        TrialResult result = Trial(run_->world(), run_->stepper(), step).run(scope, {}, deadline, context_->progress, 0);
        if (result.given_up) reply_.errors = {reason("the trial was interrupted")};
        if (!result.failure.empty()) reply_.errors = {reason(result.failure)};
        out.course = std::move(result.course), out.energies = std::move(result.energies);
        if (result.cost.is_known()) out.seconds = 1e-9 * result.cost.median;
    }
    saved_.restore_world(prepared_);
    if (!reply_.errors.empty()) return reply_.errors;
    return out;
}

}  // namespace plab::simulation
