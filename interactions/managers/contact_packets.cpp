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
void PacketList<W>::find_pairs(std::span<const Point> from)
{
    pairs_.clear();
    for (std::uint32_t i = 0; i < from.size(); ++i)
    {
        if (pairs_.empty() || pairs_.back().a != from[i].a || pairs_.back().b != from[i].b)
            pairs_.push_back({from[i].a, from[i].b, i, 0, 0});
        ++pairs_.back().count;
    }
}

/// Gives each pair the first colour that neither of its movers has yet.
template <int W>
void PacketList<W>::colour_pairs(std::size_t movers)
{
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
    Packet<W>& packet = packets_.emplace_back();
    packet.a.fill(kNoIndex), packet.b.fill(kNoIndex);
    packet.first = static_cast<std::uint32_t>(point_count_);
    first_pair_.push_back(pair);
    for (const std::uint32_t p : std::span(order_).subspan(pair, pairs)) packet.count = std::max(packet.count, pairs_[p].count);
    point_count_ += packet.count;
    for (int l = 0; l < static_cast<int>(pairs); ++l)
    {
        const Pair& of = pairs_[order_[pair + static_cast<std::uint32_t>(l)]];
        for (std::uint32_t k = 0; k < of.count; ++k) places_[of.first + k] = {packet.first + k, l};
    }
}

/// Writes a packet's sides and its points.
template <int W>
void PacketList<W>::fill(std::size_t number, std::span<const Point> from)
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
        set_lane(packet.one_sided, l, pair.a == kNoIndex || pair.b == kNoIndex ? 1.0 : 0.0);
        for (std::uint32_t k = 0; k < pair.count; ++k)
        {
            const Point& p = from[pair.first + k];
            PacketPoint<W>& to = points_[packet.first + k];
            set(to.n, l, p.n), set(to.t1, l, p.t1), set(to.r_a, l, p.r_a), set(to.r_b, l, p.r_b);
            take(p, to, l);
        }
    }
}

/// The packets that follow form a section. Colours too small to be divided share one, so that one thread sweeps them in a row.
template <int W>
void PacketList<W>::add_section(bool one_colour)
{
    if (!one_colour && !sections_.empty() && !sections_.back().one_colour) return;
    sections_.push_back({packets_.size(), one_colour});
}

template <int W>
void PacketList<W>::load(std::span<const Point> from, std::size_t movers, Workers* workers)
{
    packets_.clear(), sections_.clear(), first_pair_.clear();
    point_count_ = 0;
    workers_ = workers;
    places_.resize(from.size());
    find_pairs(from);
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
    points_.resize(point_count_);
    in_parts(
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t k = begin; k < end; ++k) fill(k, from);
        });
}

template <int W>
void PacketList<W>::reserve(std::size_t points, std::size_t movers)
{
    packets_.reserve(points), points_.reserve(points), places_.reserve(points), pairs_.reserve(points);
    order_.reserve(points), first_pair_.reserve(points), sections_.reserve(W == 1 ? 1 : 2 * kMostColours);
    if (W > 1) colours_of_mover_.reserve(movers), starts_.reserve((kMostColours + 1) * kMostOfPair + 1);
}

/// Takes what changes between sweeps of one step.
template <int W>
void PacketList<W>::take(const Point& p, PacketPoint<W>& to, int l)
{
    set(to.given, l, p.given), set(to.impulse, l, p.impulse);
    set_lane(to.friction, l, p.friction), set_lane(to.least, l, p.least);
}

template <int W>
void PacketList<W>::reload(std::span<const Point> from)
{
    for (std::size_t i = 0; i < from.size(); ++i) take(from[i], at(i), places_[i].lane);
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
