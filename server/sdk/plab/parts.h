/// Loops that are divided among the threads which the host lends (workers.h).
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <vector>

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

/// The sum of what loop(begin, end) returns for each of these parts, in their order. `sums` is working memory.
template <class Loop>
double sum_parts(Workers* workers, std::size_t count, std::size_t size, std::vector<double>& sums, const Loop& loop)
{
    if (count <= size) return count == 0 ? 0.0 : loop(std::size_t{0}, count);
    sums.resize((count + size - 1) / size);
    for_parts(workers, count, size, [&](std::size_t begin, std::size_t end) { sums[begin / size] = loop(begin, end); });
    double sum = 0;
    for (const double part : sums) sum += part;
    return sum;
}

/// The largest of numbers that the parts of a loop find; like the parts, it does not depend on the order of threads.
inline void raise_to(std::atomic<double>& most, double x)
{
    double known = most.load(std::memory_order_relaxed);
    while (x > known && !most.compare_exchange_weak(known, x, std::memory_order_relaxed)) continue;
}

}  // namespace plab
