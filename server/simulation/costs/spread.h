/// Costs as what they are: samples with a spread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace plab::simulation
{

/// Median and quartiles of samples, the least and the largest; of none all are 0.
struct Spread
{
    double median = 0, low = 0, high = 0;
    double least = 0, most = 0;
    std::uint32_t samples = 0;

    /// Whether there are enough of them for a median to mean something.
    bool is_known() const { return samples >= 3; }
};

inline Spread spread_of(std::span<const double> values)
{
    if (values.empty()) return {};
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](std::size_t quarter) { return sorted[quarter * (sorted.size() - 1) / 4]; };
    return {at(2), at(1), at(3), sorted.front(), sorted.back(), static_cast<std::uint32_t>(sorted.size())};
}

/// Whether two medians differ by more than chance: from eight samples each whose quartiles do not overlap, or from four that do not overlap
/// at all. Samples of one and the same cost do so in less than 6 of 100 cases.
inline bool differ(const Spread& a, const Spread& b)
{
    constexpr std::uint32_t kForQuartiles = 8, kForAll = 4;
    const std::uint32_t samples = std::min(a.samples, b.samples);
    return (samples >= kForQuartiles && (a.high < b.low || b.high < a.low)) ||
           (samples >= kForAll && (a.most < b.least || b.most < a.least));
}

}  // namespace plab::simulation
