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

/// A job runs on one thread, unless it is so large that the others would have to wait for it: then it has all threads, to divide its own
/// loops (parts.h). Its result must not depend on that; so the division may depend on the number of threads.
class Shares
{
public:
    /// Calls job(i) once for each i < count. size(i): of a job, in any unit. Jobs whose sizes add up to `worth`, which should be some tens
    /// of microseconds of work, are taken by a thread at once.
    template <class Size, class Job>
    void run(Workers* workers, std::size_t count, std::size_t worth, const Size& size, const Job& job)
    {
        const std::size_t threads = workers ? static_cast<std::size_t>(workers->threads()) : 1;
        if (threads < 2 || count < 2)
        {
            for (std::size_t i = 0; i < count; ++i) job(i);
            return;
        }
        sort(count, size);
        std::size_t left = 0, divided = 0;
        for (std::size_t i = 0; i < count; ++i) left += size(i);
        for (; divided < count && size(order_[divided]) > worth && size(order_[divided]) * threads > left; ++divided)
            left -= size(order_[divided]), job(std::size_t{order_[divided]});
        begins_.clear();
        for (std::size_t k = divided, taken = worth; k < count; ++k)
        {
            if (taken >= worth) begins_.push_back(k), taken = 0;
            taken += size(order_[k]) + 1;
        }
        const std::size_t batches = begins_.size();
        begins_.push_back(count);
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
