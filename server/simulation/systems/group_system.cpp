#include "simulation/systems/group_system.h"

#include <algorithm>
#include <cmath>

#include "plab/limits.h"
#include "plab/rotation.h"

namespace plab::simulation
{
namespace
{

/// Flushes tiny speeds to 0: arithmetic with denormal numbers is about a hundred times slower, and squares of speeds are the first to
/// become denormal. The threshold is far below anything that products with step and mass could make significant.
double without_traces(double speed) { return std::fabs(speed) < 1e-150 ? 0.0 : speed; }
Vec3 without_traces(const Vec3& v) { return {without_traces(v.x), without_traces(v.y), without_traces(v.z)}; }

}  // namespace

void GroupSystem::configure(const StepFrame& frame, std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed)
{
    frame_ = frame;
    configuration_ = scratch_->new_configuration();
    world::World& world = *frame.world;
    const world::HostTables& host = world.host();
    for (auto* list :
         {&bodies_, &shafts_, &quantities_, &roots_, &prescribed_bodies_, &prescribed_shafts_, &active_bodies_, &active_shafts_})
        list->clear();
    collect_members(groups);
    own_bodies_ = active_bodies_.size(), own_shafts_ = active_shafts_.size();
    collect_members(observed);
    std::sort(shafts_.begin(), shafts_.end(),
              [&](std::uint32_t a, std::uint32_t b) {
                  return world.rank(Ref{Facet::Shaft, a}) < world.rank(Ref{Facet::Shaft, b});
              });
    for (const std::uint32_t s : shafts_)
        if (host.shafts.root[s] == s) roots_.push_back(s);
    has_observed_ = !observed.empty();

    groups_.assign(groups.begin(), groups.end());
    groups_.insert(groups_.end(), observed.begin(), observed.end());
    filter_forces();
    shaft_system_.configure(world, *frame.schedule, *frame.groups, groups_, *frame.graph);
    quantity_values_ = 0;
    for (const std::uint32_t q : quantities_) quantity_values_ += host.quantities.value[q].size();
    size_vectors(6 * bodies_.size());
    start_position_.resize(bodies_.size()), start_orientation_.resize(bodies_.size()), start_angle_.resize(roots_.size());
    configure_rows();
}

bool GroupSystem::follow(const StepFrame& frame)
{
    frame_ = frame;
    configuration_ = scratch_->new_configuration();
    if (rows_) return false;  // joints are set up from values of components
    const world::HostTables& host = frame.world->host();
    std::size_t values = 0, roots = 0;
    for (const std::uint32_t q : quantities_) values += host.quantities.value[q].size();
    for (const std::uint32_t s : shafts_)
        if (host.shafts.root[s] == s && (roots == roots_.size() || roots_[roots++] != s)) return false;
    return values == quantity_values_ && roots == roots_.size() && follow_forces();
}

void GroupSystem::size_vectors(std::size_t body_values)
{
    body_values_ = body_values;
    const std::size_t n = body_values_ + roots_.size() + quantity_values_;
    for (auto* v : {&coordinates_, &speeds_, &coordinate_rates_, &speed_rates_}) v->resize(n);
}

void GroupSystem::collect_members(std::span<const std::uint32_t> groups)
{
    const auto take = [](const std::vector<std::uint32_t>& from, std::vector<std::uint32_t>& to, std::vector<std::uint32_t>& active)
    {
        to.insert(to.end(), from.begin(), from.end());
        active.insert(active.end(), from.begin(), from.end());
    };
    for (const std::uint32_t g : groups)
    {
        const Group& group = frame_.groups->all[g];
        take(group.bodies, bodies_, active_bodies_);
        take(group.prescribed_bodies, prescribed_bodies_, active_bodies_);
        take(group.shafts, shafts_, active_shafts_);
        take(group.prescribed_shafts, prescribed_shafts_, active_shafts_);
        quantities_.insert(quantities_.end(), group.quantities.begin(), group.quantities.end());
    }
}

void GroupSystem::activate()
{
    if (scratch_->is_active(configuration_)) return;
    scratch_->activate(configuration_, active_bodies_, active_shafts_);
    for (std::size_t i = 0; i < own_bodies_; ++i) scratch_->book_body(active_bodies_[i]);
    for (std::size_t i = 0; i < own_shafts_; ++i) scratch_->book_shaft(active_shafts_[i]);
}

void GroupSystem::begin(double from, double to, WorkBook book, EventSink* events)
{
    from_ = from, midway_ = 0;
    book_ = book;
    call_.context = {};
    call_.context.time = frame_.start_time + from, call_.context.dt = to - from;
    call_.context.tick = frame_.tick, call_.context.seed = frame_.seed, call_.context.events = events;
    call_.context.interruption = frame_.interruption;
    activate();
    call_.context.active_bodies = scratch_->active_bodies, call_.context.active_shafts = scratch_->active_shafts;
    if (rows_ && !rows_held_) join();

    minimal_ = false;
    size_vectors(6 * bodies_.size());
    const world::HostTables& host = frame_.world->host();
    std::fill(coordinates_.begin(), coordinates_.end(), 0.0);
    for (std::size_t i = 0; i < bodies_.size(); ++i)
    {
        const std::uint32_t b = bodies_[i];
        start_position_[i] = host.bodies.position[b], start_orientation_[i] = host.bodies.orientation[b];
        put(speeds_, 6 * i, without_traces(host.bodies.velocity[b]));
        put(speeds_, 6 * i + 3,
            without_traces(host.bodies.needle[b] != 0 ? rotate_back(host.bodies.orientation[b], host.bodies.angular_velocity[b])
                                                      : host.bodies.angular_momentum[b]));
    }
    for (std::size_t i = 0; i < roots_.size(); ++i)
    {
        start_angle_[i] = host.shafts.angle[roots_[i]];
        speeds_[6 * bodies_.size() + i] = without_traces(host.shafts.speed[roots_[i]]);
    }
    std::size_t next = 6 * bodies_.size() + roots_.size();
    for (const std::uint32_t q : quantities_)
        for (const double value : host.quantities.value[q]) speeds_[next++] = without_traces(value);
}

void GroupSystem::scatter_prescribed(double since_step_start)
{
    world::HostTables& host = frame_.world->host();
    for (const std::uint32_t b : prescribed_bodies_)
    {
        frame_.start->restore_body(host, b);
        host.bodies.position[b] += host.bodies.velocity[b] * since_step_start;
        const Quat turn = exp_rotation(host.bodies.angular_velocity[b] * since_step_start);
        host.bodies.orientation[b] = normalized(turn * host.bodies.orientation[b]);
    }
    for (const std::uint32_t s : prescribed_shafts_)
    {
        frame_.start->restore_shaft(host, s);
        host.shafts.angle[s] += host.shafts.speed[s] * since_step_start;
    }
}

void GroupSystem::scatter_bodies()
{
    world::HostTables& host = frame_.world->host();
    if (minimal_) return articulated_.place(host.bodies, coordinates_, speeds_);
    for (std::size_t i = 0; i < bodies_.size(); ++i)
    {
        const std::uint32_t b = bodies_[i];
        host.bodies.position[b] = start_position_[i] + get(coordinates_, 6 * i);
        host.bodies.orientation[b] = start_orientation_[i] * exp_rotation(get(coordinates_, 6 * i + 3));
        host.bodies.velocity[b] = get(speeds_, 6 * i);
        if (host.bodies.needle[b] != 0)
            host.bodies.angular_velocity[b] = rotate(host.bodies.orientation[b], get(speeds_, 6 * i + 3));
        else
            host.bodies.angular_momentum[b] = get(speeds_, 6 * i + 3);
        host.bodies.refresh_spin(b);
    }
}

void GroupSystem::scatter(double t)
{
    world::HostTables& host = frame_.world->host();
    scatter_prescribed(from_ + t);
    scatter_bodies();
    const std::size_t base = body_values_;
    for (std::size_t i = 0; i < roots_.size(); ++i)
    {
        host.shafts.angle[roots_[i]] = start_angle_[i] + coordinates_[base + i];
        host.shafts.speed[roots_[i]] = speeds_[base + i];
    }
    if (!shafts_.empty()) frame_.graph->derive(host.shafts, scratch_->active_shafts);
    std::size_t next = base + roots_.size();
    for (const std::uint32_t q : quantities_)
        for (double& value : host.quantities.value[q]) value = speeds_[next++];
}

void GroupSystem::rates_of_bodies()
{
    const Bodies& bodies = frame_.world->host().bodies;
    if (minimal_) return articulated_.coordinate_rates(coordinates_, speeds_, coordinate_rates_);
    for (std::size_t i = 0; i < bodies_.size(); ++i)
    {
        const std::uint32_t b = bodies_[i];
        put(coordinate_rates_, 6 * i, bodies.velocity[b]);
        const Vec3 w_B = rotate_back(bodies.orientation[b], bodies.angular_velocity[b]);
        put(coordinate_rates_, 6 * i + 3, rotation_vector_rate(get(coordinates_, 6 * i + 3), w_B));
    }
}

Vec3 GroupSystem::spin_rate_B(std::uint32_t b) const
{
    // Euler's equations in the body frame: I w' = tau - w x I w.
    const Bodies& bodies = frame_.world->host().bodies;
    const Vec3 w_B = rotate_back(bodies.orientation[b], bodies.angular_velocity[b]);
    const Vec3 torque_B = rotate_back(bodies.orientation[b], scratch_->wrenches.torque[b]);
    return bodies.inverse_inertia_B[b] * (torque_B - cross(w_B, bodies.inertia_B[b] * w_B));
}

void GroupSystem::kick(std::size_t member, double h)
{
    Bodies& bodies = frame_.world->host().bodies;
    const std::uint32_t b = bodies_[member];
    bodies.velocity[b] += acceleration(member) * h;
    if (const Vec3& torque = scratch_->wrenches.torque[b]; torque != Vec3{}) bodies.add_angular_impulse(b, torque * h);
}

void GroupSystem::rates_of_shafts(double weight)
{
    if (roots_.empty()) return;
    world::HostTables& host = frame_.world->host();
    shaft_system_.solve_accelerations(call_.context, scratch_->wrenches.shaft_torque);
    // Couplings of observed groups are booked when their own group is advanced.
    if (book_.work && weight != 0 && !has_observed_) shaft_system_.account(*book_.work, book_.sign * weight * call_.context.dt);
    const std::size_t base = body_values_;
    for (std::size_t i = 0; i < roots_.size(); ++i)
    {
        coordinate_rates_[base + i] = host.shafts.speed[roots_[i]];
        speed_rates_[base + i] = shaft_system_.rate(roots_[i]);
    }
}

void GroupSystem::rates_of_quantities()
{
    std::size_t next = body_values_ + roots_.size();
    for (const std::uint32_t q : quantities_)
        for (const double rate : scratch_->wrenches.quantity_rate[q]) coordinate_rates_[next] = 0, speed_rates_[next++] = rate;
}

void GroupSystem::evaluate(double t, double weight)
{
    if (frame_.give_up())
    {
        // Zero rates; the solver is about to stop anyway.
        std::fill(coordinate_rates_.begin(), coordinate_rates_.end(), 0.0);
        std::fill(speed_rates_.begin(), speed_rates_.end(), 0.0);
        return;
    }
    call_.context.time = frame_.start_time + (from_ + t);
    scatter(t);
    clear_wrenches();
    run_forces(weight);
    if (rows_ && !rows_held_ && !minimal_)
    {
        scratch_->held_bodies += bodies_.size();
        const CostScope scope(scratch_->meter(), scratch_->rows_ns);
        (void)rows_->react(call_.context, scratch_->wrenches);  // non-finite results are detected at the end of the advance
        if (book_.work && weight != 0) rows_->account(row_book(), weight * call_.context.dt);
    }
    rates_of_bodies();
    const Bodies& bodies = frame_.world->host().bodies;
    if (minimal_) articulated_.accelerate(bodies, scratch_->wrenches, speed_rates_);
    for (std::size_t i = 0; !minimal_ && i < bodies_.size(); ++i)
    {
        put(speed_rates_, 6 * i, scratch_->wrenches.force[bodies_[i]] * bodies.inverse_mass[bodies_[i]]);
        put(speed_rates_, 6 * i + 3, bodies.needle[bodies_[i]] != 0 ? spin_rate_B(bodies_[i]) : scratch_->wrenches.torque[bodies_[i]]);
    }
    rates_of_shafts(weight);
    rates_of_quantities();
}

void GroupSystem::go_midway()
{
    if (uniform_ || extra_) return;
    std::fill(coordinates_.begin(), coordinates_.end(), 0.0);
    evaluate_kinematics();
    midway_ = 0.5 * call_.context.dt;
    for (std::size_t i = 0; i < coordinates_.size(); ++i) coordinates_[i] = midway_ * coordinate_rates_[i];
}

void GroupSystem::leave_midway()
{
    if (midway_ == 0) return;
    midway_ = 0;
    std::fill(coordinates_.begin(), coordinates_.end(), 0.0);
    evaluate_kinematics();
}

void GroupSystem::evaluate_midway()
{
    go_midway();
    evaluate(midway_, 0);
    if (rows_ && rows_held_) force_changes_.collect(call_.context, midway_, scratch_->meter());
    leave_midway();
}

void GroupSystem::evaluate_here()
{
    evaluate(midway_, 0);
    if (!book_.work) return;
    std::span<double> before = workspace(0);
    std::copy(speeds_.begin(), speeds_.end(), before.begin());
    for (std::size_t i = 0; i < speeds_.size(); ++i) speeds_[i] += 0.5 * call_.context.dt * speed_rates_[i];
    evaluate(midway_, 1);
    std::copy(before.begin(), before.end(), speeds_.begin());
    evaluate(midway_, 0);  // booked or not, so that the kick has the same bits in both cases
}

void GroupSystem::evaluate_kinematics()
{
    scatter(0);
    rates_of_bodies();
    const std::size_t base = body_values_;
    for (std::size_t i = 0; i < roots_.size(); ++i) coordinate_rates_[base + i] = speeds_[base + i];
    for (std::size_t i = base + roots_.size(); i < coordinate_rates_.size(); ++i) coordinate_rates_[i] = 0;
}

void GroupSystem::move_shafts(double h, Shafts& shafts)
{
    const std::size_t base = body_values_;
    for (std::size_t i = 0; i < roots_.size(); ++i)
    {
        const double before = speeds_[base + i];
        shafts.speed[roots_[i]] = before + h * speed_rates_[base + i];
        shafts.angle[roots_[i]] = start_angle_[i] + 0.5 * h * (before + shafts.speed[roots_[i]]);
    }
    if (!shafts_.empty()) frame_.graph->derive(shafts, scratch_->active_shafts);
}

std::span<double> GroupSystem::workspace(int i)
{
    std::vector<double>& w = workspace_[static_cast<std::size_t>(i)];
    w.resize(coordinates_.size());
    return w;
}

RigidMember GroupSystem::rigid(std::size_t body) const
{
    const Bodies& bodies = frame_.world->host().bodies;
    const std::uint32_t b = bodies_[body];
    return {start_orientation_[body], bodies.inertia_B[b], bodies.inverse_inertia_B[b], bodies.mass[b], bodies.needle[b] != 0};
}

bool GroupSystem::finish()
{
    scatter(call_.context.dt);
    Bodies& bodies = frame_.world->host().bodies;
    for (const std::uint32_t b : bodies_) bodies.orientation[b] = normalized(bodies.orientation[b]);
    const bool finite = all_finite();
    if (finite) project();
    return finite;
}

void GroupSystem::finish_held()
{
    scatter_prescribed(from_ + call_.context.dt);
    world::HostTables& host = frame_.world->host();
    if (!shafts_.empty()) frame_.graph->derive(host.shafts, scratch_->active_shafts);
    std::size_t at = speeds_.size() - quantity_values_;
    for (const std::uint32_t q : quantities_)
        for (double& value : host.quantities.value[q])
        {
            value = speeds_[at] + call_.context.dt * speed_rates_[at];
            ++at;
        }
}

bool GroupSystem::all_finite() const
{
    const world::HostTables& host = frame_.world->host();
    return std::all_of(bodies_.begin(), bodies_.end(), [&](std::uint32_t b) { return is_finite(host.bodies, b); }) &&
           std::all_of(shafts_.begin(), shafts_.end(), [&](std::uint32_t s) { return is_finite(host.shafts, s); }) &&
           std::all_of(quantities_.begin(), quantities_.end(), [&](std::uint32_t q) { return is_finite(host.quantities, q); });
}

// Whether the values of an object are small and finite enough for the step to continue.
bool is_finite(const Bodies& bodies, std::uint32_t b)
{
    return is_computable(bodies.position[b]) && is_computable(bodies.velocity[b]) && plab::is_finite(bodies.orientation[b]) &&
           is_computable(bodies.angular_velocity[b]);
}

bool is_finite(const Quantities& quantities, std::uint32_t q)
{
    return std::all_of(quantities.value[q].begin(), quantities.value[q].end(), [](double v) { return is_computable(v); });
}

bool is_finite(const Shafts& shafts, std::uint32_t s) { return is_computable(shafts.angle[s]) && is_computable(shafts.speed[s]); }

}  // namespace plab::simulation
