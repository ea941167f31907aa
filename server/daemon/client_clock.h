/// When a client sent a sample, by the clock of this machine.
#pragma once

#include <algorithm>
#include <cstdint>

namespace plab::daemon
{

/// Samples take different times to arrive, and the clock of the client shows another time than this one. The sample that took least tells
/// how far the two clocks are apart, up to that least time: so what a sample took longer than the fastest one of late counts as its age.
///
///   offset_n = min(arrived_n - stamp_n, offset_{n-1} + r (arrived_n - arrived_{n-1})),   sent_n = stamp_n + offset_n <= arrived_n
///
/// r lets the estimate follow clocks that drift apart. Source: the minimum filter of the clock filter algorithm of NTP (D. Mills, RFC 5905,
/// section 10).
class ClientClock
{
public:
    /// ns, of this machine's clock: when the sample was sent, at most when it arrived. `stamp`: ns, of the client's clock; 0: it has none.
    std::int64_t sent(std::int64_t stamp, std::int64_t arrived)
    {
        if (stamp == 0) return arrived;
        const std::int64_t offset = arrived - stamp;
        const std::int64_t drifted = offset_ + (arrived - arrived_) / kDrift;
        // A clock that was set, or a network that was down, is no reason to extrapolate.
        const bool begins_anew = !known_ || stamp <= stamp_ || offset - drifted > kMost;
        offset_ = begins_anew ? offset : std::min(offset, drifted);
        known_ = true, stamp_ = stamp, arrived_ = arrived;
        return stamp + offset_;
    }

private:
    static constexpr std::int64_t kDrift = 10'000;      ///< 1 / r: quartz clocks differ by less than 100 in a million
    static constexpr std::int64_t kMost = 100'000'000;  ///< ns

    bool known_ = false;
    std::int64_t offset_ = 0, stamp_ = 0, arrived_ = 0;
};

}  // namespace plab::daemon
