/// The clock that measures costs.
#pragma once

#include <ctime>

#include <chrono>
#include <cstdint>

namespace plab::simulation
{

/// Monotonic time, ns. One call takes about 20 ns, so nothing smaller than a block of rows is measured.
inline std::uint64_t now_ns() { return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count()); }

/// ns of processor time that the calling thread has used.
inline std::uint64_t thread_ns()
{
    timespec t{};
    (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<std::uint64_t>(t.tv_sec) * 1'000'000'000u + static_cast<std::uint64_t>(t.tv_nsec);
}

}  // namespace plab::simulation
