#include "simulation/events/zeno.h"

#include <cmath>

namespace plab::simulation
{
namespace
{

/// Two ratios count as equal if they differ by less than this fraction. Times of impact have a relative rounding error of 1e-16, and
/// their differences a larger one: after a million seconds, intervals down to about 1e-6 s can be compared this way.
constexpr double kSameRatio = 1e-3;

}  // namespace

std::optional<double> rest_of_bounces(const BounceHistory& history, double next, double ratio)
{
    if (!(history.previous > 0 && history.interval > 0 && next > 0 && ratio > 0 && ratio < 1)) return std::nullopt;
    const double seen = history.interval / history.previous, coming = next / history.interval;
    if (std::fabs(seen - ratio) > kSameRatio * (1 - ratio) + kSameRatio * ratio) return std::nullopt;
    if (std::fabs(coming - ratio) > kSameRatio * (1 - ratio) + kSameRatio * ratio) return std::nullopt;
    return next / (1 - ratio);
}

void note_impact(BounceHistory& history, double time)
{
    history.previous = history.interval;
    history.interval = history.time > 0 ? time - history.time : 0;
    history.time = time;
}

}  // namespace plab::simulation
