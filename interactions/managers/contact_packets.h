/// Contact points packed for sweeps: W pairs of bodies side by side, one in each lane, none of which shares a mover with another.
///
///   W = 1   each pair is a packet, in the order of the pairs: for small islands, where the order of a sweep decides how far it gets
///   W = 4   pairs are coloured (greedily, in their order, pairs with an immovable side first), so that the pairs of one colour share no
///           mover; a packet holds pairs of one colour with about the same number of points. A sweep goes colour by colour.
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
#include "plab/parts.h"

namespace plab::managers
{

/// One contact point of each pair of a packet; in the notation of problem.h. An empty lane has no mobility, so its impulse stays 0.
template <int W>
struct PacketPoint
{
    LaneVec<W> n, t1;                           ///< t2 = n x t1
    LaneVec<W> r_a, r_b;                        ///< m
    LaneVec<W> given;                           ///< m/s
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
    Lanes<W> inverse_mass_a{}, inverse_mass_b{};
    LaneSymmetric<W> inverse_inertia_a, inverse_inertia_b;
    bool turning = true;                 ///< the inertia of some mover changes as it turns
    Lanes<W> one_sided{};                ///< 1 where only one side moves, else 0
    std::uint32_t first = 0, count = 0;  ///< its points
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
    /// Sets memory apart for so many points in as many pairs.
    void reserve(std::size_t points, std::size_t movers);
    /// Takes targets, friction and impulses anew; the pairs are those that were loaded.
    void reload(std::span<const Point> from);
    /// Writes the impulses back.
    void store(std::span<Point> to) const;

    Vec3 impulse(std::size_t contact) const { return vec(at(contact).impulse, places_[contact].lane); }
    void set_impulse(std::size_t contact, const Vec3& j) { set(at(contact).impulse, places_[contact].lane, j); }
    void set_given(std::size_t contact, const Vec3& u) { set(at(contact).given, places_[contact].lane, u); }
    void set_least(std::size_t contact, double speed) { set_lane(at(contact).least, places_[contact].lane, speed); }
    void clear_impulses();
    void scale_impulses(double share);

    /// Where a contact's point is: points()[place.point], and its lane.
    struct Place
    {
        std::uint32_t point = 0;
        int lane = 0;
    };
    Place place(std::size_t contact) const { return places_[contact]; }
    std::size_t size() const { return places_.size(); }
    std::span<Packet<W>> packets() { return packets_; }
    std::span<const Packet<W>> packets() const { return packets_; }
    std::span<PacketPoint<W>> points() { return points_; }
    std::span<const PacketPoint<W>> points() const { return points_; }
    /// Calls visit(contact, point, lane) for each contact of a packet.
    template <class Visit>
    void visit(std::size_t packet, const Visit& visit) const;
    /// Calls loop(begin, end) with parts of packets() between which no mover is shared, then with the parts of the next colour, and so on.
    template <class Loop>
    void by_colour(const Loop& loop, bool backwards = false) const;
    /// The same in parts of any colours, for loops that do not change the movers.
    template <class Loop>
    void in_parts(const Loop& loop) const
    {
        for_parts(workers_, packets_.size(), W == 1 ? kSmallIsland : kPart, loop);
    }

private:
    /// The contact points between two bodies, which follow one another.
    struct Pair
    {
        std::uint32_t a = 0, b = 0, first = 0, count = 0;
        std::uint32_t colour = 0;
    };
    void find_pairs(std::span<const Point> from);
    void colour_pairs(std::size_t movers);
    void order_pairs();
    void add_packet(std::uint32_t pair, std::uint32_t pairs);
    void fill(std::size_t number, std::span<const Point> from);
    std::span<const std::uint32_t> pairs_of(std::size_t packet) const
    {
        const std::size_t end = packet + 1 < first_pair_.size() ? first_pair_[packet + 1] : order_.size();
        return std::span(order_).subspan(first_pair_[packet], end - first_pair_[packet]);
    }
    static void take(const Point& from, PacketPoint<W>& to, int lane);

    PacketPoint<W>& at(std::size_t contact) { return points_[places_[contact].point]; }
    const PacketPoint<W>& at(std::size_t contact) const { return points_[places_[contact].point]; }
    static Vec3 vec(const LaneVec<W>& v, int i) { return {lane(v.x, i), lane(v.y, i), lane(v.z, i)}; }
    static void set(LaneVec<W>& v, int i, const Vec3& to) { set_lane(v.x, i, to.x), set_lane(v.y, i, to.y), set_lane(v.z, i, to.z); }

    /// Packets from `begin` to the next one, which may be swept in parts of kPart packets at once if they are of one colour.
    struct Section
    {
        std::size_t begin = 0;
        bool one_colour = false;
    };
    void add_section(bool one_colour);

    std::vector<Packet<W>> packets_;
    std::vector<PacketPoint<W>> points_;
    std::vector<Place> places_;  ///< by contact
    std::vector<Pair> pairs_;
    std::vector<std::uint64_t> colours_of_mover_;  ///< a bit for each colour that the mover's pairs have
    std::vector<std::uint32_t> order_, starts_;    ///< pairs by colour and number of points
    std::vector<std::uint32_t> first_pair_;        ///< by packet, in order_
    std::size_t point_count_ = 0;
    std::vector<Section> sections_;
    Workers* workers_ = nullptr;
};

template <int W>
template <class Visit>
void PacketList<W>::visit(std::size_t packet, const Visit& visit) const
{
    const std::span<const std::uint32_t> pairs = pairs_of(packet);
    for (std::size_t l = 0; l < pairs.size(); ++l)
        for (std::uint32_t k = 0; k < pairs_[pairs[l]].count; ++k)
            visit(pairs_[pairs[l]].first + k, packets_[packet].first + k, static_cast<int>(l));
}

template <int W>
template <class Loop>
void PacketList<W>::by_colour(const Loop& loop, bool backwards) const
{
    for (std::size_t k = 0; k < sections_.size(); ++k)
    {
        const std::size_t s = backwards ? sections_.size() - 1 - k : k, begin = sections_[s].begin;
        const std::size_t end = s + 1 < sections_.size() ? sections_[s + 1].begin : packets_.size();
        for_parts(workers_, end - begin, sections_[s].one_colour ? kPart : std::max<std::size_t>(1, end - begin),
                  [&](std::size_t from, std::size_t to) { loop(begin + from, begin + to); });
    }
}

/// Takes the movers' masses and inertias, and computes the mobilities of the points with them.
template <int W>
void set_mobility(PacketList<W>& list, std::span<const Mover> movers);
/// The same after the movers have turned: nothing changes between bodies with one moment of inertia.
template <int W>
void refresh_mobility(PacketList<W>& list, std::span<const Mover> movers);
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
    Lanes<W> depth{}, depth_before{};  ///< m: now, and at the start of the sub-step
    Lanes<W> greatest{};               ///< N s, largest normal impulse of any sub-step
    LaneVec<W> moved_with;             ///< N s: impulses with which the sub-step moved
    LaneVec<W> sum;                    ///< N s, over the step
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
/// Moves the depths by h (s) with the present velocities, and keeps depths and impulses of before. The points' targets become those of hard
/// contacts at these depths: gaps may close within h.
template <int W>
void advance_depths(PacketList<W>& list, std::span<Mover> movers, double h, std::span<SoftPoint<W>> soft);

/// Counts the present impulses for `sum` and `greatest`, and sets them to zero.
template <int W>
void gather_and_clear(PacketList<W>& list, std::span<SoftPoint<W>> soft);

}  // namespace plab::managers
