/// Waiting times: converts seconds, as users give them, to clock durations.
#pragma once

#include <dds/dds.h>

#include <algorithm>
#include <chrono>

namespace plab::link
{

using Seconds = std::chrono::duration<double>;

/// Three years, longer than any sensible wait; beyond 292 years a count of nanoseconds would overflow.
inline constexpr Seconds kLongestWait(1e8);

/// Clamps to 0 .. kLongestWait; NaN becomes no wait.
inline Seconds bounded(Seconds s) { return s > Seconds(0) ? std::min(s, kLongestWait) : Seconds(0); }

/// For functions of DDS.
inline dds_duration_t duration_of(Seconds s) { return std::chrono::duration_cast<std::chrono::nanoseconds>(bounded(s)).count(); }

/// The time point that is this long after `from`.
inline std::chrono::steady_clock::time_point moment_after(Seconds s,
                                                          std::chrono::steady_clock::time_point from = std::chrono::steady_clock::now())
{
    return from + std::chrono::duration_cast<std::chrono::steady_clock::duration>(bounded(s));
}

}  // namespace plab::link
