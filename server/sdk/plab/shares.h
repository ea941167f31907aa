/// Jobs of very different sizes, divided among the threads that the host lends (workers.h).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "plab/workers.h"

namespace plab
{

/// A job runs on one thread. One that can divide its own loops (parts.h), and is so large that the other threads would have to wait for it,
/// has all of them instead. Its result must not depend on that; so the division may depend on the number of threads.
class Shares
{
public:
    /// Calls job(i) once for each i < count. size(i): of a job, in any unit; divides(i): whether it can divide its loops. Jobs whose sizes
    /// add up to `worth`, which should be some tens of microseconds of work, are taken by a thread at once.
    template <class Size, class Divides, class Job>
    void run(Workers* workers, std::size_t count, std::size_t worth, const Size& size, const Divides& divides, const Job& job)
    {
        const std::size_t threads = workers ? static_cast<std::size_t>(workers->threads()) : 1;
        if (threads < 2 || count < 2)
        {
            for (std::size_t i = 0; i < count; ++i) job(i);
            return;
        }
        sort(count, size);
        std::size_t left = 0, kept = 0, taken = worth;
        for (std::size_t i = 0; i < count; ++i) left += size(i);
        begins_.clear();
        for (const std::uint32_t i : order_)
        {
            if (size(i) > worth && size(i) * threads > left && divides(i))
            {
                left -= size(i), job(std::size_t{i});
                continue;
            }
            if (taken >= worth) begins_.push_back(kept), taken = 0;
            taken += size(i) + 1, order_[kept++] = i;
        }
        const std::size_t batches = begins_.size();
        begins_.push_back(kept);
        workers->run(batches,
                     [&](std::size_t b)
                     {
                         for (std::size_t k = begins_[b]; k < begins_[b + 1]; ++k) job(std::size_t{order_[k]});
                     });
    }

private:
    template <class Size>
    void sort(std::size_t count, const Size& size)
    {
        order_.resize(count);
        std::iota(order_.begin(), order_.end(), std::uint32_t{0});
        std::sort(order_.begin(), order_.end(),
                  [&](std::uint32_t x, std::uint32_t y) { return size(x) != size(y) ? size(x) > size(y) : x < y; });
    }

    std::vector<std::uint32_t> order_;  ///< jobs, the largest first
    std::vector<std::size_t> begins_;   ///< in order_: the first jobs of those that a thread takes at once, and the end
};

}  // namespace plab
