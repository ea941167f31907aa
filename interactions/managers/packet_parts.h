/// What the loops over packets of contact points do with one packet (contact_packets.h). Everything is inlined into loops that are compiled
/// for several instruction sets (plab/lanes.h).
#pragma once

#include "contact_packets.h"
#include "movers.h"

namespace plab::managers::packet_parts
{

/// Velocities of the movers on one side of a packet.
template <int W>
struct Velocities
{
    LaneVec<W> v, w;
};

/// A side that impulses do not move: it stands for a mover without mobility, whose velocity stays 0.
template <class T>
PLAB_INLINE T& at(std::span<T> all, std::uint32_t i, T& none)
{
    return i == kNoIndex ? none : all[i];
}

template <int W, class Of>
PLAB_INLINE Velocities<W> gather(std::span<Of> movers, const std::array<std::uint32_t, W>& which, Of& none)
{
    const Of& m0 = at(movers, which[0], none);
    if constexpr (W == 1)
        return {gathered(m0.v), gathered(m0.w)};
    else
    {
        const Of &m1 = at(movers, which[1], none), &m2 = at(movers, which[2], none), &m3 = at(movers, which[3], none);
        return {gathered(m0.v, m1.v, m2.v, m3.v), gathered(m0.w, m1.w, m2.w, m3.w)};
    }
}

template <int W>
PLAB_INLINE void scatter(std::span<Mover> movers, const std::array<std::uint32_t, W>& which, const Velocities<W>& of, Mover& none)
{
    if constexpr (W == 1)
    {
        Mover& m = at(movers, which[0], none);
        m.v = Vec3{of.v.x, of.v.y, of.v.z}, m.w = Vec3{of.w.x, of.w.y, of.w.z};
    }
    else
    {
        Lanes<W> v[4] = {of.v.x, of.v.y, of.v.z, Lanes<W>{}}, w[4] = {of.w.x, of.w.y, of.w.z, Lanes<W>{}};
        transpose(v[0], v[1], v[2], v[3]);
        transpose(w[0], w[1], w[2], w[3]);
        for (std::size_t l = 0; l < 4; ++l)
        {
            Mover& m = at(movers, which[l], none);
            store(m.v, v[l]), store(m.w, w[l]);
        }
    }
}

/// Adds one vector of each lane to `sum` of one element each.
template <int W>
PLAB_INLINE void add_to(std::span<Momentum> sums, const std::array<std::uint32_t, W>& which, PaddedVec3 Momentum::*sum,
                        const LaneVec<W>& by, Momentum& none)
{
    if constexpr (W == 1)
        at(sums, which[0], none).*sum += Vec3{by.x, by.y, by.z};
    else
    {
        Lanes<W> rows[4] = {by.x, by.y, by.z, Lanes<W>{}};
        transpose(rows[0], rows[1], rows[2], rows[3]);
        for (std::size_t l = 0; l < 4; ++l)
        {
            PaddedVec3& to = at(sums, which[l], none).*sum;
            store(to, load(to) + rows[l]);
        }
    }
}

/// Velocity of b's point relative to a's, in W.
template <int W>
PLAB_INLINE LaneVec<W> relative(const PacketPoint<W>& p, const Velocities<W>& a, const Velocities<W>& b)
{
    return b.v + cross(b.w, p.r_b) - a.v - cross(a.w, p.r_a);
}

/// What the points of a packet have in common while they are swept.
template <int W>
struct Frame
{
    LaneVec<W> n, t1, t2;

    PLAB_INLINE explicit Frame(const Packet<W>& packet) : n(packet.n), t1(packet.t1), t2(cross(packet.n, packet.t1)) {}
    PLAB_INLINE LaneVec<W> to_contact(const LaneVec<W>& v) const { return {dot(t1, v), dot(t2, v), dot(n, v)}; }
    PLAB_INLINE LaneVec<W> to_world(const LaneVec<W>& v) const { return scaled(t1, v.x) + scaled(t2, v.y) + scaled(n, v.z); }
};

/// u, m/s. `given`: of all points of the list, or none.
template <int W>
PLAB_INLINE LaneVec<W> velocity_of(const Frame<W>& frame, const PacketPoint<W>& p, std::span<const LaneVec<W>> given, std::size_t i,
                                   const Velocities<W>& a, const Velocities<W>& b)
{
    const LaneVec<W> u = frame.to_contact(relative(p, a, b));
    return given.empty() ? u : u + given[i];
}

/// I^-1 v; `kRound`: the matrix is a number times the identity, and only its first element is read.
template <bool kRound, int W>
PLAB_INLINE LaneVec<W> turned(const LaneSymmetric<W>& inverse_inertia, const LaneVec<W>& v)
{
    if constexpr (kRound)
        return scaled(v, inverse_inertia.xx);
    else
        return inverse_inertia * v;
}

template <bool kRound, int W>
PLAB_INLINE void push(const Packet<W>& packet, const Frame<W>& frame, const PacketPoint<W>& p, const LaneVec<W>& change, Velocities<W>& a,
                      Velocities<W>& b)
{
    const LaneVec<W> j = frame.to_world(change);
    b.v = b.v + scaled(j, packet.inverse_mass_b), b.w = b.w + turned<kRound>(packet.inverse_inertia_b, cross(p.r_b, j));
    a.v = a.v - scaled(j, packet.inverse_mass_a), a.w = a.w - turned<kRound>(packet.inverse_inertia_a, cross(p.r_a, j));
}

/// Takes the normal impulse as given by `wanted`, clamped, and the friction that answers the slip with it; applies the change.
template <bool kRound, int W>
PLAB_INLINE LaneVec<W> change_impulse(const Packet<W>& packet, const Frame<W>& frame, PacketPoint<W>& p, const LaneVec<W>& u,
                                      const Lanes<W>& wanted, double relaxation, double friction_scale, Velocities<W>& a, Velocities<W>& b)
{
    const LaneVec<W> before = p.impulse;
    p.impulse.z = larger(wanted, Lanes<W>{});
    const Lanes<W> change = p.impulse.z - before.z, k = p.inverse_slip * relaxation;
    // The tangential part uses the new normal impulse immediately.
    Lanes<W> x = before.x - k * (u.x + p.K_xz * change), y = before.y - k * (u.y + p.K_yz * change);
    const Lanes<W> radius = p.friction * friction_scale * p.impulse.z, squared = x * x + y * y;
    const auto slides = squared > radius * radius;
    if (any(slides))
    {
        const Lanes<W> share = slides ? radius / root(squared) : Lanes<W>{} + 1.0;
        x = x * share, y = y * share;
    }
    p.impulse.x = x, p.impulse.y = y;
    const LaneVec<W> by = p.impulse - before;
    push<kRound>(packet, frame, p, by, a, b);
    return by;
}

template <int W>
PLAB_INLINE void gather_point(const PacketPoint<W>& p, SoftPoint<W>& soft)
{
    soft.sum = soft.sum + p.impulse;
    soft.greatest = larger(soft.greatest, p.impulse.z);
}

/// `number`: of the point in its packet.
template <bool kRound, int W>
PLAB_INLINE void set_point_mobility(const Packet<W>& packet, const Frame<W>& frame, PacketPoint<W>& p, std::uint32_t number)
{
    const LaneVec<W> a_x = cross(p.r_a, frame.t1), a_y = cross(p.r_a, frame.t2), a_z = cross(p.r_a, frame.n);
    const LaneVec<W> b_x = cross(p.r_b, frame.t1), b_y = cross(p.r_b, frame.t2), b_z = cross(p.r_b, frame.n);
    const LaneVec<W> of_a_x = turned<kRound>(packet.inverse_inertia_a, a_x), of_a_y = turned<kRound>(packet.inverse_inertia_a, a_y);
    const LaneVec<W> of_b_x = turned<kRound>(packet.inverse_inertia_b, b_x), of_b_y = turned<kRound>(packet.inverse_inertia_b, b_y);
    const LaneVec<W> of_a_z = turned<kRound>(packet.inverse_inertia_a, a_z), of_b_z = turned<kRound>(packet.inverse_inertia_b, b_z);
    const Lanes<W> mass = packet.inverse_mass_a + packet.inverse_mass_b;
    const Lanes<W> K_xx = mass + dot(a_x, of_a_x) + dot(b_x, of_b_x), K_yy = mass + dot(a_y, of_a_y) + dot(b_y, of_b_y);
    const Lanes<W> K_xy = dot(a_x, of_a_y) + dot(b_x, of_b_y), K_zz = mass + dot(a_z, of_a_z) + dot(b_z, of_b_z);
    p.K_xz = dot(a_x, of_a_z) + dot(b_x, of_b_z), p.K_yz = dot(a_y, of_a_z) + dot(b_y, of_b_z);
    const Lanes<W> mean = 0.5 * (K_xx + K_yy), half = 0.5 * (K_xx - K_yy), slip = mean + root(half * half + K_xy * K_xy);
    const Lanes<W> one = Lanes<W>{} + 1.0, size = packet.points > number ? K_zz : Lanes<W>{};
    p.inverse_normal = size > 0 ? one / K_zz : Lanes<W>{};
    p.inverse_slip = size > 0 ? one / slip : Lanes<W>{};
}

template <bool kRound, int W>
PLAB_INLINE void set_packet_mobility(PacketList<W>& list, const Packet<W>& packet)
{
    const Frame<W> frame(packet);
    for (std::uint32_t k = 0; k < packet.count; ++k) set_point_mobility<kRound>(packet, frame, list.points()[packet.first + k], k);
}

/// Whether one(mover) is true for some mover of a packet.
template <int W, class One>
PLAB_INLINE bool any_mover(const Packet<W>& packet, std::span<const Mover> movers, const One& one)
{
    bool any = false;
    for (std::size_t l = 0; l < W; ++l)
        any = any || (packet.a[l] != kNoIndex && one(movers[packet.a[l]])) || (packet.b[l] != kNoIndex && one(movers[packet.b[l]]));
    return any;
}

template <int W>
PLAB_INLINE void take_inertia(std::span<const Mover> movers, const std::array<std::uint32_t, W>& which, LaneSymmetric<W>& inverse_inertia,
                              const Mover& none)
{
    const auto of = [&](std::size_t l) __attribute__((always_inline))->const Mat3& { return at(movers, which[l], none).inverse_inertia; };
    if constexpr (W == 1)
        inverse_inertia = gathered(of(0));
    else
        inverse_inertia = gathered(of(0), of(1), of(2), of(3));
}

/// See follow_move().
template <int W>
PLAB_INLINE void follow_packet(PacketList<W>& list, Packet<W>& packet, std::span<const Mover> movers, const Moved& moved,
                               std::span<SoftPoint<W>> soft, const Mover& none, const MoverSpeeds& still)
{
    const Velocities<W> a = gather<W>(moved.speeds, packet.a, still), b = gather<W>(moved.speeds, packet.b, still);
    const std::span<const LaneVec<W>> given = list.given();
    for (std::uint32_t i = packet.first; i < packet.first + packet.count; ++i)
    {
        PacketPoint<W>& p = list.points()[i];
        const Lanes<W> own = dot(packet.n, relative(p, a, b));
        soft[i].depth = soft[i].depth - moved.h * (given.empty() ? own : own + given[i].z);
        p.least = smaller(soft[i].depth, Lanes<W>{}) * moved.rate;
    }
    if (!packet.turning) return;
    take_inertia<W>(movers, packet.a, packet.inverse_inertia_a, none), take_inertia<W>(movers, packet.b, packet.inverse_inertia_b, none);
    if (any_mover(packet, movers, [](const Mover& m) { return m.turned; })) set_packet_mobility<false>(list, packet);
}

/// One packet of sweep_hard(). Raises `largest` to the largest change, m/s, if that is measured.
template <bool kRound, int W>
PLAB_INLINE void sweep_packet_of(PacketList<W>& list, const Packet<W>& packet, std::span<Mover> movers, const HardSweep& how,
                                 Lanes<W>& largest, Mover& none)
{
    Velocities<W> a = gather<W>(movers, packet.a, none), b = gather<W>(movers, packet.b, none);
    const Frame<W> frame(packet);
    for (std::uint32_t k = 0; k < packet.count; ++k)
    {
        const std::uint32_t i = packet.first + (how.backwards ? packet.count - 1 - k : k);
        PacketPoint<W>& p = list.points()[i];
        const LaneVec<W> u = velocity_of(frame, p, list.given(), i, a, b);
        const Lanes<W> wanted = p.impulse.z - how.relaxation * (u.z - p.least) * p.inverse_normal;
        const LaneVec<W> change = change_impulse<kRound>(packet, frame, p, u, wanted, how.relaxation, how.friction_scale, a, b);
        if (!how.measures) continue;
        // What has no mobility does not change.
        const Lanes<W> least = Lanes<W>{} + 1e-300;
        largest = larger(largest, size_of(change.z) / larger(p.inverse_normal, least));
        largest = larger(largest, larger(size_of(change.x), size_of(change.y)) / larger(p.inverse_slip, least));
    }
    scatter<W>(movers, packet.a, a, none), scatter<W>(movers, packet.b, b, none);
}

template <int W>
PLAB_INLINE void sweep_packet(PacketList<W>& list, const Packet<W>& packet, std::span<Mover> movers, const HardSweep& how,
                              Lanes<W>& largest, Mover& none)
{
    packet.turning ? sweep_packet_of<false>(list, packet, movers, how, largest, none)
                   : sweep_packet_of<true>(list, packet, movers, how, largest, none);
}

/// One packet of sweep_soft().
template <bool kRound, int W>
PLAB_INLINE void soften_packet(PacketList<W>& list, const Packet<W>& packet, std::span<Mover> movers, const SoftSweep& how,
                               std::span<SoftPoint<W>> soft, Mover& none)
{
    const Lanes<W> zero{};
    const auto one_sided = packet.one_sided > 0;
    const auto choose = [&](double single, double both) __attribute__((always_inline)) { return one_sided ? zero + single : zero + both; };
    const Lanes<W> bias_rate = choose(how.one_sided.bias_rate, how.between.bias_rate);
    const Lanes<W> mass_scale = choose(how.one_sided.mass_scale, how.between.mass_scale);
    const Lanes<W> impulse_scale = choose(how.one_sided.impulse_scale, how.between.impulse_scale);
    Velocities<W> a = gather<W>(movers, packet.a, none), b = gather<W>(movers, packet.b, none);
    const Frame<W> frame(packet);
    for (std::uint32_t i = packet.first; i < packet.first + packet.count; ++i)
    {
        PacketPoint<W>& p = list.points()[i];
        if (how.gathers) gather_point(p, soft[i]);
        const LaneVec<W> u = velocity_of(frame, p, list.given(), i, a, b);
        // A gap may close, and is hard; overlap is pushed out at a limited speed.
        const Lanes<W> depth = soft[i].depth;
        const auto gap = depth < 0;
        const Lanes<W> least = gap ? depth * how.rate : smaller(bias_rate * depth, zero + how.push_speed);
        const Lanes<W> scale = gap ? zero + 1.0 : mass_scale, leak = gap ? zero : impulse_scale;
        const Lanes<W> wanted = p.impulse.z - scale * (u.z - least) * p.inverse_normal - leak * p.impulse.z;
        (void)change_impulse<kRound>(packet, frame, p, u, wanted, 1.0, 1.0, a, b);
        soft[i].greatest = larger(soft[i].greatest, p.impulse.z);
    }
    scatter<W>(movers, packet.a, a, none), scatter<W>(movers, packet.b, b, none);
}

}  // namespace plab::managers::packet_parts
