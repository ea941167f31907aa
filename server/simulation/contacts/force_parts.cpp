#include "simulation/contacts/force_parts.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "plab/number_text.h"
#include "plab/random.h"
#include "plab/rotation.h"

namespace plab::simulation
{
namespace
{

/// h^2 |K| + h |C| in a part.
constexpr double kLimit = 0.25;
/// Where no member changes by more than this in the second difference, whose directions follow the first one, no group comes near the
/// limit.
constexpr double kSoft = kLimit / 4;
/// Displacements, as a share of the smallest radius of gyration in a group.
constexpr double kReach = 0x1p-8;
constexpr double kReachOfPoints = 0x1p-10;  ///< m, if there is none

double length_of(std::span<const double> numbers)
{
    double sum = 0;
    for (const double x : numbers) sum += x * x;
    return std::sqrt(sum);
}

double parts_for(double of_positions, double of_speeds)
{
    if (!(of_positions + of_speeds > kLimit)) return 1;
    return std::ceil((of_speeds + std::sqrt(of_speeds * of_speeds + 4 * kLimit * of_positions)) / (2 * kLimit));
}

}  // namespace

void ForceParts::rebuild()
{
    const auto& blocks = step_.schedule.of(Phase::Force);
    const std::size_t count = step_.groups.all.size();
    depends_.assign(count, 0), parts_.assign(count, 1), place_.assign(count, kNoIndex);
    any_ = false;
    for (std::uint32_t g = 0; g < count; ++g)
    {
        const Group& group = step_.groups.all[g];
        const bool depends = std::ranges::any_of(
            group.forces, [&](const BlockRow& r) { return !step_.world.tables()[blocks[r.block].table]->type().info.uniform; });
        if (depends && group.rows.empty() && !(group.bodies.empty() && group.shafts.empty())) depends_[g] = 1, any_ = true;
    }
}

bool ForceParts::measure(std::span<const std::uint32_t> groups, double from, double to)
{
    any_divided_ = false;
    if (!any_) return false;
    plain_.clear();
    for (const std::uint32_t g : groups)
    {
        parts_[g] = 1;
        if (depends_[g] != 0) plain_.push_back(g);
    }
    if (motion_.extra() || !(to > from)) return false;
    if (!plain_.empty()) measure_together(plain_, from, to);
    return any_divided_;
}

void ForceParts::measure_together(std::span<const std::uint32_t> groups, double from, double to)
{
    const double h = to - from;
    GroupSystem& system = motion_.system_for(groups, {});
    system.begin(from, to, {}, nullptr);
    list_members(system, groups);
    speeds_.assign(system.speeds().begin(), system.speeds().end());
    system.evaluate(0, 0);
    accelerations(system, h, start_);
    choose_directions();
    find_change(system, h, true, change_);
    follow_change([](const Member&, double own) { return own; });
    find_change(system, h, true, change_);
    find_largest();
    if (std::ranges::any_of(measured_, [](const Measured& m) { return m.largest > kSoft; }))
    {
        follow_change([&](const Member& m, double) { return measured_[m.group].largest; });
        find_change(system, h, true, change_);
        find_change(system, h, false, by_speeds_);
        divide(groups);
    }
    std::ranges::fill(system.coordinates(), 0.0);
    std::ranges::copy(speeds_, system.speeds().begin());
    system.evaluate_kinematics();
}

void ForceParts::list_members(const GroupSystem& system, std::span<const std::uint32_t> groups)
{
    measured_.assign(groups.size(), {}), members_.clear();
    for (std::uint32_t k = 0; k < groups.size(); ++k) place_[groups[k]] = k;
    const std::size_t bodies = system.bodies().size();
    for (std::size_t i = 0; i < bodies; ++i)
    {
        const RigidMember rigid = system.rigid(i);
        const double most = std::max({rigid.inertia_B(0, 0), rigid.inertia_B(1, 1), rigid.inertia_B(2, 2)});
        Member m;
        m.group = place_[step_.groups.group_of_body[system.bodies()[i]]];
        m.begin = 6 * i, m.end = 6 * i + 6, m.size = std::sqrt(most / rigid.mass), m.mass = rigid.mass;
        double& reach = measured_[m.group].reach;
        if (m.size > 0 && (reach == 0 || kReach * m.size < reach)) reach = kReach * m.size;
        members_.push_back(m);
    }
    for (std::size_t r = 0; r < system.roots().size(); ++r)
        members_.push_back({place_[step_.groups.group_of_shaft[system.roots()[r]]], 6 * bodies + r, 6 * bodies + r + 1, 0, 1});
    for (Measured& m : measured_)
        if (m.reach == 0) m.reach = kReachOfPoints;
}

/// Random unit vectors.
void ForceParts::choose_directions()
{
    direction_.resize(members_.empty() ? 0 : members_.back().end);
    for (const Member& m : members_)
    {
        std::uint64_t state = measured_[m.group].members++;
        const std::span<double> own = std::span(direction_).subspan(m.begin, m.end - m.begin);
        for (double& x : own) x = 2 * next_uniform(state) - 1;
        const double length = length_of(own);
        for (double& x : own) x = length > 0 ? x / length : 0.0;
    }
}

/// At the present state of the system, times h^2.
void ForceParts::accelerations(const GroupSystem& system, double h, Numbers& out) const
{
    out.resize(members_.empty() ? 0 : members_.back().end);
    const std::size_t bodies = system.bodies().size();
    for (std::size_t i = 0; i < bodies; ++i)
    {
        const RigidMember rigid = system.rigid(i);
        const Vec3 a = system.acceleration(i) * (h * h);
        const Vec3 turn = rigid.inverse_inertia_B * rotate_back(rigid.orientation, system.torque(i)) * (h * h * members_[i].size);
        std::copy_n(&a.x, 3, &out[6 * i]), std::copy_n(&turn.x, 3, &out[6 * i + 3]);
    }
    for (std::size_t r = 6 * bodies; r < out.size(); ++r) out[r] = system.speed_rates()[r] * h * h;
}

/// How accelerations, times h^2, change where members are displaced along `direction_` and have speeds that take them as far in h.
/// `of_positions`: otherwise they only have the speeds.
void ForceParts::find_change(GroupSystem& system, double h, bool of_positions, Numbers& out)
{
    const std::span<double> x = system.coordinates(), u = system.speeds();
    std::ranges::fill(x, 0.0);
    std::ranges::copy(speeds_, u.begin());
    for (std::size_t k = 0; k < members_.size(); ++k)
    {
        const Member& m = members_[k];
        const double reach = measured_[m.group].reach;
        for (std::size_t i = m.begin; i < std::min(m.end, m.begin + 3); ++i)
        {
            if (of_positions) x[i] = reach * direction_[i];
            u[i] += reach * direction_[i] / h;
        }
        if (m.end - m.begin < 6 || !(m.size > 0)) continue;
        const double* const d = &direction_[m.begin + 3];
        const Vec3 turn = Vec3{d[0], d[1], d[2]} * (reach / m.size);
        const RigidMember rigid = system.rigid(k);
        const Vec3 speed = rigid.needle ? turn / h : rotate(rigid.orientation, rigid.inertia_B * turn) / h;
        if (of_positions) x[m.begin + 3] = turn.x, x[m.begin + 4] = turn.y, x[m.begin + 5] = turn.z;
        u[m.begin + 3] += speed.x, u[m.begin + 4] += speed.y, u[m.begin + 5] += speed.z;
    }
    system.evaluate(0, 0);
    accelerations(system, h, out);
    for (const Member& m : members_)
        for (std::size_t i = m.begin; i < m.end; ++i) out[i] = (out[i] - start_[i]) / measured_[m.group].reach;
}

void ForceParts::find_largest()
{
    for (Measured& m : measured_) m.largest = 0;
    for (const Member& m : members_) measured_[m.group].largest = std::max(measured_[m.group].largest, length_of(m.of(change_)));
}

/// The next directions are the changes, divided by length(member, length of its change).
template <class Length>
void ForceParts::follow_change(const Length& length)
{
    for (const Member& m : members_)
    {
        const double unit = length(m, length_of(m.of(change_)));
        for (std::size_t i = m.begin; i < m.end; ++i) direction_[i] = unit > 0 ? change_[i] / unit : 0.0;
    }
}

void ForceParts::divide(std::span<const std::uint32_t> groups)
{
    for (Measured& m : measured_) m.direction = m.change = m.by_speeds = 0;
    for (const Member& m : members_)
    {
        Measured& own = measured_[m.group];
        for (std::size_t i = m.begin; i < m.end; ++i)
        {
            const double by_positions = change_[i] - by_speeds_[i];
            own.direction += m.mass * direction_[i] * direction_[i];
            own.change += m.mass * by_positions * by_positions;
            own.by_speeds += m.mass * by_speeds_[i] * by_speeds_[i];
        }
    }
    for (std::size_t k = 0; k < groups.size(); ++k)
    {
        const Measured& m = measured_[k];
        if (!(m.direction > 0)) continue;
        const double wanted = parts_for(std::sqrt(m.change / m.direction), std::sqrt(m.by_speeds / m.direction));
        if (!(wanted > 1)) continue;
        parts_[groups[k]] = static_cast<std::uint32_t>(std::min(wanted, kMost));
        any_divided_ = true;
        if (wanted > needed_) needed_ = wanted, stiffest_ = groups[k];
    }
}

void ForceParts::finish_step()
{
    if (needed_ <= kMost || std::exchange(step_.reported.stiff_forces, true)) return;
    const Group& group = step_.groups.all[stiffest_];
    const BlockRow& force = group.forces.front();
    Event e;
    e.time = step_.frame.start_time, e.kind = "force.stiff", e.severity = Severity::Warning;
    e.component = step_.world.tables()[step_.schedule.of(Phase::Force)[force.block].table]->component_of_row()[force.row];
    if (!group.bodies.empty()) e.a = {Facet::Body, group.bodies.front()};
    e.message = "forces on bodies in contact change too fast for the step: it would have to be divided into " + rounded_text(needed_, 3) +
                " parts, and is divided into " + rounded_text(kMost, 2) +
                "; shorter steps, a softer force, or a joint instead of it are stable";
    e.values = {needed_};
    step_.emit(std::move(e));
}

}  // namespace plab::simulation
