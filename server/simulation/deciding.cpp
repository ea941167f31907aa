// What components decide before a step (Phase::Decide), carried out like requests of clients.
#include <algorithm>
#include <cmath>
#include <limits>

#include "simulation/simulation.h"

namespace plab::simulation
{
namespace
{

/// Two courses that part in each step of h (s) as they did in the first one. Both the distances and the differences of speed are taken to
/// add up.
class Departure
{
public:
    Departure(double h, double interval) : h_(h), steps_(std::max(1.0, interval / h)) {}

    void add(const ObjectMotion& a, const ObjectMotion& b)
    {
        if (a.object.facet == Facet::Shaft)
        {
            raise(error_.angle, grown(std::fabs(a.angle - b.angle), std::fabs(a.speed - b.speed)));
            return;
        }
        const double r = std::isfinite(a.radius) ? a.radius : 0;
        const Quat turn = conjugate(a.orientation) * b.orientation;
        const double angle = 2 * std::atan2(length(Vec3{turn.x, turn.y, turn.z}), std::fabs(turn.w));
        const double spin = length(a.angular_velocity - b.angular_velocity);
        raise(error_.distance, grown(length(a.position - b.position) + r * angle, length(a.velocity - b.velocity) + r * spin));
        raise(error_.angle, grown(angle, spin));
    }
    const LevelError& result() const { return error_; }

private:
    double grown(double distance, double speed) const { return steps_ * distance + 0.5 * steps_ * (steps_ - 1) * h_ * speed; }
    static void raise(double& largest, double value) { largest = std::isnan(largest) ? value : std::max(largest, value); }
    double h_, steps_;
    LevelError error_;
};

}  // namespace

/// What the first step would be with a level.
const Result<FirstStep>& Simulation::step_with(std::uint32_t component, const Level& level)
{
    if (!tried_.empty() && tried_.front().component != component) tried_.clear();
    for (const Tried& t : tried_)
        if (t.level == &level) return t.step;
    Request request;
    request.operations.push_back(SwapOperation{run_.world().id_of(component), level.type, level.values});
    request.trial.budget = TrialChoice::Budget::Unlimited;  // a limit by the clock would make decisions depend on it
    return tried_.emplace_back(Tried{component, &level, Transaction(run_, context_, *this, request).first_step()}).step;
}

LevelError Simulation::error_of_level(std::uint32_t component, const Level& level, const Level& finer, double interval)
{
    if (!step_with(component, level) || !step_with(component, finer)) return {};
    const FirstStep &one = *step_with(component, level), &other = *step_with(component, finer);
    const double h = run_.clock.time_at(tick() + 1) - time();
    Departure departure(h, interval);
    // One of the steps may have touched more objects.
    for (std::size_t i = 0, k = 0; i < one.motion.size() && k < other.motion.size();)
        if (one.motion[i].object == other.motion[k].object)
            departure.add(one.motion[i++], other.motion[k++]);
        else
            one.motion[i].object < other.motion[k].object ? ++i : ++k;
    LevelError out = departure.result();
    if (one.motion.size() == other.motion.size()) out.power = std::fabs(one.energy - other.energy) / h;
    return out;
}

void Simulation::measure_for_governors()
{
    if (!deciding_ || !measuring_ || !run_.levels().watches_anything() || recent_steps_.empty()) return;
    // Most steps shall keep within a budget, so what counts is the cost that nine of ten steps do not exceed.
    const auto nine_of_ten = [this](double StepCost::*clock)
    {
        std::vector<double> values;
        for (const StepCost& step : recent_steps_) values.push_back(step.*clock);
        const auto at = values.begin() + static_cast<std::ptrdiff_t>(9 * (values.size() - 1) / 10);
        std::nth_element(values.begin(), at, values.end());
        return *at;
    };
    const StepCost cost{nine_of_ten(&StepCost::wall), nine_of_ten(&StepCost::processor)};
    for (Request& request : run_.levels().measurements(time(), dt(), cost))
    {
        recent_steps_.clear();
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
    const auto error = [this](std::uint32_t component, const Level* level, const Level* finer, double interval)
    { return error_of_level(component, *level, *finer, interval); };
    const std::vector<Decision> decisions = run_.levels().decide(tick(), time(), dt(), error, events);
    tried_.clear();
    for (const Decision& decision : decisions) carry_out_decision(decision);
    note_levels();
}

/// An exchange that is refused must not keep the others of the same decision from taking effect.
void Simulation::carry_out_decision(const Decision& decision)
{
    Request request;
    request.trial.budget = TrialChoice::Budget::None;
    request.operations = decision.operations;
    if (!decision.verb.empty())
    {
        auto read = context_.read_request ? context_.read_request(decision.verb, decision.target, decision.argument)
                                          : Result<Request>(reason("this program does not read requests of components"));
        if (!read) return refuse_decision(decision.by, decision.verb + " " + decision.target, read.error().reason);
        request.operations = std::move(read->operations);
    }
    if (take_effect(decision, request, decision.reasons) || request.operations.size() < 2 || !decision.verb.empty()) return;
    for (std::size_t k = 0; k < decision.operations.size(); ++k)
    {
        request.operations = {decision.operations[k]};
        const auto& id = std::get<SwapOperation>(decision.operations[k]).id;
        if (!take_effect(decision, request, {decision.reasons[k]})) refuse_decision(decision.by, "level of " + id, last_refusal_);
    }
}

bool Simulation::take_effect(const Decision& decision, const Request& request, const std::vector<std::string>& reasons)
{
    Reply reply = Transaction(run_, context_, *this, request).run();
    run_.stepper().charge(decision.by, static_cast<std::int64_t>(reply.pause_ns));
    if (!reply.done)
    {
        last_refusal_ = reply.errors.empty() ? std::string() : reply.errors.front().text();
        if (request.operations.size() < 2 && !decision.verb.empty())
            refuse_decision(decision.by, decision.verb + " " + decision.target, last_refusal_);
        return false;
    }
    run_.watch->begin_anew();
    note_levels();
    for (std::size_t k = 0; k < reply.swaps.size() && decision.verb.empty(); ++k)
    {
        const SwapReport& swap = reply.swaps[k];
        const std::uint32_t component = run_.world().find(swap.id);
        const std::string& why = reasons[std::min(k, reasons.size() - 1)];
        run_.levels().note_change(component, why, time());
        Event e;
        e.tick = tick(), e.time = time(), e.kind = "level.changed", e.component = component;
        e.message = swap.from + " -> " + swap.to + ": " + why;
        decided_.events.push_back(std::move(e));
    }
    reply.made = std::make_shared<const Request>(request), reply.decided_by = run_.world().id_of(decision.by);
    own_requests_.push_back(std::move(reply));
    return true;
}

void Simulation::refuse_decision(std::uint32_t by, const std::string& what, const std::string& why)
{
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
