// The trials of a transaction: one step with the old components and one with the new ones, for the objects that the request can affect.
#include <algorithm>
#include <cmath>
#include <limits>

#include "model/names.h"
#include "model/numbers.h"
#include "simulation/costs/clock.h"
#include "simulation/requests/request_words.h"
#include "simulation/transaction/transaction.h"

namespace plab::simulation
{
namespace
{

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const StepOutcome kNotTried{kNaN, {kNaN, kNaN, kNaN}, kNaN, kNaN};

constexpr double kLeastBudget = 5e6;    // ns
constexpr double kUnknownBudget = 1e8;  // ns, as long as no step has been timed
constexpr double kStepsOfBudget = 10;
/// Share of the budget after which no step is repeated for the sake of timing. kMeasureUnlimited, in ns, applies if there is no budget.
constexpr double kMeasureOld = 0.45, kMeasureNew = 0.95;
constexpr double kMeasureUnlimited = 2e7;
constexpr double kMostToMeasure = 4e6;  // ns, of a budget that the request does not name
/// With such a budget, a swap is tried on so many objects that a step of them costs about kSampleStep, ns, but on kLeastSample or more.
constexpr double kSampleStep = 2.5e5;
constexpr std::size_t kLeastSample = 128;

bool adds(const Operation& op) { return std::holds_alternative<AddOperation>(op) || std::holds_alternative<AddBlueprintOperation>(op); }

std::chrono::nanoseconds as_duration(double ns) { return std::chrono::nanoseconds(static_cast<std::int64_t>(std::clamp(ns, 0.0, 1e18))); }

}  // namespace

Result<void> Transaction::expand(const SwapOperation& op, std::vector<Operation>& out) const
{
    const world::World& world = run_->world();
    const std::vector<std::string> known = run_->world().types().names();
    std::size_t named = 0;
    const std::size_t first = out.size();
    for (const std::uint32_t i : world.in_id_order())
    {
        const world::Component& c = world.component(i);
        if (c.table == kNoIndex || !model::matches(op.id, c.id)) continue;
        ++named;
        // A short type name is completed with the family of the component.
        const std::string& from = world.type_of(i)->info.name;
        const auto name = model::full_type_name(op.type, known, from.substr(0, from.rfind('/') + 1));
        if (!name) continue;
        const auto type = run_->world().types().require(*name);
        if (!type || !(*type)->why_not_exchangeable(*world.type_of(i)).empty()) continue;
        SwapOperation one = op;
        one.id = c.id;
        out.push_back(std::move(one));
    }
    if (out.size() > first) return {};
    if (named == 0) return Error{{}, op.id, "no component's id matches"};
    return Error{{}, op.id, "matches " + std::to_string(named) + " components, none of which can be exchanged for " + op.type};
}

Result<void> Transaction::expand_patterns()
{
    const auto has_pattern = [](const Operation& op)
    {
        const auto* swap = std::get_if<SwapOperation>(&op);
        return swap && model::is_pattern(swap->id);
    };
    if (std::none_of(request_->operations.begin(), request_->operations.end(), has_pattern)) return {};
    for (const Operation& op : request_->operations)
    {
        if (!has_pattern(op))
            operations_.push_back(op);
        else if (auto done = expand(std::get<SwapOperation>(op), operations_); !done)
            return done;
    }
    return {};
}

void Transaction::mark_touched(TrialScope& scope) const
{
    const auto mark = [&](const std::string& id)
    {
        // A component that an earlier operation of this request adds does not exist yet, and one that it removes no longer exists.
        if (const auto component = find_typed(id))
            scope.add(*component);
        else
            scope.add_everything();
    };
    if (request_->trial.everything) scope.add_everything();
    for (const Operation& operation : operations())
    {
        if (const auto* swap = std::get_if<SwapOperation>(&operation))
            mark(swap->id);
        else if (const auto* set = std::get_if<SetOperation>(&operation))
            mark(set->id);
        else if (const auto* push = std::get_if<PushOperation>(&operation))
            mark(push->id);
        else if (affects_the_run(operation) && !(adds(operation) && !added_.empty()))
            scope.add_everything();
    }
    for (const std::string& id : added_)
        if (const std::uint32_t i = run_->world().find(id); i != kNoIndex) scope.add_new(i);
}

TrialStep Transaction::next_step() const
{
    const double start = run_->clock.time_at(run_->clock.tick);
    const bool looked = looked_ && run_->world().revisions().keeps_bodies_since(revisions_before_);
    return {.tick = run_->clock.tick, .start = start, .h = run_->clock.time_at(run_->clock.tick + 1) - start, .looked = looked};
}

double Transaction::budget_ns() const
{
    switch (request_->trial.budget)
    {
        case TrialChoice::Budget::Unlimited:
            return std::numeric_limits<double>::infinity();
        case TrialChoice::Budget::Given:
            return request_->trial.ns;
        case TrialChoice::Budget::None:
            return 0;
        case TrialChoice::Budget::Automatic:
            break;
    }
    return context_->mean_step_ns > 0 ? std::max(kLeastBudget, kStepsOfBudget * context_->mean_step_ns) : kUnknownBudget;
}

/// A pause of two steps of everything is too long for a loop that others watch. Who names a budget, or wants no exchange without a trial,
/// gets all of it.
std::size_t Transaction::most_in_trial() const
{
    const TrialChoice& choice = request_->trial;
    if (choice.most != 0 || choice.everything || choice.must || choice.budget != TrialChoice::Budget::Automatic) return choice.most;
    if (!(context_->mean_step_ns > 0)) return 0;
    const world::HostTables& host = run_->world().host();
    const auto objects = static_cast<double>(host.bodies.size() + host.shafts.size() + host.quantities.size());
    return std::max(kLeastSample, static_cast<std::size_t>(objects * std::min(1.0, kSampleStep / context_->mean_step_ns)));
}

std::vector<std::uint32_t> Transaction::swapped() const
{
    std::vector<std::uint32_t> out;
    for (const Operation& op : operations())
        if (const auto* swap = std::get_if<SwapOperation>(&op))
        {
            // A component that an earlier operation of this request adds does not exist yet: it has no error to compare.
            const auto component = find_typed(swap->id);
            out.push_back(component ? *component : kNoIndex);
        }
    return out;
}

std::uint64_t Transaction::measure_until(double share) const
{
    if (request_->trial.budget == TrialChoice::Budget::Unlimited) return now_ns() + static_cast<std::uint64_t>(kMeasureUnlimited);
    // The budget of a large scene is large because one step has to fit into it, not for the sake of timing.
    const double ns = request_->trial.budget == TrialChoice::Budget::Automatic ? std::min(kMostToMeasure, budget_ns()) : budget_ns();
    return trial_begin_ + static_cast<std::uint64_t>(std::clamp(share * ns, 0.0, 1e18));
}

void Transaction::try_old(TrialScope& scope)
{
    const double budget = budget_ns();
    scope.limit_to(most_in_trial());
    Interruption deadline(context_->interruption);
    // The other half is for the new components, whose trial decides whether the request takes effect.
    if (std::isfinite(budget)) deadline.ask(as_duration(0.5 * budget));
    context_->progress.begin(Activity::TrialOfOld, run_->clock.tick, now_ns());
    old_ =
        Trial(run_->world(), run_->stepper(), next_step()).run(scope, swapped(), deadline, context_->progress, measure_until(kMeasureOld));
    context_->progress.end();
    old_tried_ = !old_.given_up;
    // The new components are tried on the objects that the old ones were tried on: their figures are compared.
    if (!scope.is_sample()) scope.limit_to(0);
}

Result<void> Transaction::try_new(TrialScope& scope)
{
    TrialReport& reported = reply_.trial;
    reported.budget_ns = budget_ns();
    Interruption deadline(context_->interruption);
    const double spent = static_cast<double>(now_ns() - trial_begin_);
    if (std::isfinite(reported.budget_ns)) deadline.ask(as_duration(reported.budget_ns - spent));
    context_->progress.begin(Activity::TrialOfNew, run_->clock.tick, now_ns());
    std::vector<std::uint32_t> components;
    for (const SwapReport& report : reply_.swaps) components.push_back(run_->world().find(report.id));
    const TrialResult with_new =
        Trial(run_->world(), run_->stepper(), next_step())
            .run(scope, components, deadline, context_->progress, reply_.swaps.empty() ? 0 : measure_until(kMeasureNew));
    context_->progress.end();
    reported.ns = static_cast<double>(now_ns() - trial_begin_), reported.objects = scope.objects(),
    reported.everything = scope.has_everything();
    if (scope.is_sample()) reported.sample_of = scope.concerned(), reported.held = scope.holds_neighbours();
    reported.outcome = with_new.given_up                      ? TrialReport::Outcome::GivenUp
                       : !reply_.swaps.empty() && !old_tried_ ? TrialReport::Outcome::WithoutOld
                                                              : TrialReport::Outcome::Made;
    write_reports(with_new);
    if (context_->interruption && context_->interruption->due()) return reason("the server is shutting down: the trial was interrupted");
    if (with_new.given_up)
    {
        if (!request_->trial.must) return {};
        return reason("its trial took longer than its budget of " + model::format_real(1e-6 * reported.budget_ns) +
                      " ms and was interrupted, and the request must not take effect without a trial");
    }
    if (!with_new.failure.empty() && (!old_tried_ || old_.failure.empty())) return reason("the first step failed: " + with_new.failure);
    if (const std::string why = makes_energy(with_new); !why.empty()) return reason(why);
    return {};
}

void Transaction::write_reports(const TrialResult& with_new)
{
    const bool is_new = reply_.trial.outcome != TrialReport::Outcome::None && reply_.trial.outcome != TrialReport::Outcome::GivenUp;
    TrialReport& reported = reply_.trial;
    reported.with_old = old_.cost, reported.with_new = is_new ? with_new.cost : Spread{};
    for (std::size_t k = 0; k < reply_.swaps.size(); ++k)
    {
        SwapReport& report = reply_.swaps[k];
        report.energy_before = old_tried_ ? old_.before : is_new ? with_new.before : energy_before_;
        report.with_old = old_tried_ ? old_.outcome : kNotTried;
        report.with_new = is_new ? with_new.outcome : kNotTried;
        report.with_new.cost_ns = reported.with_new.is_known() ? reported.with_new.median : kNaN;
        report.with_old.cost_ns = costs_differ(reported.with_old, reported.with_new) ? reported.with_old.median : kNaN;
        if (old_tried_ && k < old_.errors.size()) report.with_old.error = old_.errors[k];
        if (is_new && k < with_new.errors.size()) report.with_new.error = with_new.errors[k];
    }
}

/// Detects motion without a source: more kinetic energy than before and also more total energy. Energy that a spring or gravity releases
/// is no gain in total, and a field of a different strength changes stored energy without creating motion.
std::string Transaction::makes_energy(const TrialResult& with_new) const
{
    if (reply_.swaps.empty() || !std::isfinite(request_->trial.energy_factor)) return {};
    const double scale = std::max({with_new.least, with_new.moving, old_tried_ ? old_.moving : 0.0, old_tried_ ? old_.kinetic_after : 0.0});
    // What the swap changed at once: of a sample only its own share counts.
    const double at_once = reply_.trial.sample_of == 0 ? energy_applied_ - energy_before_
                           : old_tried_                ? with_new.before - old_.before
                                                       : 0.0;
    const double gain = at_once + with_new.outcome.energy - with_new.before;
    const double made = std::min(with_new.kinetic_after, gain);
    if (!(made > request_->trial.energy_factor * scale)) return {};
    return "the first step would raise the kinetic energy of the objects concerned from " + model::format_real(with_new.moving) + " J to " +
           model::format_real(with_new.kinetic_after) + " J without a source of that energy: a gain of more than " +
           model::format_real(request_->trial.energy_factor) +
           " times has to be allowed explicitly (energy FACTOR; plabctl: --allow-energy)";
}

}  // namespace plab::simulation
