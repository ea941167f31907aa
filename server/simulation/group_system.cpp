#include "simulation/group_system.h"

#include <algorithm>
#include <cmath>

#include "plab/rotation.h"
#include "simulation/clock.h"

namespace plab::simulation
{

void GroupSystem::configure(const StepFrame& frame, std::span<const std::uint32_t> groups, std::span<const std::uint32_t> shadows)
{
    frame_ = frame;
    world::World& world = *frame.world;
    const world::HostTables& host = world.host();
    bodies_.clear(), shafts_.clear(), roots_.clear(), prescribed_bodies_.clear(), prescribed_shafts_.clear();
    for (auto* flags : {&active_bodies_, &accounted_bodies_}) flags->assign(host.bodies.size(), 0);
    for (auto* flags : {&active_shafts_, &accounted_shafts_}) flags->assign(host.shafts.size(), 0);
    collect_members(groups, true);
    collect_members(shadows, false);
    std::sort(shafts_.begin(), shafts_.end(),
              [&](std::uint32_t a, std::uint32_t b) {
                  return world.rank(Ref{Facet::Shaft, a}) < world.rank(Ref{Facet::Shaft, b});
              });
    for (const std::uint32_t s : shafts_)
        if (host.shafts.root[s] == s) roots_.push_back(s);
    has_shadows_ = !shadows.empty();

    groups_.assign(groups.begin(), groups.end());
    groups_.insert(groups_.end(), shadows.begin(), shadows.end());
    filter_forces();
    shaft_system_.configure(world, *frame.schedule, *frame.groups, groups_, *frame.graph);
    force_ns_.assign(world.tables().size(), 0);
    const std::size_t n = 6 * bodies_.size() + roots_.size();
    coordinates_.resize(n), speeds_.resize(n), coordinate_rates_.resize(n), speed_rates_.resize(n);
    start_position_.resize(bodies_.size()), start_orientation_.resize(bodies_.size()), start_angle_.resize(roots_.size());

    wrenches_.bind(host.bodies, host.shafts);
    wrenches_.force.resize(host.bodies.size()), wrenches_.torque.resize(host.bodies.size());
    wrenches_.shaft_torque.resize(host.shafts.size());
    power_.assign(world.components().size(), 0.0);
}

void GroupSystem::collect_members(std::span<const std::uint32_t> groups, bool accounted)
{
    const auto take = [accounted](const std::vector<std::uint32_t>& from, std::vector<std::uint32_t>& to, std::vector<std::uint8_t>& active,
                                  std::vector<std::uint8_t>& booked)
    {
        to.insert(to.end(), from.begin(), from.end());
        for (const std::uint32_t i : from) active[i] = 1, booked[i] = accounted ? 1 : 0;
    };
    for (const std::uint32_t g : groups)
    {
        const Group& group = frame_.groups->all[g];
        take(group.bodies, bodies_, active_bodies_, accounted_bodies_);
        take(group.prescribed_bodies, prescribed_bodies_, active_bodies_, accounted_bodies_);
        take(group.shafts, shafts_, active_shafts_, accounted_shafts_);
        take(group.prescribed_shafts, prescribed_shafts_, active_shafts_, accounted_shafts_);
    }
}

void GroupSystem::filter_forces()
{
    merged_.clear();
    for (const std::uint32_t g : groups_)
    {
        const auto& rows = frame_.groups->all[g].forces;
        merged_.insert(merged_.end(), rows.begin(), rows.end());
    }
    std::sort(merged_.begin(), merged_.end());
    merged_.erase(std::unique(merged_.begin(), merged_.end()), merged_.end());

    const auto& blocks = frame_.schedule->of(Phase::Force);
    if (selected_.size() < blocks.size()) selected_.resize(blocks.size());
    selected_count_ = 0;
    for (std::size_t i = 0; i < merged_.size();)
    {
        Selected& s = selected_[selected_count_++];
        s.block = &blocks[merged_[i].block];
        s.rows.clear();
        for (const std::uint32_t block = merged_[i].block; i < merged_.size() && merged_[i].block == block; ++i)
            s.rows.push_back(merged_[i].row);
    }
}

void GroupSystem::begin(double from, double to, WorkBook book, EventSink* events)
{
    from_ = from;
    book_ = book;
    context_ = {};
    context_.time = frame_.start_time + from, context_.dt = to - from;
    context_.tick = frame_.tick, context_.seed = frame_.seed, context_.events = events;
    context_.active_bodies = active_bodies_, context_.active_shafts = active_shafts_;

    const world::HostTables& host = frame_.world->host();
    std::fill(coordinates_.begin(), coordinates_.end(), 0.0);
    for (std::size_t i = 0; i < bodies_.size(); ++i)
    {
        const std::uint32_t b = bodies_[i];
        start_position_[i] = host.bodies.position[b], start_orientation_[i] = host.bodies.orientation[b];
        put(speeds_, 6 * i, host.bodies.velocity[b]);
        put(speeds_, 6 * i + 3,
            host.bodies.needle[b] != 0 ? rotate_back(host.bodies.orientation[b], host.bodies.angular_velocity[b])
                                       : host.bodies.angular_momentum[b]);
    }
    for (std::size_t i = 0; i < roots_.size(); ++i)
    {
        start_angle_[i] = host.shafts.angle[roots_[i]];
        speeds_[6 * bodies_.size() + i] = host.shafts.speed[roots_[i]];
    }
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

void GroupSystem::scatter(double t)
{
    world::HostTables& host = frame_.world->host();
    scatter_prescribed(from_ + t);
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
    const std::size_t base = 6 * bodies_.size();
    for (std::size_t i = 0; i < roots_.size(); ++i)
    {
        host.shafts.angle[roots_[i]] = start_angle_[i] + coordinates_[base + i];
        host.shafts.speed[roots_[i]] = speeds_[base + i];
    }
    if (!shafts_.empty()) frame_.graph->derive(host.shafts, active_shafts_);
}

void GroupSystem::clear_wrenches()
{
    for (const std::uint32_t b : bodies_) wrenches_.force[b] = {}, wrenches_.torque[b] = {};
    for (const std::uint32_t s : shafts_) wrenches_.shaft_torque[s] = 0;
}

void GroupSystem::run_forces(double weight)
{
    world::HostTables& host = frame_.world->host();
    const bool booked = book_.work != nullptr && weight != 0;
    wrenches_.power = booked ? &power_ : nullptr;
    wrenches_.accounted_bodies = accounted_bodies_, wrenches_.accounted_shafts = accounted_shafts_;
    PhaseCall call;
    call.context = &context_;
    call.bodies = &host.bodies, call.shafts = &host.shafts, call.shapes = &host.shapes, call.materials = &host.materials;
    call.wrenches = &wrenches_;
    for (std::size_t k = 0; k < selected_count_; ++k)
    {
        const Selected& s = selected_[k];
        const std::uint64_t before = booked ? now_ns() : 0;
        const world::Table& table = *frame_.world->tables()[s.block->table];
        context_.component_of_row = table.component_of_row(), context_.facet_of_row = table.host_of_row();
        call.rows = s.rows;
        (void)s.block->command->run(call, table.rows());  // forces have no failures but events
        if (!booked) continue;
        force_ns_[s.block->table] += now_ns() - before;
        const double share = book_.sign * weight * context_.dt;
        for (const Row row : s.rows)
        {
            const std::uint32_t component = context_.component_of_row[row];
            (*book_.work)[component] += share * power_[component];
            power_[component] = 0;
        }
    }
}

void GroupSystem::rates_of_bodies()
{
    const Bodies& bodies = frame_.world->host().bodies;
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
    const Vec3 torque_B = rotate_back(bodies.orientation[b], wrenches_.torque[b]);
    return bodies.inverse_inertia_B[b] * (torque_B - cross(w_B, bodies.inertia_B[b] * w_B));
}

void GroupSystem::kick(std::size_t member, double h)
{
    Bodies& bodies = frame_.world->host().bodies;
    const std::uint32_t b = bodies_[member];
    bodies.velocity[b] += acceleration(member) * h;
    if (bodies.needle[b] != 0)
        bodies.angular_velocity[b] += rotate(bodies.orientation[b], spin_rate_B(b)) * h;
    else
        bodies.angular_momentum[b] += wrenches_.torque[b] * h;
    bodies.refresh_spin(b);
}

void GroupSystem::rates_of_shafts(double weight)
{
    if (roots_.empty()) return;
    world::HostTables& host = frame_.world->host();
    shaft_system_.solve_accelerations(context_, wrenches_.shaft_torque);
    // Shadows' couplings were booked with their own group's advance.
    if (book_.work && weight != 0 && !has_shadows_) shaft_system_.account(*book_.work, book_.sign * weight * context_.dt);
    const std::size_t base = 6 * bodies_.size();
    for (std::size_t i = 0; i < roots_.size(); ++i)
    {
        coordinate_rates_[base + i] = host.shafts.speed[roots_[i]];
        speed_rates_[base + i] = shaft_system_.rate(roots_[i]);
    }
}

void GroupSystem::evaluate(double t, double weight)
{
    context_.time = frame_.start_time + (from_ + t);
    scatter(t);
    clear_wrenches();
    run_forces(weight);
    rates_of_bodies();
    const Bodies& bodies = frame_.world->host().bodies;
    for (std::size_t i = 0; i < bodies_.size(); ++i)
    {
        put(speed_rates_, 6 * i, wrenches_.force[bodies_[i]] * bodies.inverse_mass[bodies_[i]]);
        put(speed_rates_, 6 * i + 3, bodies.needle[bodies_[i]] != 0 ? spin_rate_B(bodies_[i]) : wrenches_.torque[bodies_[i]]);
    }
    rates_of_shafts(weight);
}

void GroupSystem::evaluate_here()
{
    evaluate(0, 0);
    if (!book_.work) return;
    std::span<double> before = workspace(0);
    std::copy(speeds_.begin(), speeds_.end(), before.begin());
    for (std::size_t i = 0; i < speeds_.size(); ++i) speeds_[i] += 0.5 * context_.dt * speed_rates_[i];
    evaluate(0, 1);
    std::copy(before.begin(), before.end(), speeds_.begin());
    evaluate(0, 0);  // booked or not, the kick is made with the same bits
}

void GroupSystem::evaluate_kinematics()
{
    scatter(0);
    rates_of_bodies();
    const std::size_t base = 6 * bodies_.size();
    for (std::size_t i = 0; i < roots_.size(); ++i) coordinate_rates_[base + i] = speeds_[base + i];
}

void GroupSystem::collect_cost(std::vector<std::array<std::uint64_t, kPhaseCount>>& by_table)
{
    for (std::size_t t = 0; t < force_ns_.size(); ++t)
    {
        by_table[t][static_cast<std::size_t>(Phase::Force)] += force_ns_[t];
        force_ns_[t] = 0;
    }
}

void GroupSystem::move_shafts(double h, Shafts& shafts)
{
    const std::size_t base = 6 * bodies_.size();
    for (std::size_t i = 0; i < roots_.size(); ++i)
    {
        const double before = speeds_[base + i];
        shafts.speed[roots_[i]] = before + h * speed_rates_[base + i];
        shafts.angle[roots_[i]] = start_angle_[i] + 0.5 * h * (before + shafts.speed[roots_[i]]);
    }
    if (!shafts_.empty()) frame_.graph->derive(shafts, active_shafts_);
}

std::span<double> GroupSystem::workspace(int i)
{
    std::vector<double>& w = workspace_[static_cast<std::size_t>(i)];
    w.resize(coordinates_.size());
    return w;
}

bool GroupSystem::finish()
{
    scatter(context_.dt);
    Bodies& bodies = frame_.world->host().bodies;
    for (const std::uint32_t b : bodies_) bodies.orientation[b] = normalized(bodies.orientation[b]);
    return all_finite();
}

bool GroupSystem::all_finite() const
{
    const world::HostTables& host = frame_.world->host();
    return std::all_of(bodies_.begin(), bodies_.end(), [&](std::uint32_t b) { return is_finite(host.bodies, b); }) &&
           std::all_of(shafts_.begin(), shafts_.end(), [&](std::uint32_t s) { return is_finite(host.shafts, s); });
}

bool is_finite(const Bodies& bodies, std::uint32_t b)
{
    return plab::is_finite(bodies.position[b]) && plab::is_finite(bodies.velocity[b]) && plab::is_finite(bodies.orientation[b]) &&
           plab::is_finite(bodies.angular_velocity[b]);
}

bool is_finite(const Shafts& shafts, std::uint32_t s) { return std::isfinite(shafts.angle[s]) && std::isfinite(shafts.speed[s]); }

}  // namespace plab::simulation
