/// Loops that are divided among the threads which the host lends (workers.h).
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>

#include "plab/workers.h"

namespace plab
{

/// Calls loop(begin, end) for the parts of `size` elements that make up 0 .. count. The parts are the same for any number of threads, so
/// results do not depend on it as long as no part reads what another one writes. `workers` may be null: the caller is alone.
template <class Loop>
void for_parts(Workers* workers, std::size_t count, std::size_t size, const Loop& loop)
{
    const std::size_t parts = (count + size - 1) / size;
    const auto part = [&](std::size_t k) { loop(k * size, std::min(count, (k + 1) * size)); };
    if (parts > 1 && workers && workers->threads() > 1) return workers->run(parts, part);
    for (std::size_t k = 0; k < parts; ++k) part(k);
}

/// The largest of numbers that the parts of a loop find; like the parts, it does not depend on the order of threads.
inline void raise_to(std::atomic<double>& most, double x)
{
    double known = most.load(std::memory_order_relaxed);
    while (x > known && !most.compare_exchange_weak(known, x, std::memory_order_relaxed)) continue;
}

}  // namespace plab
