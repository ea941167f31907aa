/// Finds the pairs of points that are near one another, without looking at all pairs.
///
/// Points are sorted into the cells of a grid; only points of a cell and of its neighbours are compared. The list reaches further than is
/// asked for, by a skin, so it stays complete until a point has moved by half of the skin (L. Verlet, Computer experiments on classical
/// fluids, 1967). What is found does not depend on when it was made: the caller checks each pair's distance.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "plab/vector.h"

namespace plab::rules
{

class PairSearch
{
public:
    using Pair = std::pair<std::uint32_t, std::uint32_t>;  ///< i < j

    /// Brings the list up to date. Costs a comparison for each point as long as the list is complete.
    void follow(std::span<const Vec3> points, double reach);
    /// All pairs within reach, and some beyond, in order.
    std::span<const Pair> pairs() const { return pairs_; }

private:
    struct Entry
    {
        std::uint64_t cell;
        std::uint32_t point;
        friend auto operator<=>(const Entry&, const Entry&) = default;
    };
    void make(std::span<const Vec3> points);
    void compare(const Entry& entry, std::uint64_t cell, std::span<const Vec3> points);

    static constexpr double kSkin = 0.25;  // of the reach
    double reach_ = 0;
    std::vector<Vec3> made_from_;
    std::vector<Entry> entries_;
    std::vector<Pair> pairs_;
};

}  // namespace plab::rules
