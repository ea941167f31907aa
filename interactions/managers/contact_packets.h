/// Contact points packed for sweeps: W pairs of bodies side by side, one in each lane, none of which shares a mover with another.
///
///   W = 1   each pair is a packet, in the order of the pairs: for small islands, where the order of a sweep decides how far it gets
///   W = 4   pairs are coloured (greedily, in their order, pairs with an immovable side first), so that the pairs of one colour share no
///           mover; a packet holds pairs of one colour with about the same number of points. A sweep goes colour by colour.
///
/// "Pair" stands for the contact points of two bodies that follow one another and have one normal; two bodies that touch along several
/// normals are several pairs.
///
/// Two pairs of one colour act on different movers, so their order does not matter: results depend on the colouring alone, not on
/// how many lanes a processor computes at once. Pairs beyond kMostColours colours get packets of their own.
/// Source: graph colouring of contacts as in Catto, SIMD matters (2024).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "movers.h"
#include "plab/collision.h"
#include "plab/parts.h"

namespace plab::managers
{

/// One contact point of each pair of a packet; in the notation of problem.h. Where a lane has fewer points, they have no mobility, so that
/// their impulses stay 0.
template <int W>
struct PacketPoint
{
    LaneVec<W> r_a, r_b;                        ///< m
    Lanes<W> K_xz{}, K_yz{};                    ///< 1/kg
    Lanes<W> inverse_normal{}, inverse_slip{};  ///< kg: 1 / K_zz, 1 / slip_mobility; 0 where there is no mobility
    Lanes<W> friction{};
    Lanes<W> least{};    ///< m/s
    LaneVec<W> impulse;  ///< N s
};

template <int W>
struct Packet
{
    std::array<std::uint32_t, W> a{}, b{};  ///< movers; kNoIndex: impulses do not move this side
    LaneVec<W> n, t1;                       ///< of all its points; t2 = n x t1
    Lanes<W> inverse_mass_a{}, inverse_mass_b{};
    LaneSymmetric<W> inverse_inertia_a, inverse_inertia_b;
    bool turning = true;                 ///< the inertia of some mover changes as it turns; otherwise all have one moment of inertia
    Lanes<W> one_sided{};                ///< 1 where only one side moves, else 0
    Lanes<W> points{};                   ///< number of points in each lane
    std::uint32_t first = 0, count = 0;  ///< its points: as many as its longest lane has
};

/// Packets that a thread takes at once: some microseconds of work in a sweep, so that taking it costs little.
inline constexpr std::size_t kPart = 8;
/// Packed points that a thread takes at once in a loop over them alone.
inline constexpr std::size_t kPointPart = 128;
/// Islands of single lanes are too small to be divided.
inline constexpr std::size_t kSmallIsland = 1 << 20;

template <int W>
class PacketList
{
public:
    /// Packs geometry, friction, targets and impulses of the points. Mobilities are still to be computed: set_mobility().
    /// `workers`: threads for the loops over the packets until the next call; null: none.
    void load(std::span<const Point> from, std::size_t movers, Workers* workers = nullptr);
    /// The same from other places: begin(), add() for each contact in order, arrange(), and then fill(), which must write all that
    /// load() takes from a point. What was arranged for the same pairs the last time is kept.
    void begin(Workers* workers);
    void add(std::uint32_t a, std::uint32_t b, const Vec3& normal);
    void arrange(std::size_t movers);
    /// Calls one(packet, first, count, lane) for each pair: its contacts are first .. first + count - 1, its points those of the packet.
    /// When all lanes of some packets are filled, calls filled(begin, end) with their numbers. ahead(contact) is called for the contacts of
    /// the packet after next, so that they can be fetched: packets come to contacts in no order of memory.
    template <class One, class Ahead, class Filled>
    void fill(const One& one, const Ahead& ahead, const Filled& filled);
    /// Calls visit(contact) for each contact of a packet; of none if there is no such packet.
    template <class Visit>
    void visit_contacts(std::size_t packet, const Visit& visit) const;
    /// Sets memory apart for so many points in as many pairs.
    void reserve(std::size_t points, std::size_t movers);
    /// Writes the impulses back.
    void store(std::span<Point> to) const;

    Vec3 impulse(std::size_t contact) const { return lane(at(contact).impulse, places_[contact].lane); }
    void set_impulse(std::size_t contact, const Vec3& j) { set_lane(at(contact).impulse, places_[contact].lane, j); }
    /// m/s: the part of a contact's velocity that bodies contribute which are not movers. 0 unless it is set.
    Vec3 given(std::size_t contact) const { return given_.empty() ? Vec3{} : lane(given_[places_[contact].point], places_[contact].lane); }
    void set_given(std::size_t contact, const Vec3& u)
    {
        if (given_.empty()) given_.assign(points_.size(), LaneVec<W>{});
        set_lane(given_[places_[contact].point], places_[contact].lane, u);
    }
    /// Parallel to points(), or empty: all are 0.
    std::span<const LaneVec<W>> given() const { return given_; }
    void set_least(std::size_t contact, double speed) { set_lane(at(contact).least, places_[contact].lane, speed); }
    void clear_impulses();
    void scale_impulses(double share);

    /// Where a contact's point is: in packets()[place.packet], at points()[place.point], and its lane.
    struct Place
    {
        std::uint32_t packet = 0, point = 0;
        int lane = 0;
    };
    Place place(std::size_t contact) const { return places_[contact]; }
    std::size_t size() const { return places_.size(); }
    std::span<Packet<W>> packets() { return std::span(packets_).first(packet_count_); }
    std::span<const Packet<W>> packets() const { return std::span(packets_).first(packet_count_); }
    std::span<PacketPoint<W>> points() { return points_; }
    std::span<const PacketPoint<W>> points() const { return points_; }
    /// Calls visit(contact, lane) for each contact of a packet at one of its points.
    template <class Visit>
    void visit_point(std::size_t packet, std::uint32_t point, const Visit& visit) const;
    /// Calls loop(begin, end) with parts of packets() between which no mover is shared, then with the parts of the next colour, and so on.
    template <class Loop>
    void by_colour(const Loop& loop, bool backwards = false) const;
    /// The same in parts of any colours, for loops that do not change the movers.
    template <class Loop>
    void in_parts(const Loop& loop) const
    {
        for_parts(workers_, packet_count_, W == 1 ? kSmallIsland : kPart, loop);
    }

private:
    /// Contact points with the same movers and normal, which follow one another.
    struct Pair
    {
        std::uint32_t a = 0, b = 0, first = 0, count = 0;
        std::uint32_t colour = 0;
    };
    bool is_arranged(std::size_t movers) const;
    void add_packets_by_colour();
    void colour_pairs(std::size_t movers);
    void order_pairs();
    void add_packet(std::uint32_t pair, std::uint32_t pairs);
    template <class One>
    void fill_packet(std::size_t number, const One& one);
    std::span<const std::uint32_t> pairs_of(std::size_t packet) const
    {
        const std::size_t end = packet + 1 < first_pair_.size() ? first_pair_[packet + 1] : order_.size();
        return std::span(order_).subspan(first_pair_[packet], end - first_pair_[packet]);
    }

    PacketPoint<W>& at(std::size_t contact) { return points_[places_[contact].point]; }
    const PacketPoint<W>& at(std::size_t contact) const { return points_[places_[contact].point]; }

    /// Packets from `begin` to the next one, which may be swept in parts of kPart packets at once if they are of one colour.
    struct Section
    {
        std::size_t begin = 0;
        bool one_colour = false;
    };
    void add_section(bool one_colour);

    std::vector<Packet<W>> packets_;  ///< the first packet_count_ are in use
    std::vector<PacketPoint<W>> points_;
    std::vector<LaneVec<W>> given_;
    std::vector<Place> places_;  ///< by contact
    std::vector<Pair> added_;    ///< without colours
    Vec3 last_normal_;           ///< of added_.back()
    std::vector<Pair> pairs_;    ///< as they are arranged
    std::size_t arranged_movers_ = 0;
    std::vector<std::uint64_t> colours_of_mover_;  ///< a bit for each colour that the mover's pairs have
    std::vector<std::uint32_t> order_, starts_;    ///< pairs by colour and number of points
    std::vector<std::uint32_t> first_pair_;        ///< by packet, in order_
    std::size_t packet_count_ = 0, point_count_ = 0;
    std::vector<Section> sections_;
    Workers* workers_ = nullptr;
};

template <int W>
template <class Visit>
void PacketList<W>::visit_point(std::size_t packet, std::uint32_t point, const Visit& visit) const
{
    const std::span<const std::uint32_t> pairs = pairs_of(packet);
    const std::uint32_t k = point - packets_[packet].first;
    for (std::size_t l = 0; l < pairs.size(); ++l)
        if (const Pair& pair = pairs_[pairs[l]]; k < pair.count) visit(pair.first + k, static_cast<int>(l));
}

template <int W>
template <class Visit>
void PacketList<W>::visit_contacts(std::size_t packet, const Visit& visit) const
{
    if (packet >= packet_count_) return;
    for (const std::uint32_t p : pairs_of(packet))
        for (std::uint32_t k = 0; k < pairs_[p].count; ++k) visit(pairs_[p].first + k);
}

template <int W>
template <class One, class Ahead, class Filled>
void PacketList<W>::fill(const One& one, const Ahead& ahead, const Filled& filled)
{
    in_parts(
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t k = begin; k < end; ++k)
            {
                visit_contacts(k + 2, ahead);
                fill_packet(k, one);
            }
            filled(begin, end);
        });
}

/// Writes a packet's sides and its points.
template <int W>
template <class One>
void PacketList<W>::fill_packet(std::size_t number, const One& one)
{
    Packet<W>& packet = packets_[number];
    const std::span<const std::uint32_t> pairs = pairs_of(number);
    // Pairs are in the order of falling counts. Lanes that stay empty must be zero; all others are written.
    const std::uint32_t full = pairs.size() == W ? pairs_[pairs.back()].count : 0;
    for (std::uint32_t i = packet.first + full; i < packet.first + packet.count; ++i) points_[i] = {};
    for (int l = 0; l < static_cast<int>(pairs.size()); ++l)
    {
        const Pair& pair = pairs_[pairs[static_cast<std::size_t>(l)]];
        packet.a[static_cast<std::size_t>(l)] = pair.a, packet.b[static_cast<std::size_t>(l)] = pair.b;
        set_lane(packet.points, l, pair.count);
        set_lane(packet.one_sided, l, pair.a == kNoIndex || pair.b == kNoIndex ? 1.0 : 0.0);
        one(packet, pair.first, pair.count, l);
    }
}

template <int W>
template <class Loop>
void PacketList<W>::by_colour(const Loop& loop, bool backwards) const
{
    for (std::size_t k = 0; k < sections_.size(); ++k)
    {
        const std::size_t s = backwards ? sections_.size() - 1 - k : k, begin = sections_[s].begin;
        const std::size_t end = s + 1 < sections_.size() ? sections_[s + 1].begin : packet_count_;
        for_parts(workers_, end - begin, sections_[s].one_colour ? kPart : std::max<std::size_t>(1, end - begin),
                  [&](std::size_t from, std::size_t to) { loop(begin + from, begin + to); });
    }
}

/// Asks for the memory of a contact, to be read, or also written, soon.
inline void fetch(const Contact& contact, bool writes)
{
    const char* const begin = reinterpret_cast<const char*>(&contact);
    for (std::size_t i = 0; i < sizeof contact; i += 64)
        if (writes)
            __builtin_prefetch(begin + i, 1);
        else
            __builtin_prefetch(begin + i, 0);
}

/// Takes the movers' masses and inertias, and computes the mobilities of the points with them.
template <int W>
void set_mobility(PacketList<W>& list, std::span<const Mover> movers);
/// The same for some packets.
template <int W>
void set_mobility(PacketList<W>& list, std::span<const Mover> movers, std::size_t begin, std::size_t end);
/// Adds the impulses of all points to the sums of the movers.
template <int W>
void sum_impulses(const PacketList<W>& list, std::span<Momentum> sums);

struct HardSweep
{
    bool measures = true;  ///< returns the largest change; else 0
    double relaxation = 1;
    double friction_scale = 1;  ///< 0: without friction
    bool backwards = false;
};
/// One sweep of projected Gauss-Seidel with the points' targets (sequential.h). Returns the largest change, m/s.
template <int W>
double sweep_hard(PacketList<W>& list, std::span<Mover> movers, const HardSweep& how);

/// What soft contacts know of a point besides.
template <int W>
struct SoftPoint
{
    Lanes<W> depth{};     ///< m, now
    Lanes<W> greatest{};  ///< N s, largest normal impulse of any sub-step
    LaneVec<W> sum;       ///< N s, over the step
};
struct Softness
{
    double bias_rate = 0, mass_scale = 1, impulse_scale = 0;
};
struct SoftSweep
{
    Softness between, one_sided;  ///< of two bodies that move; of a body and one that does not
    double push_speed = 0;        ///< m/s
    double rate = 0;              ///< 1/s, 1 / h
    bool gathers = false;         ///< the present impulses are those of a sub-step before: they count for `sum` and `greatest`
};
/// One sweep of soft contacts (soft_step.h), with the points' depths instead of their targets.
template <int W>
void sweep_soft(PacketList<W>& list, std::span<Mover> movers, const SoftSweep& how, std::span<SoftPoint<W>> soft);

/// The velocities with which the movers have just moved for h (s), parallel to them.
struct Moved
{
    std::span<const MoverSpeeds> speeds;
    double h = 0, rate = 0;  ///< s; 1/s: 1 / |h|
};
/// After a move: the depths of all points follow it, and the packets take the inertias at the new attitudes. The mobilities of the points
/// between movers that have turned by much (Mover::turned) are computed anew; others only decide how far a sweep gets. The points' targets
/// become those of hard contacts at these depths: gaps may close within h.
template <int W>
void follow_move(PacketList<W>& list, std::span<const Mover> movers, const Moved& moved, std::span<SoftPoint<W>> soft);
/// The same, and one sweep_hard().
template <int W>
void follow_move_and_sweep(PacketList<W>& list, std::span<Mover> movers, const Moved& moved, std::span<SoftPoint<W>> soft);

/// Counts the present impulses for `sum` and `greatest`, and sets them to zero.
template <int W>
void gather_and_clear(PacketList<W>& list, std::span<SoftPoint<W>> soft);

/// Reports the impulse and the slip of each contact: `sum` and the present impulse. `returned`: the latter is that of restitution;
/// otherwise it is that of the last sub-step. Returns the largest speed at which overlap grows although its contact may act, m/s: that at
/// the end or that in the mean over the step of h (s), which is less, as bodies that have just met are answered by the sub-steps that
/// follow.
template <int W>
double report_contacts(const PacketList<W>& list, std::span<Mover> movers, std::span<const SoftPoint<W>> soft, bool returned, double h,
                       std::span<Contact> contacts);

}  // namespace plab::managers
