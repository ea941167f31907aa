/// Costs as samples with a spread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace plab::simulation
{

/// Median, quartiles, minimum and maximum of some samples; all 0 if there are none.
struct Spread
{
    double median = 0, low = 0, high = 0;
    double least = 0, most = 0;
    std::uint32_t samples = 0;

    /// Whether there are enough samples for a meaningful median.
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

/// Whether two medians differ significantly: with at least eight samples each, if the interquartile ranges do not overlap; with at least
/// four each, if the full ranges do not overlap. Two sets of samples of the same cost pass this test in less than 6 of 100 cases.
inline bool differ(const Spread& a, const Spread& b)
{
    constexpr std::uint32_t kForQuartiles = 8, kForAll = 4;
    const std::uint32_t samples = std::min(a.samples, b.samples);
    return (samples >= kForQuartiles && (a.high < b.low || b.high < a.low)) ||
           (samples >= kForAll && (a.most < b.least || b.most < a.least));
}

}  // namespace plab::simulation
