#include "contact_packets.h"

#include <algorithm>
#include <bit>

#include "movers.h"

namespace plab::managers
{
namespace
{

constexpr std::uint32_t kMostColours = 64;  // the bits of a mask
constexpr std::size_t kMostOfPair = 16;     // points: more of them are rare, and only cost an allocation

}  // namespace

template <int W>
void PacketList<W>::begin(Workers* workers)
{
    workers_ = workers;
    added_.clear();
    given_.clear();
}

template <int W>
void PacketList<W>::add(std::uint32_t a, std::uint32_t b, const Vec3& normal)
{
    const std::uint32_t next = added_.empty() ? 0 : added_.back().first + added_.back().count;
    if (added_.empty() || added_.back().a != a || added_.back().b != b || last_normal_ != normal)
        added_.push_back({a, b, next, 0, 0}), last_normal_ = normal;
    ++added_.back().count;
}

/// Whether pairs_ and the packets are those of added_. The pairs alone decide on packets and colours.
template <int W>
bool PacketList<W>::is_arranged(std::size_t movers) const
{
    return movers == arranged_movers_ &&
           std::equal(added_.begin(), added_.end(), pairs_.begin(), pairs_.end(),
                      [](const Pair& x, const Pair& y) { return x.a == y.a && x.b == y.b && x.first == y.first && x.count == y.count; });
}

/// Gives each pair the first colour that neither of its movers has yet.
template <int W>
void PacketList<W>::colour_pairs(std::size_t movers)
{
    make_room(colours_of_mover_, movers);
    colours_of_mover_.assign(movers, 0);
    const auto colours = [&](std::uint32_t mover) { return mover == kNoIndex ? 0 : colours_of_mover_[mover]; };
    const auto colour_those = [&](bool one_sided)
    {
        for (Pair& p : pairs_)
        {
            if ((p.a == kNoIndex || p.b == kNoIndex) != one_sided) continue;
            p.colour = static_cast<std::uint32_t>(std::countr_one(colours(p.a) | colours(p.b)));
            if (p.colour == kMostColours) continue;
            for (const std::uint32_t mover : {p.a, p.b})
                if (mover != kNoIndex) colours_of_mover_[mover] |= std::uint64_t{1} << p.colour;
        }
    };
    colour_those(true);
    colour_those(false);
}

/// Sorts the pairs by colour, and those of one colour by falling number of points, by counting.
template <int W>
void PacketList<W>::order_pairs()
{
    std::uint32_t most = 0;
    for (const Pair& p : pairs_) most = std::max(most, p.count);
    const auto key = [&](const Pair& p) { return p.colour * most + (most - p.count); };
    starts_.assign(std::size_t{most} * (kMostColours + 1) + 1, 0);
    for (const Pair& p : pairs_) ++starts_[key(p) + 1];
    for (std::size_t k = 1; k < starts_.size(); ++k) starts_[k] += starts_[k - 1];
    order_.resize(pairs_.size());
    for (std::uint32_t i = 0; i < pairs_.size(); ++i) order_[starts_[key(pairs_[i])]++] = i;
}

template <int W>
void PacketList<W>::add_packet(std::uint32_t pair, std::uint32_t pairs)
{
    const auto number = static_cast<std::uint32_t>(packet_count_++);
    if (packets_.size() < packet_count_) packets_.emplace_back();
    // Masses and inertias are written for all lanes, others only for those in use.
    Packet<W>& packet = packets_[number];
    packet.a.fill(kNoIndex), packet.b.fill(kNoIndex);
    packet.n = packet.t1 = {}, packet.one_sided = packet.points = Lanes<W>{};
    packet.first = static_cast<std::uint32_t>(point_count_), packet.count = 0;
    first_pair_.push_back(pair);
    for (const std::uint32_t p : std::span(order_).subspan(pair, pairs)) packet.count = std::max(packet.count, pairs_[p].count);
    point_count_ += packet.count;
    for (int l = 0; l < static_cast<int>(pairs); ++l)
    {
        const Pair& of = pairs_[order_[pair + static_cast<std::uint32_t>(l)]];
        for (std::uint32_t k = 0; k < of.count; ++k) places_[of.first + k] = {number, packet.first + k, l};
    }
}

/// The packets that follow form a section. Colours too small to be divided share one, so that one thread sweeps them in a row.
template <int W>
void PacketList<W>::add_section(bool one_colour)
{
    if (!one_colour && !sections_.empty() && !sections_.back().one_colour) return;
    sections_.push_back({packet_count_, one_colour});
}

template <int W>
void PacketList<W>::add_packets_by_colour()
{
    for (std::size_t i = 0; i < order_.size();)
    {
        const std::uint32_t colour = pairs_[order_[i]].colour;
        if (i == 0 || pairs_[order_[i - 1]].colour != colour)
        {
            std::size_t last = i;
            while (last < order_.size() && pairs_[order_[last]].colour == colour) ++last;
            add_section(colour < kMostColours && last - i > W * kPart);
        }
        std::size_t end = i + 1;
        while (end < order_.size() && end < i + W && colour < kMostColours && pairs_[order_[end]].colour == colour) ++end;
        add_packet(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(end - i));
        i = end;
    }
}

template <int W>
void PacketList<W>::arrange(std::size_t movers)
{
    if (is_arranged(movers)) return;
    make_room(pairs_, added_.size()), make_room(order_, added_.size());
    pairs_ = added_, arranged_movers_ = movers;
    sections_.clear(), first_pair_.clear();
    packet_count_ = point_count_ = 0;
    const std::size_t contacts = pairs_.empty() ? 0 : pairs_.back().first + pairs_.back().count;
    make_room(places_, contacts);
    places_.resize(contacts);
    if constexpr (W == 1)
    {
        add_section(false);
        order_.resize(pairs_.size());
        for (std::uint32_t i = 0; i < pairs_.size(); ++i) order_[i] = i, add_packet(i, 1);
    }
    else
    {
        colour_pairs(movers);
        order_pairs();
        add_packets_by_colour();
    }
    make_room(points_, point_count_);
    points_.resize(point_count_);
}

template <int W>
void PacketList<W>::load(std::span<const Point> from, std::size_t movers, Workers* workers)
{
    begin(workers);
    for (const Point& p : from) add(p.a, p.b, p.n);
    arrange(movers);
    const auto take = [&](Packet<W>& packet, std::uint32_t first, std::uint32_t count, int l)
    {
        set_lane(packet.n, l, from[first].n), set_lane(packet.t1, l, from[first].t1);
        for (std::uint32_t k = 0; k < count; ++k)
        {
            const Point& p = from[first + k];
            PacketPoint<W>& to = points_[packet.first + k];
            set_lane(to.r_a, l, p.r_a), set_lane(to.r_b, l, p.r_b), set_lane(to.impulse, l, p.impulse);
            set_lane(to.friction, l, p.friction), set_lane(to.least, l, p.least);
        }
    };
    fill(
        take, [](std::uint32_t) {}, [](std::size_t, std::size_t) {});
    for (std::size_t i = 0; i < from.size(); ++i)
        if (const Vec3 given = from[i].given + from[i].turning; given != Vec3{}) set_given(i, given);
}

template <int W>
void PacketList<W>::reserve(std::size_t points, std::size_t movers)
{
    packets_.reserve(points), points_.reserve(points), given_.reserve(points), places_.reserve(points);
    added_.reserve(points), pairs_.reserve(points);
    order_.reserve(points), first_pair_.reserve(points), sections_.reserve(W == 1 ? 1 : 2 * kMostColours);
    if (W > 1) colours_of_mover_.reserve(movers), starts_.reserve((kMostColours + 1) * kMostOfPair + 1);
}

template <int W>
void PacketList<W>::store(std::span<Point> to) const
{
    for (std::size_t i = 0; i < to.size(); ++i) to[i].impulse = impulse(i);
}

template <int W>
void PacketList<W>::clear_impulses()
{
    for (PacketPoint<W>& p : points_) p.impulse = {};
}

template <int W>
void PacketList<W>::scale_impulses(double share)
{
    const Lanes<W> s = Lanes<W>{} + share;
    for_parts(workers_, points_.size(), W == 1 ? kSmallIsland : kPointPart,
              [&](std::size_t begin, std::size_t end)
              {
                  for (std::size_t i = begin; i < end; ++i) points_[i].impulse = scaled(points_[i].impulse, s);
              });
}

template class PacketList<1>;
template class PacketList<4>;

}  // namespace plab::managers
