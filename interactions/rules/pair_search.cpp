#include "pair_search.h"

#include <algorithm>
#include <cmath>

namespace plab::rules
{
namespace
{

constexpr int kBits = 21;

/// Cells far from one another may get the same number: their points are compared and found to be apart.
std::uint64_t number_of(std::int64_t x, std::int64_t y, std::int64_t z)
{
    constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
    return (static_cast<std::uint64_t>(x) & kMask) << (2 * kBits) | (static_cast<std::uint64_t>(y) & kMask) << kBits |
           (static_cast<std::uint64_t>(z) & kMask);
}

std::int64_t cell_of(double x, double size)
{
    constexpr double kMost = 1e15;  // whole numbers of a double, and of 64 bits
    return static_cast<std::int64_t>(std::clamp(std::floor(x / size), -kMost, kMost));
}

}  // namespace

void PairSearch::follow(std::span<const Vec3> points, double reach)
{
    const double limit = 0.5 * kSkin * reach;
    bool complete = made_from_.size() == points.size() && reach == reach_;
    for (std::size_t i = 0; i < points.size() && complete; ++i) complete = length_squared(points[i] - made_from_[i]) <= limit * limit;
    if (complete) return;
    reach_ = reach;
    make(points);
}

void PairSearch::make(std::span<const Vec3> points)
{
    made_from_.assign(points.begin(), points.end());
    entries_.clear(), pairs_.clear();
    const double size = (1 + kSkin) * reach_;
    for (std::uint32_t i = 0; i < points.size(); ++i)
        entries_.push_back({number_of(cell_of(points[i].x, size), cell_of(points[i].y, size), cell_of(points[i].z, size)), i});
    std::sort(entries_.begin(), entries_.end());
    for (const Entry& entry : entries_)
    {
        const Vec3& p = points[entry.point];
        const std::int64_t x = cell_of(p.x, size), y = cell_of(p.y, size), z = cell_of(p.z, size);
        for (std::int64_t dx = -1; dx <= 1; ++dx)
            for (std::int64_t dy = -1; dy <= 1; ++dy)
                for (std::int64_t dz = -1; dz <= 1; ++dz) compare(entry, number_of(x + dx, y + dy, z + dz), points);
    }
    std::sort(pairs_.begin(), pairs_.end());
}

void PairSearch::compare(const Entry& entry, std::uint64_t cell, std::span<const Vec3> points)
{
    const double size = (1 + kSkin) * reach_;
    const auto before = [](const Entry& e, std::uint64_t c) { return e.cell < c; };
    for (auto other = std::lower_bound(entries_.begin(), entries_.end(), cell, before); other != entries_.end() && other->cell == cell;
         ++other)
        if (entry.point < other->point && length_squared(points[entry.point] - points[other->point]) <= size * size)
            pairs_.emplace_back(entry.point, other->point);
}

}  // namespace plab::rules
