#include "problem.h"

#include <algorithm>
#include <cmath>

#include "plab/contact_mobility.h"
#include "plab/rotation.h"
#include "plab/row_speed.h"

namespace plab::managers
{
namespace
{

void add_mobility(Point& p, const Mover& m, const Vec3& r)
{
    add_turning_mobility(p.K, m.inverse_inertia, r, p.t1, p.t2, p.n);
    for (int i = 0; i < 3; ++i) p.K(i, i) += m.inverse_mass;
}

}  // namespace

void Problem::set_mobility(Point& p) const
{
    p.K = {};
    if (p.a != kNoIndex) add_mobility(p, movers[p.a], p.r_a);
    if (p.b != kNoIndex) add_mobility(p, movers[p.b], p.r_b);
    p.slip_mobility = slip_mobility(p.K);
}

void Problem::set_mobility(Line& line) const
{
    line.mobility = 0;
    for (std::uint32_t k = 0; k < line.count; ++k)
    {
        const Mover& m = movers[line.mover[k]];
        line.mobility += m.inverse_mass * length_squared(line.linear[k]) + dot(line.angular[k], m.inverse_inertia * line.angular[k]);
    }
}

void Problem::add_bodies(const Island& island, const Bodies& bodies)
{
    mover_of_body_.resize(bodies.size(), kNoIndex);
    for (const std::uint32_t b : island.bodies)
    {
        mover_of_body_[b] = static_cast<std::uint32_t>(movers.size());
        Mover& m = movers.emplace_back();
        m.inverse_mass = bodies.inverse_mass[b];
        Anchor& anchor = anchors.emplace_back();
        anchor.host = b, anchor.mass = bodies.mass[b];
        set_inertia(m, anchor, bodies);
    }
}

void Problem::add_shafts(const Island& island, const Shafts& shafts)
{
    mover_of_shaft_.resize(shafts.size(), kNoIndex);
    for (const std::uint32_t s : island.shafts)
    {
        mover_of_shaft_[s] = static_cast<std::uint32_t>(movers.size());
        const double mobility = s < island.shaft_mobility.size() ? island.shaft_mobility[s] : shafts.inverse_inertia[s];
        Mover& m = movers.emplace_back();
        m.inverse_inertia(0, 0) = mobility;
        Anchor& anchor = anchors.emplace_back();
        anchor.host = s, anchor.shaft = true;
        anchor.inertia = Mat3::diagonal(mobility > 0 ? 1 / mobility : 1.0, 1, 1);
    }
}

std::uint32_t Problem::mover_of(Ref participant) const
{
    if (participant.facet == Facet::Body && participant.index < mover_of_body_.size()) return mover_of_body_[participant.index];
    if (participant.facet == Facet::Shaft && participant.index < mover_of_shaft_.size()) return mover_of_shaft_[participant.index];
    return kNoIndex;
}

void Problem::set_point(Point& p, const Contact& c, const Bodies& bodies) const
{
    p = {};
    p.a = mover_of(c.a), p.b = mover_of(c.b);
    p.n = c.normal;
    p.t1 = any_perpendicular(p.n), p.t2 = cross(p.n, p.t1);
    p.r_a = c.point - bodies.position[c.a.index], p.r_b = c.point - bodies.position[c.b.index];
    p.friction = c.friction;
    if (!p.mobile()) return;
    // The normal may have turned since, and the friction may have changed: the initial impulse is projected onto the cone.
    p.impulse = to_contact(p, c.impulse);
    p.impulse.z = std::max(0.0, p.impulse.z);
    p.impulse = within_disc(p.impulse, p.friction * p.impulse.z);
}

void Problem::add_line(const ConstraintRow& row, std::uint32_t index)
{
    Line& line = lines.emplace_back();
    line.row = index;
    line.impulse = row.impulse;
    for (std::uint32_t k = 0; k < row.count; ++k)
    {
        const std::uint32_t mover = mover_of(row.blocks[k].participant);
        if (mover == kNoIndex) continue;
        const Mover& m = movers[mover];
        const Vec3 &linear = row.blocks[k].linear, &angular = row.blocks[k].angular;
        const double mobility = m.inverse_mass * length_squared(linear) + dot(angular, m.inverse_inertia * angular);
        if (!(mobility > 0)) continue;
        line.mobility += mobility;
        line.mover[line.count] = mover;
        line.linear[line.count] = linear, line.angular[line.count] = angular;
        ++line.count;
    }
    if (line.count == 0) line.impulse = 0;
}

void Problem::reserve(const IslandSize& size)
{
    movers.reserve(size.movers), anchors.reserve(size.movers), sums.reserve(size.movers);
    points.reserve(size.points), carried_.reserve(size.points);
    mover_of_body_.resize(size.bodies, kNoIndex), mover_of_shaft_.resize(size.shafts, kNoIndex);
    single.reserve(std::min(size.points, kSweptInOrder), size.movers);
    if (size.points > kSweptInOrder) fours.reserve(size.points, size.movers);
}

void Problem::load_movers(const Island& island, const Bodies& bodies, const Shafts& shafts)
{
    make_room(sums, island.bodies.size() + island.shafts.size());
    movers.clear(), anchors.clear(), lines.clear(), points.clear(), carried_.clear();
    contacts_ = island.contacts, rows_ = island.rows;
    interruption = island.interruption;
    add_bodies(island, bodies);
    add_shafts(island, shafts);
    for (std::uint32_t i = 0; i < island.rows.size(); ++i) add_line(island.rows[i], i);
    add_resistances(island, bodies);
}

/// Only these entries were written, so the maps are empty again for the next island at little cost.
void Problem::forget(const Island& island)
{
    for (const std::uint32_t b : island.bodies) mover_of_body_[b] = kNoIndex;
    for (const std::uint32_t s : island.shafts) mover_of_shaft_[s] = kNoIndex;
}

void Problem::load(const Island& island, const Bodies& bodies, const Shafts& shafts)
{
    load_movers(island, bodies, shafts);
    points.resize(island.contacts.size());
    for_each(points.size(),
             [&](std::size_t i)
             {
                 set_point(points[i], contacts_[i], bodies);
                 set_mobility(points[i]);
             });
    const auto is_carried = [&](std::uint32_t mover, Ref r) { return mover == kNoIndex && bodies.motion[r.index] != Motion::Static; };
    for (std::uint32_t i = 0; i < points.size(); ++i)
        if (is_carried(points[i].a, contacts_[i].a) || is_carried(points[i].b, contacts_[i].b)) carried_.push_back(i);
    forget(island);
    // A method may turn to sweeps in any step; this step would be the first to allocate.
    if (points.size() <= kSweptInOrder) single.reserve(points.size(), movers.size());
}

void Problem::read_given(const Bodies& bodies, const Shafts& shafts)
{
    for (const std::uint32_t i : carried_)
    {
        Point& p = points[i];
        Vec3 given;
        const Contact& c = contacts_[i];
        if (p.b == kNoIndex && bodies.motion[c.b.index] != Motion::Static) given += bodies.velocity_at(c.b.index, c.point);
        if (p.a == kNoIndex && bodies.motion[c.a.index] != Motion::Static) given -= bodies.velocity_at(c.a.index, c.point);
        p.given = to_contact(p, given);
    }
    for (Line& line : lines) line.given = line.resists() ? given_of_resistance(line, bodies) : given_of(line, bodies, shafts);
}

double Problem::given_of(const Line& line, const Bodies& bodies, const Shafts& shafts) const
{
    const ConstraintRow& row = rows_[line.row];
    double given = 0;
    for (std::uint32_t k = 0; k < row.count; ++k)
    {
        const RowBlock& block = row.blocks[k];
        if (block.participant.valid() && !moves(line, block.participant)) given += speed_of(block, bodies, shafts);
    }
    return given;
}

/// Whether a participant of a line is a mover.
bool Problem::moves(const Line& line, Ref participant) const
{
    const std::span<const std::uint32_t> own = std::span(line.mover).first(line.count);
    return std::ranges::any_of(own,
                               [&](std::uint32_t mover)
                               {
                                   const Anchor& anchor = anchors[mover];
                                   return anchor.host == participant.index && anchor.shaft == (participant.facet == Facet::Shaft);
                               });
}

void Problem::rest()
{
    for (Anchor& m : anchors) m.v = m.w = {};
    for (Point& p : points) p.given = p.turning = {};
    for (Line& line : lines) line.given = line.turning = 0;
}

void Problem::clear_impulses()
{
    for (Point& p : points) p.impulse = {};
    for (Line& line : lines) line.impulse = 0;
}

void Problem::scale_impulses(double share)
{
    for_each(points.size(), [&](std::size_t i) { points[i].impulse *= share; });
    for (Line& line : lines) line.impulse *= share;
}

void Problem::sum_line_impulses()
{
    clear_sums();
    for (const Line& line : lines)
        for (std::uint32_t k = 0; k < line.count; ++k)
        {
            Momentum& m = sums[line.mover[k]];
            m.push += line.linear[k] * line.impulse, m.turn += line.angular[k] * line.impulse;
        }
}

void Problem::apply_impulses()
{
    sum_line_impulses();
    for (const Point& p : points)
    {
        const Vec3 j = to_world(p, p.impulse);
        if (p.a != kNoIndex) sums[p.a].push -= j, sums[p.a].turn -= cross(p.r_a, j);
        if (p.b != kNoIndex) sums[p.b].push += j, sums[p.b].turn += cross(p.r_b, j);
    }
    apply_same_impulses();
}

double Problem::rate(const Line& line) const
{
    double sum = line.given + line.turning;
    for (std::uint32_t k = 0; k < line.count; ++k)
        sum += dot(line.linear[k], movers[line.mover[k]].v) + dot(line.angular[k], movers[line.mover[k]].w);
    return sum;
}

void Problem::push(const Line& line, double j)
{
    for (std::uint32_t k = 0; k < line.count; ++k)
    {
        Mover& m = movers[line.mover[k]];
        m.v += line.linear[k] * (j * m.inverse_mass);
        m.w += m.inverse_inertia * (line.angular[k] * j);
    }
}

double Problem::rounding(double terms) const
{
    double speed = 0, given = 0;
    for (const Point& p : points)
    {
        speed = std::max(speed, length_squared(relative_velocity(p)));
        given = std::max(given, p.impulse.z * p.K(2, 2));
    }
    speed = std::sqrt(speed);
    for (const Line& line : lines)
    {
        if (line.count == 0) continue;
        speed = std::max(speed, std::fabs(rate(line)));
        given = std::max(given, std::fabs(line.impulse) * line.mobility);
    }
    return std::max(0x1p-46 * speed, 0x1p-50 * std::sqrt(terms) * given);
}

}  // namespace plab::managers
