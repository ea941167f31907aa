// The movers of a problem while their bodies move: inertias, velocities with and without impulses, and what is written to the tables.
#include <cmath>

#include "plab/symmetric.h"
#include "problem.h"

namespace plab::managers
{
namespace
{

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

}  // namespace

void Problem::set_inertia(Mover& mover, Anchor& anchor, const Bodies& bodies)
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

void Problem::turn_inertia(std::size_t i, const Quat& by)
{
    const Mat3 R = rotation_matrix(by);
    movers[i].inverse_inertia = turned(R, movers[i].inverse_inertia);
    anchors[i].inertia = turned(R, anchors[i].inertia);
}

void Problem::turn_mover(std::size_t i, const Bodies& bodies)
{
    if (anchors[i].shaft) return;
    anchors[i].midway = false;
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

void Problem::weigh_turns(double factor)
{
    for (std::size_t i = 0; i < movers.size(); ++i)
        if (!anchors[i].shaft)
            anchors[i].inertia = anchors[i].inertia * factor, movers[i].inverse_inertia = movers[i].inverse_inertia * (1 / factor);
    for (Line& line : lines) set_mobility(line);
    for (Point& p : points) set_mobility(p);
}

void Problem::turn_lines()
{
    for (Line& line : lines)
        for (std::uint32_t i = 0; i < line.count; ++i)
        {
            const Anchor& anchor = anchors[line.mover[i]];
            const Facet facet = anchor.shaft ? Facet::Shaft : Facet::Body;
            const ConstraintRow& row = row_of(line);
            for (std::uint32_t k = 0; k < row.count; ++k)
                if (row.blocks[k].participant.facet == facet && row.blocks[k].participant.index == anchor.host)
                    line.linear[i] = row.blocks[k].linear, line.angular[i] = row.blocks[k].angular;
        }
    for (Line& line : lines) set_mobility(line);
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

void Problem::read_speed(std::size_t i, const Bodies& bodies, const Shafts& shafts)
{
    Anchor& m = anchors[i];
    m.written = {};
    if (m.shaft)
        m.v = {}, m.w = {shafts.speed[m.host], 0, 0};
    else
        m.v = bodies.velocity[m.host],
        m.w = m.midway ? movers[i].inverse_inertia * bodies.angular_momentum[m.host] : bodies.angular_velocity[m.host];
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

}  // namespace plab::managers
