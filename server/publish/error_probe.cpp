#include "publish/error_probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/ladders.h"
#include "model/values.h"
#include "publish/figures.h"

namespace plab::publish
{
namespace
{

/// A measurement that would block the loop for longer is not made.
constexpr Nanoseconds kLongestProbe = 20'000'000;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// The objects that feel the component: bodies and shafts of its roles; all objects if it has no roles, such as a solver or a
/// response.
std::vector<std::uint32_t> concerned(const world::World& world, std::uint32_t component)
{
    std::vector<std::uint32_t> out;
    for (const Role& role : world.table_of(component).schema().roles())
        for (const Ref ref : world.participants(component, role))
            if (ref.facet == Facet::Body || ref.facet == Facet::Shaft) out.push_back(world.host().component_of(ref));
    if (!out.empty()) return out;
    for (const std::uint32_t i : world.in_id_order())
        if (is_object(world.component(i))) out.push_back(i);
    return out;
}

/// Radius of gyration, m: converts an angle to a length.
double radius_of(const Bodies& bodies, std::uint32_t b)
{
    const Mat3& inertia = bodies.inertia_B[b];
    return bodies.mass[b] > 0 ? std::sqrt(0.5 * (inertia(0, 0) + inertia(1, 1) + inertia(2, 2)) / bodies.mass[b]) : 0.0;
}

struct Apart
{
    double bodies = 0, shafts = 0;  ///< m/s2, rad/s2
    bool any_body = false;
};

void add_body(const Bodies& one, std::uint32_t i, const Bodies& other, std::uint32_t k, double dt, Apart& out)
{
    out.any_body = true;
    const double speed =
        length(one.velocity[i] - other.velocity[k]) + radius_of(one, i) * length(one.angular_velocity[i] - other.angular_velocity[k]);
    out.bodies = std::max({out.bodies, speed / dt, length(one.position[i] - other.position[k]) / (dt * dt)});
}

Apart apart(const simulation::Simulation& one, const simulation::Simulation& other, const std::vector<std::string>& ids, double dt)
{
    Apart out;
    const world::HostTables& a = one.world().host();
    const world::HostTables& b = other.world().host();
    for (const std::string& id : ids)
    {
        const std::uint32_t i = one.world().find(id), k = other.world().find(id);
        if (i == kNoIndex || k == kNoIndex) continue;
        const world::Component& c = one.world().component(i);
        const std::uint32_t ai = c.host_index, bi = other.world().component(k).host_index;
        if (c.facet == Facet::Body)
            add_body(a.bodies, ai, b.bodies, bi, dt, out);
        else
            out.shafts = std::max({out.shafts, std::fabs(a.shafts.speed[ai] - b.shafts.speed[bi]) / dt,
                                   std::fabs(a.shafts.angle[ai] - b.shafts.angle[bi]) / (dt * dt)});
    }
    return out;
}

}  // namespace

ErrorFigure own_error(const simulation::Simulation& s, std::uint32_t component)
{
    if (s.world().component(component).table == kNoIndex) return {kUnknown, "", ""};
    const world::Table& table = s.world().table_of(component);
    ErrorFigure out{kUnknown, "", "it reports no residual"};
    for (const Field& field : table.schema().fields())
    {
        const auto* column = field.is_error ? dynamic_cast<const Column<double>*>(field.column) : nullptr;
        if (!column) continue;
        const double value = std::fabs((*column)[s.world().component(component).row]);
        if (!(value <= out.value)) out = {value, std::string(field.unit.symbol), field.name + ": " + field.doc};
    }
    return out;
}

Result<ErrorFigure> shadow_error(const simulation::Simulation& s, std::uint32_t component, const std::string& finer,
                                 const Interruption* interruption)
{
    const simulation::Snapshot now = s.capture();
    std::vector<std::string> ids;
    for (const std::uint32_t i : concerned(s.world(), component)) ids.push_back(s.world().id_of(i));
    simulation::Simulation as_it_is(s.world().types()), with_finer(s.world().types());
    for (simulation::Simulation* each : {&as_it_is, &with_finer})
    {
        each->let_decide(false);  // a governor would exchange the algorithm again
        if (auto restored = each->restore(now); !restored) return restored.errors();
        each->set_interruption(interruption);
    }
    simulation::Request request;
    request.operations.push_back(simulation::SwapOperation{s.world().id_of(component), finer, {}});
    request.trial.budget = simulation::TrialChoice::Budget::None;  // no trial: the first step follows here anyway
    if (const simulation::Reply reply = with_finer.carry_out_now(request); !reply.done) return reply.errors;
    if (!as_it_is.step_once() || !with_finer.step_once()) return Error{{}, "", "a step took too long"};
    const Apart difference = apart(as_it_is, with_finer, ids, s.dt());
    return ErrorFigure{difference.any_body ? difference.bodies : difference.shafts, difference.any_body ? "m/s2" : "rad/s2",
                       "per second of a step, against " + finer};
}

std::uint32_t ErrorProbe::next_component(const simulation::Simulation& s)
{
    const world::World& world = s.world();
    std::uint32_t first = kNoIndex;
    for (const std::uint32_t i : world.in_id_order())
    {
        const world::Component& c = world.component(i);
        if (!is_interaction(c) || c.quarantined || model::finer_than(world.type_of(i)->info.name).empty()) continue;
        if (first == kNoIndex) first = i;
        if (c.id > last_) return i;
    }
    return first;
}

void ErrorProbe::follow(const simulation::Simulation& s, Nanoseconds now)
{
    if (share_ <= 0) return;
    if (run_ != s.run() || revision_ != s.revision())
    {
        run_ = s.run(), revision_ = s.revision(), longest_ /= 2;  // a measurement that was expensive may be cheaper now
        std::erase_if(known_,
                      [&](const auto& known)
                      {
                          const std::uint32_t i = s.world().find(known.first);
                          return i == kNoIndex || !s.world().type_of(i) || s.world().type_of(i)->info.name != known.second.type;
                      });
    }
    if (now < due_) return;
    const std::uint32_t i = next_component(s);
    if (i == kNoIndex) return;
    const model::ComponentType& type = *s.world().type_of(i);
    const std::string finer = model::finer_than(type.info.name);
    last_ = s.world().id_of(i);
    // Two restored copies, and one step of each.
    const auto expected = std::max(longest_, static_cast<Nanoseconds>(4 * s.stepper().cost().step().median));
    if (expected > kLongestProbe)
    {
        due_ = now + 1'000'000'000;
        known_[last_] = {type.info.name,
                         {kUnknown, "", "a shadow step would block the loop for " + std::to_string(expected / 1'000'000) + " ms"}};
        return;
    }
    const Nanoseconds begin = monotonic_now();
    Interruption deadline;
    deadline.ask(std::chrono::nanoseconds(kLongestProbe));
    auto figure = shadow_error(s, i, finer, &deadline);
    const Nanoseconds took = monotonic_now() - begin;
    longest_ = std::max(longest_, took);
    due_ = now + static_cast<Nanoseconds>(static_cast<double>(took) / share_);
    if (!figure) figure = ErrorFigure{kUnknown, "", "no comparison with " + finer + ": " + figure.error().reason};
    known_[last_] = {type.info.name, figure.take()};
}

ErrorFigure ErrorProbe::of(const simulation::Simulation& s, std::uint32_t component) const
{
    const model::ComponentType* type = s.world().type_of(component);
    const auto known = known_.find(s.world().id_of(component));
    if (type && known != known_.end() && known->second.type == type->info.name) return known->second.figure;
    ErrorFigure own = own_error(s, component);
    if (type && model::finer_than(type->info.name).empty()) own.meaning += "; no algorithm of its family is finer";
    return own;
}

}  // namespace plab::publish
