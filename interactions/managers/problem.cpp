#include "problem.h"

#include <algorithm>
#include <cmath>

#include "plab/contact_mobility.h"
#include "plab/symmetric.h"

namespace plab::managers
{
namespace
{

/// Largest eigenvalue of the tangential 2 x 2 part of K.
double slip_mobility(const Mat3& K)
{
    const double mean = 0.5 * (K(0, 0) + K(1, 1)), half = 0.5 * (K(0, 0) - K(1, 1));
    return mean + std::sqrt(half * half + K(0, 1) * K(0, 1));
}

/// R A R^T of a symmetric matrix A, half of which is computed.
Mat3 turned(const Mat3& R, const Mat3& A)
{
    const bool diagonal = A(0, 1) == 0 && A(0, 2) == 0 && A(1, 2) == 0;
    const Mat3 T = diagonal ? Mat3{{{R.m[0][0] * A.m[0][0], R.m[0][1] * A.m[1][1], R.m[0][2] * A.m[2][2]},
                                    {R.m[1][0] * A.m[0][0], R.m[1][1] * A.m[1][1], R.m[1][2] * A.m[2][2]},
                                    {R.m[2][0] * A.m[0][0], R.m[2][1] * A.m[1][1], R.m[2][2] * A.m[2][2]}}}
                            : R * A;
    const auto entry = [&](int i, int j) { return T.m[i][0] * R.m[j][0] + T.m[i][1] * R.m[j][1] + T.m[i][2] * R.m[j][2]; };
    const double xy = entry(0, 1), xz = entry(0, 2), yz = entry(1, 2);
    return {{{entry(0, 0), xy, xz}, {xy, entry(1, 1), yz}, {xz, yz, entry(2, 2)}}};
}

/// Sets the inertias of a body at its present attitude.
void set_inertia(Mover& mover, Anchor& anchor, const Bodies& bodies)
{
    const std::uint32_t b = anchor.host;
    mover.isotropic = is_isotropic(bodies.inertia_B[b]);
    if (mover.isotropic)
    {
        mover.inverse_inertia = bodies.inverse_inertia_B[b], anchor.inertia = bodies.inertia_B[b];
        return;
    }
    const Mat3 R = rotation_matrix(bodies.orientation[b]);
    mover.inverse_inertia = turned(R, bodies.inverse_inertia_B[b]);
    anchor.inertia = turned(R, bodies.inertia_B[b]);
}

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

void Problem::turn_mover(std::size_t i, const Bodies& bodies)
{
    if (anchors[i].shaft) return;
    if (!movers[i].isotropic) set_inertia(movers[i], anchors[i], bodies);
    // The momentum is constant while a body turns freely; the spin without impulses is what the impulses have not contributed to it.
    anchors[i].w = bodies.angular_velocity[anchors[i].host] - movers[i].inverse_inertia * anchors[i].written;
}

void Problem::turn_with(const Bodies& bodies)
{
    for_each(movers.size(), [&](std::size_t i) { turn_mover(i, bodies); });
    for (Line& line : lines) set_mobility(line);
    for (Point& p : points)
        if (!is_isotropic_at(p.a) || !is_isotropic_at(p.b)) set_mobility(p);
}

/// A mover has turned for h (s).
void Problem::note_turn(std::size_t i, double h)
{
    constexpr double kMuch = 0x1p-8;  // rad: then mobilities differ by less than 1 %, and a sweep gets as far with them
    Mover& m = movers[i];
    double& turned = anchors[i].turned;
    turned += std::fabs(h) * (std::fabs(m.w.x) + std::fabs(m.w.y) + std::fabs(m.w.z));
    m.turned = !(turned < kMuch);
    if (m.turned) turned = 0;
}

void Problem::turn_movers_and_apply(const Bodies& bodies, double h, std::span<MoverSpeeds> moved)
{
    for_each(movers.size(),
             [&](std::size_t i)
             {
                 moved[i] = {movers[i].v, movers[i].w}, anchors[i].moved_with = sums[i].turn;
                 turn_mover(i, bodies);
                 apply_sums(i);
                 note_turn(i, h);
             });
    for (Line& line : lines) set_mobility(line);
}

void Problem::turn_movers_back(const Bodies& bodies, double h)
{
    for_each(movers.size(),
             [&](std::size_t i)
             {
                 turn_mover(i, bodies);
                 apply_sums(i);
                 note_turn(i, h);
             });
    for (Line& line : lines) set_mobility(line);
}

void Problem::apply_moved(std::span<const MoverSpeeds> moved)
{
    for_each(movers.size(),
             [&](std::size_t i)
             {
                 sums[i] = {(moved[i].v - anchors[i].v) * anchors[i].mass, anchors[i].moved_with};
                 apply_sums(i);
             });
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
    movers.clear(), anchors.clear(), lines.clear(), points.clear(), carried_.clear();
    contacts_ = island.contacts, rows_ = island.rows;
    interruption = island.interruption;
    add_bodies(island, bodies);
    add_shafts(island, shafts);
    for (std::uint32_t i = 0; i < island.rows.size(); ++i) add_line(island.rows[i], i);
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

void Problem::read_speed(std::size_t i, const Bodies& bodies, const Shafts& shafts)
{
    Anchor& m = anchors[i];
    m.written = {};
    if (m.shaft)
        m.v = {}, m.w = {shafts.speed[m.host], 0, 0};
    else
        m.v = bodies.velocity[m.host], m.w = bodies.angular_velocity[m.host];
}

void Problem::read_speeds(const Bodies& bodies, const Shafts& shafts)
{
    for_each(movers.size(), [&](std::size_t i) { read_speed(i, bodies, shafts); });
    read_given(bodies, shafts);
}

double Problem::read_speeds_and_apply(const Bodies& bodies, const Shafts& shafts)
{
    return 0.5 * sum_over_movers(
                     [&](std::size_t i)
                     {
                         read_speed(i, bodies, shafts);
                         apply_sums(i);
                         return twice_energy(anchors[i], anchors[i].v, anchors[i].w);
                     });
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
    for (Line& line : lines)
    {
        const ConstraintRow& row = rows_[line.row];
        line.given = 0;
        for (std::uint32_t k = 0; k < row.count; ++k)
        {
            const RowBlock& block = row.blocks[k];
            if (!block.participant.valid()) continue;
            bool moves = false;
            for (std::uint32_t i = 0; i < line.count; ++i)
                moves = moves || (anchors[line.mover[i]].host == block.participant.index &&
                                  anchors[line.mover[i]].shaft == (block.participant.facet == Facet::Shaft));
            if (moves) continue;
            if (block.participant.facet == Facet::Body)
                line.given += dot(block.linear, bodies.velocity[block.participant.index]) +
                              dot(block.angular, bodies.angular_velocity[block.participant.index]);
            else if (block.participant.facet == Facet::Shaft)
                line.given += block.angular.x * shafts.speed[block.participant.index];
        }
    }
}

void Problem::rest()
{
    for (Anchor& m : anchors) m.v = m.w = {};
    for (Point& p : points) p.given = {};
    for (Line& line : lines) line.given = 0;
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

void Problem::apply_sums(std::size_t i)
{
    const Anchor& anchor = anchors[i];
    Mover& m = movers[i];
    m.v = anchor.v + sums[i].push * m.inverse_mass;
    m.w = anchor.w + m.inverse_inertia * sums[i].turn;
}

void Problem::apply_same_impulses()
{
    for_each(movers.size(), [&](std::size_t i) { apply_sums(i); });
}

void Problem::sum_by_velocity(std::size_t i)
{
    const Anchor& anchor = anchors[i];
    sums[i].push = (movers[i].v - anchor.v) * anchor.mass;
    sums[i].turn = anchor.inertia * (movers[i].w - anchor.w);
}

void Problem::sum_by_velocities()
{
    for_each(movers.size(), [&](std::size_t i) { sum_by_velocity(i); });
}

void Problem::write_speed(std::size_t i, Bodies& bodies, Shafts& shafts, bool swept)
{
    Anchor& m = anchors[i];
    if (m.shaft)
    {
        shafts.speed[m.host] = movers[i].w.x;
        return;
    }
    // The angular momentum is the state: it changes by the impulses themselves.
    bodies.velocity[m.host] = movers[i].v;
    const Vec3 turn = sums[i].turn, more = turn - m.written;
    if (more == Vec3{}) return;
    m.written = turn;
    if (!swept || bodies.needle[m.host] != 0) return bodies.add_angular_impulse(m.host, more);
    Vec3& momentum = bodies.angular_momentum[m.host];
    momentum += more;
    bodies.angular_velocity[m.host] = movers[i].inverse_inertia * momentum;
}

void Problem::write_speeds(Bodies& bodies, Shafts& shafts)
{
    for_each(movers.size(), [&](std::size_t i) { write_speed(i, bodies, shafts); });
}

double Problem::write_swept_speeds(Bodies& bodies, Shafts& shafts)
{
    return 0.5 * sum_over_movers(
                     [&](std::size_t i)
                     {
                         sum_by_velocity(i);
                         write_speed(i, bodies, shafts, true);
                         return twice_energy(anchors[i], movers[i].v, movers[i].w);
                     });
}

void Problem::refresh_spins(Bodies& bodies)
{
    for_each(movers.size(),
             [&](std::size_t i)
             {
                 const Anchor& m = anchors[i];
                 if (!m.shaft && bodies.needle[m.host] == 0) bodies.refresh_spin(m.host);
             });
}

double Problem::rate(const Line& line) const
{
    double sum = line.given;
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
