/// Costs as what they are: samples with a spread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace plab::simulation
{

/// Median and quartiles of samples; of none all are 0.
struct Spread
{
    double median = 0, low = 0, high = 0;
    std::uint32_t samples = 0;
};

inline Spread spread_of(std::span<const double> values)
{
    if (values.empty()) return {};
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](std::size_t quarter) { return sorted[quarter * (sorted.size() - 1) / 4]; };
    return {at(2), at(1), at(3), static_cast<std::uint32_t>(sorted.size())};
}

/// Whether two medians differ by more than chance: from five samples each whose quartiles do not overlap. What does not is
/// below the noise.
inline bool differ(const Spread& a, const Spread& b)
{
    constexpr std::uint32_t kLeast = 5;
    return a.samples >= kLeast && b.samples >= kLeast && (a.high < b.low || b.high < a.low);
}

}  // namespace plab::simulation
