// The loops over packets of contact points. Each is written once, for any number of lanes; loops over four lanes are compiled twice, for
// processors with and without AVX2, with the same results (plab/lanes.h).
#include <algorithm>
#include <atomic>

#include "contact_packets.h"
#include "movers.h"
#include "packet_parts.h"

namespace plab::managers
{

using namespace packet_parts;

template <int W>
void set_mobility(PacketList<W>& list, std::span<const Mover> movers, std::size_t begin, std::size_t end)
{
    const Mover none;
    const auto take_mass = [&](const std::array<std::uint32_t, W>& which, Lanes<W>& inverse_mass)
    {
        for (int l = 0; l < W; ++l) set_lane(inverse_mass, l, at(movers, which[static_cast<std::size_t>(l)], none).inverse_mass);
    };
    run_lanes<W>(PLAB_LANES {
        for (Packet<W>& packet : list.packets().subspan(begin, end - begin))
        {
            take_mass(packet.a, packet.inverse_mass_a), take_mass(packet.b, packet.inverse_mass_b);
            take_inertia<W>(movers, packet.a, packet.inverse_inertia_a, none);
            take_inertia<W>(movers, packet.b, packet.inverse_inertia_b, none);
            packet.turning = any_mover(packet, movers, [](const Mover& m) { return !m.isotropic; });
            packet.turning ? set_packet_mobility<false>(list, packet) : set_packet_mobility<true>(list, packet);
        }
    });
}

template <int W>
void set_mobility(PacketList<W>& list, std::span<const Mover> movers)
{
    list.in_parts([&](std::size_t begin, std::size_t end) { set_mobility(list, movers, begin, end); });
}

template <int W>
void sum_impulses(const PacketList<W>& list, std::span<Momentum> sums)
{
    const auto part = [&](std::size_t begin, std::size_t end)
    {
        Momentum none;
        run_lanes<W>(PLAB_LANES {
            for (const Packet<W>& packet : list.packets().subspan(begin, end - begin))
            {
                const Frame<W> frame(packet);
                LaneVec<W> push, turn_a, turn_b;
                for (std::uint32_t i = packet.first; i < packet.first + packet.count; ++i)
                {
                    const PacketPoint<W>& p = list.points()[i];
                    const LaneVec<W> j = frame.to_world(p.impulse);
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
        run_lanes<W>(PLAB_LANES {
            for (std::size_t k = begin; k < end; ++k)
                sweep_packet(list, list.packets()[how.backwards ? begin + end - 1 - k : k], movers, how, largest, none);
        });
        for (int l = 0; l < W; ++l) raise_to(most, lane(largest, l));
    };
    list.by_colour(part, how.backwards);
    return most;
}

template <int W>
void follow_move_and_sweep(PacketList<W>& list, std::span<Mover> movers, const Moved& moved, std::span<SoftPoint<W>> soft)
{
    const auto part = [&](std::size_t begin, std::size_t end)
    {
        Lanes<W> largest{};
        Mover none;
        const MoverSpeeds still;
        run_lanes<W>(PLAB_LANES {
            for (Packet<W>& packet : list.packets().subspan(begin, end - begin))
            {
                follow_packet(list, packet, std::span<const Mover>(movers), moved, soft, none, still);
                sweep_packet(list, packet, movers, {.measures = false}, largest, none);
            }
        });
    };
    list.by_colour(part);
}

template <int W>
void follow_move(PacketList<W>& list, std::span<const Mover> movers, const Moved& moved, std::span<SoftPoint<W>> soft)
{
    const auto part = [&](std::size_t begin, std::size_t end)
    {
        const Mover none;
        const MoverSpeeds still;
        run_lanes<W>(PLAB_LANES {
            for (Packet<W>& packet : list.packets().subspan(begin, end - begin))
                follow_packet(list, packet, movers, moved, soft, none, still);
        });
    };
    list.in_parts(part);
}

template <int W>
void sweep_soft(PacketList<W>& list, std::span<Mover> movers, const SoftSweep& how, std::span<SoftPoint<W>> soft)
{
    const auto part = [&](std::size_t begin, std::size_t end)
    {
        Mover none;
        run_lanes<W>(PLAB_LANES {
            for (const Packet<W>& packet : list.packets().subspan(begin, end - begin))
                packet.turning ? soften_packet<false>(list, packet, movers, how, soft, none)
                               : soften_packet<true>(list, packet, movers, how, soft, none);
        });
    };
    list.by_colour(part);
}

template <int W>
void gather_and_clear(PacketList<W>& list, std::span<SoftPoint<W>> soft)
{
    const auto part = [&](std::size_t begin, std::size_t end)
    {
        run_lanes<W>(PLAB_LANES {
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

template <int W>
double report_contacts(const PacketList<W>& list, std::span<Mover> movers, std::span<const SoftPoint<W>> soft, bool returned, double h,
                       std::span<Contact> contacts)
{
    std::atomic<double> fastest{0};
    const auto part = [&](std::size_t begin, std::size_t end)
    {
        Mover none;
        Lanes<W> most{};
        run_lanes<W>(PLAB_LANES {
            for (std::size_t k = begin; k < end; ++k)
            {
                list.visit_contacts(k + 2, [&](std::uint32_t contact) { fetch(contacts[contact], true); });
                const Packet<W>& packet = list.packets()[k];
                const Velocities<W> a = gather<W>(movers, packet.a, none), b = gather<W>(movers, packet.b, none);
                const Frame<W> frame(packet);
                for (std::uint32_t i = packet.first; i < packet.first + packet.count; ++i)
                {
                    const PacketPoint<W>& p = list.points()[i];
                    const LaneVec<W> u = velocity_of(frame, p, list.given(), i, a, b), j = frame.to_world(p.impulse + soft[i].sum);
                    const Lanes<W> slip = root(u.x * u.x + u.y * u.y), zero{};
                    Lanes<W> depth_before{};
                    list.visit_point(k, i,
                                     [&](std::uint32_t contact, int l)
                                     {
                                         contacts[contact].impulse = lane(j, l), contacts[contact].slip = lane(slip, l);
                                         set_lane(depth_before, l, contacts[contact].depth);
                                     });
                    const Lanes<W> growth = smaller(zero - u.z, (soft[i].depth - larger(depth_before, zero)) * (1 / h));
                    const Lanes<W> acts = soft[i].depth >= 0 ? p.inverse_normal : zero, closing = acts > 0 ? growth : zero;
                    most = larger(most, returned ? (p.impulse.z > 0 ? zero : closing) : closing);
                }
            }
        });
        for (int l = 0; l < W; ++l) raise_to(fastest, lane(most, l));
    };
    list.in_parts(part);
    return fastest;
}

#define PLAB_INSTANTIATE(W)                                                                                                 \
    template void set_mobility<W>(PacketList<W>&, std::span<const Mover>);                                                  \
    template void set_mobility<W>(PacketList<W>&, std::span<const Mover>, std::size_t, std::size_t);                        \
    template void sum_impulses<W>(const PacketList<W>&, std::span<Momentum>);                                               \
    template double sweep_hard<W>(PacketList<W>&, std::span<Mover>, const HardSweep&);                                      \
    template void sweep_soft<W>(PacketList<W>&, std::span<Mover>, const SoftSweep&, std::span<SoftPoint<W>>);               \
    template void follow_move<W>(PacketList<W>&, std::span<const Mover>, const Moved&, std::span<SoftPoint<W>>);            \
    template void follow_move_and_sweep<W>(PacketList<W>&, std::span<Mover>, const Moved&, std::span<SoftPoint<W>>);        \
    template void gather_and_clear<W>(PacketList<W>&, std::span<SoftPoint<W>>);                                             \
    template double report_contacts<W>(const PacketList<W>&, std::span<Mover>, std::span<const SoftPoint<W>>, bool, double, \
                                       std::span<Contact>);
PLAB_INSTANTIATE(1)
PLAB_INSTANTIATE(4)

}  // namespace plab::managers
