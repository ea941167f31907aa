/// The clock that measures costs.
#pragma once

#include <chrono>
#include <cstdint>

namespace plab::simulation
{

/// Monotonic time, ns. One call takes about 20 ns, so nothing smaller than a block of rows is measured.
inline std::uint64_t now_ns() { return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count()); }

}  // namespace plab::simulation
