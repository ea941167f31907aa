// The loops over packets of contact points. Each is written once, for any number of lanes; loops over four lanes are compiled twice, for
// processors with and without AVX2, with the same results (lanes.h).
#include <algorithm>

#include "contact_packets.h"
#include "movers.h"

namespace plab::managers
{
namespace
{

#if defined(__x86_64__)
template <class Work>
__attribute__((target("avx2"))) void run_with_avx2(const Work& work)
{
    work();
}

bool has_avx2()
{
    static const bool has = __builtin_cpu_supports("avx2") != 0;
    return has;
}
#endif

/// `work` must be an always-inline lambda, which then is compiled for the instruction set of the function that it is inlined into.
template <int W, class Work>
void run(const Work& work)
{
#if defined(__x86_64__)
    if constexpr (W == 4)
        if (has_avx2()) return run_with_avx2(work);
#endif
    work();
}
#define PLAB_LOOP [&]() __attribute__((always_inline))

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

template <int W>
PLAB_INLINE Velocities<W> gather(std::span<Mover> movers, const std::array<std::uint32_t, W>& which, Mover& none)
{
    const Mover& m0 = at(movers, which[0], none);
    if constexpr (W == 1)
        return {gathered(m0.v), gathered(m0.w)};
    else
    {
        const Mover &m1 = at(movers, which[1], none), &m2 = at(movers, which[2], none), &m3 = at(movers, which[3], none);
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

template <int W>
PLAB_INLINE void push(const Packet<W>& packet, const PacketPoint<W>& p, const LaneVec<W>& t2, const LaneVec<W>& change, Velocities<W>& a,
                      Velocities<W>& b)
{
    const LaneVec<W> j = scaled(p.t1, change.x) + scaled(t2, change.y) + scaled(p.n, change.z);
    b.v = b.v + scaled(j, packet.inverse_mass_b), b.w = b.w + packet.inverse_inertia_b * cross(p.r_b, j);
    a.v = a.v - scaled(j, packet.inverse_mass_a), a.w = a.w - packet.inverse_inertia_a * cross(p.r_a, j);
}

/// Takes the normal impulse as given by `wanted`, clamped, and the friction that answers the slip with it; applies the change.
template <int W>
PLAB_INLINE LaneVec<W> change_impulse(const Packet<W>& packet, PacketPoint<W>& p, const LaneVec<W>& t2, const LaneVec<W>& u,
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
    push(packet, p, t2, by, a, b);
    return by;
}

template <int W>
PLAB_INLINE void gather_point(const PacketPoint<W>& p, SoftPoint<W>& soft)
{
    soft.sum = soft.sum + p.impulse;
    soft.greatest = larger(soft.greatest, p.impulse.z);
}

template <int W>
PLAB_INLINE void set_point_mobility(const Packet<W>& packet, PacketPoint<W>& p)
{
    const LaneVec<W> t2 = cross(p.n, p.t1);
    const LaneVec<W> a_x = cross(p.r_a, p.t1), a_y = cross(p.r_a, t2), a_z = cross(p.r_a, p.n);
    const LaneVec<W> b_x = cross(p.r_b, p.t1), b_y = cross(p.r_b, t2), b_z = cross(p.r_b, p.n);
    const LaneVec<W> of_a_x = packet.inverse_inertia_a * a_x, of_a_y = packet.inverse_inertia_a * a_y;
    const LaneVec<W> of_b_x = packet.inverse_inertia_b * b_x, of_b_y = packet.inverse_inertia_b * b_y;
    const LaneVec<W> of_a_z = packet.inverse_inertia_a * a_z, of_b_z = packet.inverse_inertia_b * b_z;
    const Lanes<W> mass = packet.inverse_mass_a + packet.inverse_mass_b;
    const Lanes<W> K_xx = mass + dot(a_x, of_a_x) + dot(b_x, of_b_x), K_yy = mass + dot(a_y, of_a_y) + dot(b_y, of_b_y);
    const Lanes<W> K_xy = dot(a_x, of_a_y) + dot(b_x, of_b_y), K_zz = mass + dot(a_z, of_a_z) + dot(b_z, of_b_z);
    p.K_xz = dot(a_x, of_a_z) + dot(b_x, of_b_z), p.K_yz = dot(a_y, of_a_z) + dot(b_y, of_b_z);
    const Lanes<W> mean = 0.5 * (K_xx + K_yy), half = 0.5 * (K_xx - K_yy), slip = mean + root(half * half + K_xy * K_xy);
    const Lanes<W> one = Lanes<W>{} + 1.0;
    p.inverse_normal = K_zz > 0 ? one / K_zz : Lanes<W>{};
    p.inverse_slip = K_zz > 0 ? one / slip : Lanes<W>{};
}

}  // namespace

template <int W>
void set_mobility(PacketList<W>& list, std::span<const Mover> movers)
{
    const auto all_parts = [&](const auto& loop)
    {
        list.in_parts(
            [&](std::size_t begin, std::size_t end)
            {
                for (Packet<W>& packet : list.packets().subspan(begin, end - begin)) loop(packet);
            });
    };
    all_parts([](Packet<W>& packet) { packet.turning = true; });
    refresh_mobility(list, movers);
    const auto turns = [&](std::uint32_t mover) { return mover != kNoIndex && !movers[mover].isotropic; };
    all_parts(
        [&](Packet<W>& packet)
        { packet.turning = std::any_of(packet.a.begin(), packet.a.end(), turns) || std::any_of(packet.b.begin(), packet.b.end(), turns); });
}

template <int W>
void refresh_mobility(PacketList<W>& list, std::span<const Mover> movers)
{
    const auto take = [&](const std::array<std::uint32_t, W>& which, Lanes<W>& inverse_mass, LaneSymmetric<W>& inverse_inertia)
    {
        for (int l = 0; l < W; ++l)
        {
            const std::uint32_t i = which[static_cast<std::size_t>(l)];
            if (i == kNoIndex) continue;
            const Mat3& I = movers[i].inverse_inertia;
            set_lane(inverse_mass, l, movers[i].inverse_mass);
            set_lane(inverse_inertia.xx, l, I(0, 0)), set_lane(inverse_inertia.xy, l, I(0, 1)), set_lane(inverse_inertia.xz, l, I(0, 2));
            set_lane(inverse_inertia.yy, l, I(1, 1)), set_lane(inverse_inertia.yz, l, I(1, 2)), set_lane(inverse_inertia.zz, l, I(2, 2));
        }
    };
    const auto refresh = [&](std::size_t begin, std::size_t end)
    {
        run<W>(PLAB_LOOP {
            for (Packet<W>& packet : list.packets().subspan(begin, end - begin))
            {
                if (!packet.turning) continue;
                take(packet.a, packet.inverse_mass_a, packet.inverse_inertia_a);
                take(packet.b, packet.inverse_mass_b, packet.inverse_inertia_b);
                for (std::uint32_t i = packet.first; i < packet.first + packet.count; ++i) set_point_mobility(packet, list.points()[i]);
            }
        });
    };
    list.in_parts(refresh);
}

template <int W>
void sum_impulses(const PacketList<W>& list, std::span<Momentum> sums)
{
    const auto part = [&](std::size_t begin, std::size_t end)
    {
        Momentum none;
        run<W>(PLAB_LOOP {
            for (const Packet<W>& packet : list.packets().subspan(begin, end - begin))
            {
                LaneVec<W> push, turn_a, turn_b;
                for (std::uint32_t i = packet.first; i < packet.first + packet.count; ++i)
                {
                    const PacketPoint<W>& p = list.points()[i];
                    const LaneVec<W> j = scaled(p.t1, p.impulse.x) + scaled(cross(p.n, p.t1), p.impulse.y) + scaled(p.n, p.impulse.z);
                    push = push + j, turn_a = turn_a + cross(p.r_a, j), turn_b = turn_b + cross(p.r_b, j);
                }
                const LaneVec<W> zero;
                add_to<W>(sums, packet.a, &Momentum::push, zero - push, none),
                    add_to<W>(sums, packet.a, &Momentum::turn, zero - turn_a, none);
                add_to<W>(sums, packet.b, &Momentum::push, push, none), add_to<W>(sums, packet.b, &Momentum::turn, turn_b, none);
            }
        });
    };
    list.by_colour(part);
}

template <int W>
double sweep_hard(PacketList<W>& list, std::span<Mover> movers, const HardSweep& how)
{
    std::atomic<double> most{0};
    const auto part = [&](std::size_t begin, std::size_t end)
    {
        Lanes<W> largest{};
        Mover none;
        run<W>(PLAB_LOOP {
            for (std::size_t k = begin; k < end; ++k)
            {
                const Packet<W>& packet = list.packets()[how.backwards ? begin + end - 1 - k : k];
                Velocities<W> a = gather<W>(movers, packet.a, none), b = gather<W>(movers, packet.b, none);
                for (std::uint32_t i = 0; i < packet.count; ++i)
                {
                    PacketPoint<W>& p = list.points()[packet.first + (how.backwards ? packet.count - 1 - i : i)];
                    const LaneVec<W> t2 = cross(p.n, p.t1), u_W = relative(p, a, b);
                    const LaneVec<W> u{dot(p.t1, u_W) + p.given.x, dot(t2, u_W) + p.given.y, dot(p.n, u_W) + p.given.z};
                    const Lanes<W> wanted = p.impulse.z - how.relaxation * (u.z - p.least) * p.inverse_normal;
                    const LaneVec<W> change = change_impulse(packet, p, t2, u, wanted, how.relaxation, how.friction_scale, a, b);
                    if (!how.measures) continue;
                    // An empty lane has no mobility and no change.
                    const Lanes<W> least = Lanes<W>{} + 1e-300;
                    largest = larger(largest, size_of(change.z) / larger(p.inverse_normal, least));
                    largest = larger(largest, larger(size_of(change.x), size_of(change.y)) / larger(p.inverse_slip, least));
                }
                scatter<W>(movers, packet.a, a, none), scatter<W>(movers, packet.b, b, none);
            }
        });
        for (int l = 0; l < W; ++l) raise_to(most, lane(largest, l));
    };
    list.by_colour(part, how.backwards);
    return most;
}

template <int W>
void sweep_soft(PacketList<W>& list, std::span<Mover> movers, const SoftSweep& how, std::span<SoftPoint<W>> soft)
{
    const auto part = [&](std::size_t begin, std::size_t end)
    {
        Mover none;
        run<W>(PLAB_LOOP {
            const Lanes<W> zero{};
            for (Packet<W>& packet : list.packets().subspan(begin, end - begin))
            {
                const auto one_sided = packet.one_sided > 0;
                const auto choose = [&](double single, double both) __attribute__((always_inline))
                {
                    return one_sided ? zero + single : zero + both;
                };
                const Lanes<W> bias_rate = choose(how.one_sided.bias_rate, how.between.bias_rate);
                const Lanes<W> mass_scale = choose(how.one_sided.mass_scale, how.between.mass_scale);
                const Lanes<W> impulse_scale = choose(how.one_sided.impulse_scale, how.between.impulse_scale);
                Velocities<W> a = gather<W>(movers, packet.a, none), b = gather<W>(movers, packet.b, none);
                for (std::uint32_t i = packet.first; i < packet.first + packet.count; ++i)
                {
                    PacketPoint<W>& p = list.points()[i];
                    if (how.gathers) gather_point(p, soft[i]);
                    const LaneVec<W> t2 = cross(p.n, p.t1), u_W = relative(p, a, b);
                    const LaneVec<W> u{dot(p.t1, u_W) + p.given.x, dot(t2, u_W) + p.given.y, dot(p.n, u_W) + p.given.z};
                    // A gap may close, and is hard; overlap is pushed out at a limited speed.
                    const Lanes<W> depth = soft[i].depth;
                    const auto gap = depth < 0;
                    const Lanes<W> least = gap ? depth * how.rate : smaller(bias_rate * depth, zero + how.push_speed);
                    const Lanes<W> scale = gap ? zero + 1.0 : mass_scale, leak = gap ? zero : impulse_scale;
                    const Lanes<W> wanted = p.impulse.z - scale * (u.z - least) * p.inverse_normal - leak * p.impulse.z;
                    (void)change_impulse(packet, p, t2, u, wanted, 1.0, 1.0, a, b);
                    soft[i].greatest = larger(soft[i].greatest, p.impulse.z);
                }
                scatter<W>(movers, packet.a, a, none), scatter<W>(movers, packet.b, b, none);
            }
        });
    };
    list.by_colour(part);
}

template <int W>
void advance_depths(PacketList<W>& list, std::span<Mover> movers, double h, std::span<SoftPoint<W>> soft)
{
    const auto part = [&](std::size_t begin, std::size_t end)
    {
        Mover none;
        run<W>(PLAB_LOOP {
            for (const Packet<W>& packet : list.packets().subspan(begin, end - begin))
            {
                const Velocities<W> a = gather<W>(movers, packet.a, none), b = gather<W>(movers, packet.b, none);
                for (std::uint32_t i = packet.first; i < packet.first + packet.count; ++i)
                {
                    PacketPoint<W>& p = list.points()[i];
                    soft[i].depth_before = soft[i].depth, soft[i].moved_with = p.impulse;
                    soft[i].depth = soft[i].depth - h * (dot(p.n, relative(p, a, b)) + p.given.z);
                    p.least = smaller(soft[i].depth, Lanes<W>{}) / h;
                }
            }
        });
    };
    list.in_parts(part);
}

template <int W>
void gather_and_clear(PacketList<W>& list, std::span<SoftPoint<W>> soft)
{
    const auto part = [&](std::size_t begin, std::size_t end)
    {
        run<W>(PLAB_LOOP {
            for (const Packet<W>& packet : list.packets().subspan(begin, end - begin))
                for (std::uint32_t i = packet.first; i < packet.first + packet.count; ++i)
                {
                    gather_point(list.points()[i], soft[i]);
                    list.points()[i].impulse = {};
                }
        });
    };
    list.in_parts(part);
}

#define PLAB_INSTANTIATE(W)                                                                                   \
    template void set_mobility<W>(PacketList<W>&, std::span<const Mover>);                                    \
    template void refresh_mobility<W>(PacketList<W>&, std::span<const Mover>);                                \
    template void sum_impulses<W>(const PacketList<W>&, std::span<Momentum>);                                 \
    template double sweep_hard<W>(PacketList<W>&, std::span<Mover>, const HardSweep&);                        \
    template void sweep_soft<W>(PacketList<W>&, std::span<Mover>, const SoftSweep&, std::span<SoftPoint<W>>); \
    template void advance_depths<W>(PacketList<W>&, std::span<Mover>, double, std::span<SoftPoint<W>>);       \
    template void gather_and_clear<W>(PacketList<W>&, std::span<SoftPoint<W>>);
PLAB_INSTANTIATE(1)
PLAB_INSTANTIATE(4)

}  // namespace plab::managers
