// What components decide before a step (Phase::Decide), carried out like requests of clients.
#include <algorithm>
#include <cmath>
#include <limits>

#include "simulation/costs/clock.h"
#include "simulation/simulation.h"

namespace plab::simulation
{
namespace
{

/// How far two objects, or two courses, are apart: m, of a point of a body; rad, of a body or a shaft. NaN: there is no such object. J, of
/// all objects; NaN: not asked for.
struct Apart
{
    double distance = std::numeric_limits<double>::quiet_NaN(), angle = std::numeric_limits<double>::quiet_NaN();
    double energy = std::numeric_limits<double>::quiet_NaN();
};

void raise(double& largest, double value) { largest = std::isnan(largest) ? value : std::max(largest, value); }

void raise(Apart& largest, const ObjectMotion& a, const ObjectMotion& b)
{
    if (a.object.facet == Facet::Shaft) return raise(largest.angle, std::fabs(a.angle - b.angle));
    const Quat turn = conjugate(a.orientation) * b.orientation;
    const double angle = 2 * std::atan2(length(Vec3{turn.x, turn.y, turn.z}), std::fabs(turn.w));
    raise(largest.distance, length(a.position - b.position) + (std::isfinite(a.radius) ? a.radius : 0) * angle);
    raise(largest.angle, angle);
}

/// How far two courses depart from one another in a step, if that is more than before. One of them may have touched more objects.
void raise(Apart& largest, const std::vector<ObjectMotion>& a, const std::vector<ObjectMotion>& b)
{
    for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();)
        if (a[i].object == b[k].object)
            raise(largest, a[i++], b[k++]);
        else
            a[i].object < b[k].object ? ++i : ++k;
}

/// The largest departure of the two courses up to each step.
std::vector<Apart> departures(const FirstStep& one, const FirstStep& other)
{
    std::vector<Apart> out;
    Apart largest;
    for (std::size_t n = 0; n < std::min(one.course.size(), other.course.size()); ++n)
    {
        raise(largest, one.course[n], other.course[n]);
        // Of different sets of objects the energies cannot be compared.
        if (n < std::min(one.energies.size(), other.energies.size()) && one.course[n].size() == other.course[n].size())
            raise(largest.energy, std::fabs(one.energies[n] - other.energies[n]));
        out.push_back(largest);
    }
    return out;
}

/// What a departure becomes within n steps, if it was d_k after k steps and d_m after m. Each step errs alike: what it errs in place adds
/// up, and what it errs in speed counts once more in each step after it,
///
///   d_n = a n + b n (n - 1) / 2,   a, b >= 0.
///
/// What oscillates looks slower for a while, and is taken to grow linearly (b = 0).
double continued(double d_k, double d_m, double k, double m, double n)
{
    if (!(d_m > 0) || n <= m) return d_m;
    const double pairs_k = k * (k - 1) / 2, pairs_m = m * (m - 1) / 2, pairs_n = n * (n - 1) / 2;
    if (!(pairs_m > 0)) return d_m * n / m;
    const double most = d_m / pairs_m;  // all of it an error in speed
    const double b = k < m ? std::clamp((d_m / m - d_k / k) / (pairs_m / m - pairs_k / k), 0.0, most) : most;
    return (d_m - b * pairs_m) / m * n + b * pairs_n;
}

std::string file_of(const world::World& world, std::uint32_t component)
{
    const model::ComponentSpec* spec = world.scene().find(world.id_of(component));
    return spec ? spec->where.file : std::string();
}

/// What was added or removed.
std::vector<std::string> ids_in(const std::vector<Operation>& operations)
{
    std::vector<std::string> out;
    for (const Operation& operation : operations)
    {
        if (const auto* gone = std::get_if<RemoveOperation>(&operation)) out.push_back(gone->id);
        if (const auto* added = std::get_if<AddBlueprintOperation>(&operation))
            for (const model::ComponentNode& node : added->blueprint->components) out.push_back(node.id);
    }
    return out;
}

}  // namespace

/// What the first steps would be with a level. Fewer than asked for if `choice.end` says so; then they are made again for whoever needs
/// more.
const Result<FirstStep>& Simulation::step_with(std::uint32_t component, const Level& level, const FirstStepChoice& choice)
{
    if (!tried_.empty() && tried_.front().component != component) tried_.clear();
    const auto known = std::find_if(tried_.begin(), tried_.end(), [&](const Tried& t) { return t.level == &level; });
    if (known != tried_.end())
    {
        if (!known->step || known->step->course.size() >= static_cast<std::size_t>(choice.steps)) return known->step;
        tried_.erase(known);
    }
    Request request;
    request.operations.push_back(SwapOperation{run_.world().id_of(component), level.type, level.values});
    request.trial.budget = TrialChoice::Budget::Unlimited;  // a limit by the clock would make decisions depend on it
    return tried_.emplace_back(Tried{component, &level, Transaction(run_, context_, *this, request).first_step(choice)}).step;
}

/// How many steps of an interval of `whole` steps a trial makes.
int Simulation::steps_of_trial(std::uint32_t component, double whole) const
{
    // What a solver errs goes on as it begins, so a quarter of the interval is tried. An impact does not announce itself, and where a
    // coupling is exchanged the first step shows more of the exchange than of the level: so the whole interval is tried.
    const bool goes_on = run_.world().type_of(component)->info.family == "Solver";
    // A decision ends, however long the interval is.
    constexpr double kMostSteps = 256;
    // A few steps tell neither what adds up from what grows, nor what a mechanism does in the rest of the interval.
    constexpr double kFewest = 8;
    const double wanted = goes_on ? std::min(whole, std::max(kFewest, std::ceil(whole / 4))) : whole;
    return static_cast<int>(std::min(wanted, kMostSteps));
}

/// The finer level costs most, so its steps are made beside those of the other one, and end where it is known that they depart too far.
TrialFindings Simulation::error_of_level(const LevelQuestion& asked)
{
    const double h = run_.clock.time_at(tick() + 1) - time();
    const double whole = std::max(1.0, std::round(asked.interval / h));
    constexpr std::uint64_t kMeasure = 200'000;  // ns
    FirstStepChoice choice;
    choice.steps = steps_of_trial(asked.component, whole), choice.energies = asked.energy;
    choice.measure_ns = measuring_ && asked.with_cost ? kMeasure : 0;
    const auto first = step_with(asked.component, *asked.level, choice);
    if (!first) return {};
    const FirstStep& one = *first;
    Apart largest;
    const CourseEnd departs = [&](const std::vector<std::vector<ObjectMotion>>& course)
    {
        if (course.size() <= one.course.size()) raise(largest, one.course[course.size() - 1], course.back());
        return largest.distance > asked.enough.distance || largest.angle > asked.enough.angle;
    };
    choice.end = &departs;
    const Result<FirstStep>& second = step_with(asked.component, *asked.finer, choice);
    if (!second) return {};
    const FirstStep& other = *second;
    const std::vector<Apart> apart = departures(one, other);
    if (apart.empty()) return {};
    const std::size_t half = (apart.size() + 1) / 2;
    const Apart &halfway = apart[half - 1], &end = apart.back();
    const auto k = static_cast<double>(half), m = static_cast<double>(apart.size());
    TrialFindings out;
    out.error.distance = continued(halfway.distance, end.distance, k, m, whole);
    out.error.angle = continued(halfway.angle, end.angle, k, m, whole);
    out.error.power = continued(halfway.energy, end.energy, k, m, whole) / (whole * h);
    out.seconds = one.seconds, out.finer_seconds = other.seconds;
    return out;
}

LevelError Simulation::try_level(std::uint32_t component, const Level& level, const Level& finer, double interval, const LevelError& enough)
{
    tried_.clear();
    const LevelError out = error_of_level({component, &level, &finer, interval, enough, false, true}).error;
    tried_.clear();
    return out;
}

void Simulation::measure_for_governors()
{
    if (!deciding_ || !measuring_ || !run_.levels().watches_anything()) return;
    for (Request& request : run_.levels().measurements(time(), dt(), step_times_))
    {
        Reply reply = carry_out(request);
        reply.made = std::make_shared<const Request>(std::move(request));
        own_requests_.push_back(std::move(reply));
    }
}

void Simulation::decide()
{
    if (!deciding_ || !run_.levels().anything_decides() || decided_.tick == tick()) return;
    decided_.tick = tick();
    class Events final : public EventSink
    {
    public:
        explicit Events(std::vector<Event>& to) : to_(to) {}
        void emit(Event event) override { to_.push_back(std::move(event)); }

    private:
        std::vector<Event>& to_;
    } events(decided_.events);
    const auto error = [this](const LevelQuestion& asked) { return error_of_level(asked); };
    std::vector<Decision> decisions = run_.levels().decide(tick(), time(), dt(), error, events);
    tried_.clear();
    const auto in_words = std::stable_partition(decisions.begin(), decisions.end(), [](const Decision& d) { return d.verb.empty(); });
    exchange_levels({decisions.begin(), in_words});
    for (auto first = in_words; first != decisions.end();)
    {
        const auto differs = [&](const Decision& d) { return d.by != first->by || d.verb != "add"; };
        const auto last = std::find_if(first + 1, decisions.end(), differs);
        const auto end = first->verb == "add" ? last : first + 1;
        carry_out_decisions({first, end});
        first = end;
    }
    note_levels();
}

/// What all governors exchange is one transaction, because most of what an exchange costs does not depend on how much is exchanged. If it
/// is refused, each of them exchanges by itself.
void Simulation::exchange_levels(std::span<const Decision> decisions)
{
    if (decisions.empty() || take_effect_as_one(decisions)) return;
    for (const Decision& decision : decisions) carry_out_levels(decision);
}

bool Simulation::take_effect_as_one(std::span<const Decision> decisions)
{
    Request request;
    request.trial.budget = TrialChoice::Budget::None;
    for (const Decision& d : decisions) request.operations.insert(request.operations.end(), d.operations.begin(), d.operations.end());
    std::vector<LevelChange> changes = run_.levels().before_exchange(request.operations);
    const std::uint64_t begin = now_ns(), thread_begin = thread_ns();
    const Reply reply = Transaction(run_, context_, *this, request).run();
    const StepCost cost{1e-9 * static_cast<double>(now_ns() - begin), 1e-9 * static_cast<double>(thread_ns() - thread_begin)};
    if (!reply.done)
    {
        last_refusal_ = reply.errors.empty() ? std::string() : reply.errors.front().text();
        run_.stepper().charge(decisions.front().by, static_cast<std::int64_t>(reply.pause_ns));
        return false;
    }
    run_.levels().note_exchange(request.operations.size(), cost), step_times_.begin_anew();
    run_.watch->begin_anew();
    note_levels();
    std::size_t first = 0;
    for (const Decision& d : decisions)
    {
        const std::size_t end = std::min({first + d.operations.size(), reply.swaps.size(), changes.size()});
        const auto part = [&](auto& all) { return std::pair(all.begin() + std::ptrdiff_t(first), all.begin() + std::ptrdiff_t(end)); };
        Reply own = reply;
        own.swaps.assign(part(reply.swaps).first, part(reply.swaps).second);
        own.pause_ns *= static_cast<double>(d.operations.size()) / static_cast<double>(request.operations.size());
        const auto [from, to] = part(changes);
        note_levels_taken(d, std::move(own), {std::make_move_iterator(from), std::make_move_iterator(to)});
        first = end;
    }
    return true;
}

/// Tells what a governor has exchanged.
void Simulation::note_levels_taken(const Decision& decision, Reply reply, std::vector<LevelChange> changes)
{
    run_.stepper().charge(decision.by, static_cast<std::int64_t>(reply.pause_ns));
    announce_exchanges(reply, decision.reasons, std::move(changes));
    Request request;
    request.trial.budget = TrialChoice::Budget::None;
    request.operations = decision.operations;
    reply.made = std::make_shared<const Request>(std::move(request)), reply.decided_by = run_.world().id_of(decision.by);
    own_requests_.push_back(std::move(reply));
}

/// An exchange that is refused must not keep the others of the same decision from taking effect.
void Simulation::carry_out_levels(const Decision& decision)
{
    if (take_effect_as_one({&decision, 1}) || decision.operations.size() < 2) return;
    for (std::size_t k = 0; k < decision.operations.size(); ++k)
    {
        Decision one;
        one.by = decision.by, one.operations = {decision.operations[k]}, one.reasons = {decision.reasons[k]};
        const auto& id = std::get<SwapOperation>(one.operations.front()).id;
        if (!take_effect_as_one({&one, 1})) refuse_decision(decision.by, "level of " + id, last_refusal_);
    }
}

/// Additions of one component are one transaction, because the cost of a transaction grows with the scene. If it is refused, each half is
/// tried by itself, down to those that are impossible: the same ones as if they were tried one after the other.
void Simulation::carry_out_decisions(std::span<const Decision> decisions)
{
    if (decisions.size() == 1) return carry_out_decision(decisions.front());
    if (take_effect_together(decisions)) return;
    carry_out_decisions(decisions.first(decisions.size() / 2));
    carry_out_decisions(decisions.subspan(decisions.size() / 2));
}

Result<Request> Simulation::read_decision(const Decision& decision) const
{
    if (!context_.read_request) return reason("this program does not read requests of components");
    // Errors in what a component adds are told with the file in which the component stands.
    const bool names_file = decision.verb == "add" && decision.target.empty();
    return context_.read_request(decision.verb, names_file ? file_of(run_.world(), decision.by) : decision.target, decision.argument);
}

bool Simulation::take_effect_together(std::span<const Decision> additions)
{
    Decision whole;
    whole.by = additions.front().by, whole.verb = "add";
    model::Blueprint blueprint;
    for (const Decision& addition : additions)
    {
        const auto read = read_decision(addition);
        if (!read) return false;
        const auto* add = read->operations.size() == 1 ? std::get_if<AddBlueprintOperation>(&read->operations.front()) : nullptr;
        if (!add || !add->blueprint->repeats.empty()) return false;
        if (blueprint.components.empty()) blueprint.file = add->blueprint->file;
        blueprint.components.insert(blueprint.components.end(), add->blueprint->components.begin(), add->blueprint->components.end());
        whole.reasons.push_back(addition.reasons.front());
    }
    Request request;
    request.trial.budget = TrialChoice::Budget::None;
    request.made_by = run_.world().id_of(whole.by);
    request.operations.push_back(AddBlueprintOperation(std::move(blueprint)));
    return take_effect(whole, request, whole.reasons);
}

void Simulation::carry_out_decision(const Decision& decision)
{
    auto read = read_decision(decision);
    if (!read) return refuse_decision(decision.by, decision.verb + " " + decision.target, read.error().reason);
    Request request;
    request.trial.budget = TrialChoice::Budget::None;
    request.operations = std::move(read->operations);
    request.made_by = run_.world().id_of(decision.by);
    (void)take_effect(decision, request, decision.reasons);
}

bool Simulation::take_effect(const Decision& decision, const Request& request, const std::vector<std::string>& reasons)
{
    Reply reply = Transaction(run_, context_, *this, request).run();
    run_.stepper().charge(decision.by, static_cast<std::int64_t>(reply.pause_ns));
    if (!reply.done)
    {
        last_refusal_ = reply.errors.empty() ? std::string() : reply.errors.front().text();
        if (reasons.size() < 2) refuse_decision(decision.by, decision.verb + " " + decision.target, last_refusal_);
        return false;
    }
    run_.watch->begin_anew();
    note_levels();
    if (decision.verb == "add" || decision.verb == "remove") announce_components(decision, ids_in(request.operations), reasons);
    reply.made = std::make_shared<const Request>(request), reply.decided_by = run_.world().id_of(decision.by);
    own_requests_.push_back(std::move(reply));
    return true;
}

/// With what both levels cost and how they err: values are these four figures, NaN where one is unknown.
void Simulation::announce_exchanges(const Reply& reply, const std::vector<std::string>& reasons, std::vector<LevelChange> changes)
{
    for (std::size_t k = 0; k < std::min(reply.swaps.size(), changes.size()); ++k)
    {
        const std::uint32_t component = run_.world().find(reply.swaps[k].id);
        const std::string& why = reasons[std::min(k, reasons.size() - 1)];
        const LevelChange& change = run_.levels().after_exchange(component, why, time(), std::move(changes[k]));
        Event e;
        e.tick = tick(), e.time = time(), e.kind = "level.changed", e.component = component;
        e.message = change.from + " -> " + change.to + ": " + why + "; " + change.text();
        e.values = {change.cost.before, change.cost.after, change.error.before, change.error.after};
        decided_.events.push_back(std::move(e));
    }
}

void Simulation::announce_components(const Decision& decision, const std::vector<std::string>& ids, const std::vector<std::string>& reasons)
{
    run_.changes.touched.push_back(run_.world().id_of(decision.by));  // it remembers what it did
    for (std::size_t k = 0; k < ids.size(); ++k)
    {
        Event e;
        e.tick = tick(), e.time = time(), e.component = decision.by;
        e.kind = decision.verb == "add" ? "component.made" : "component.removed";
        e.message = ids[k] + ": " + reasons[std::min(k, reasons.size() - 1)];
        decided_.events.push_back(std::move(e));
    }
}

void Simulation::refuse_decision(std::uint32_t by, const std::string& what, const std::string& why)
{
    run_.changes.touched.push_back(run_.world().id_of(by));
    Event e;
    e.tick = tick(), e.time = time(), e.kind = "decide.refused", e.severity = Severity::Warning, e.component = by;
    e.message = what + ": " + why;
    decided_.events.push_back(std::move(e));
}

void Simulation::note_levels()
{
    for (const std::uint32_t i : run_.levels().take_changed())
        if (i < run_.world().components().size() && run_.world().component(i).alive) run_.changes.touched.push_back(run_.world().id_of(i));
}

/// A script may have changed what a governor watches.
void Simulation::read_changed_governors()
{
    const auto is_governor = [&](std::uint32_t i) { return run_.levels().is_governor(i); };
    if (std::none_of(run_.changed_by_scripts.begin(), run_.changed_by_scripts.end(), is_governor)) return;
    if (auto read = run_.levels().rebuild(); !read)
    {
        Event e;
        e.time = run_.clock.time_at(run_.clock.tick + 1), e.kind = "decide.failed", e.severity = Severity::Warning;
        e.message = read.error().text();
        run_.events.push_back(std::move(e));
    }
}

}  // namespace plab::simulation
