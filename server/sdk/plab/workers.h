/// Threads among which a phase may divide its work.
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

namespace plab
{

/// The host owns the threads and lends them for the duration of a call. To keep the promise that a run has the same bits with any number of
/// threads, the jobs and their results must not depend on threads(): divide the work into parts of a fixed size, let each job write to
/// places of its own, and combine sums in the order of the jobs.
class Workers
{
public:
    virtual ~Workers() = default;
    /// Number of threads, the caller's included; at least 1.
    virtual int threads() const = 0;
    /// Runs job(0) .. job(count - 1), each once, in any order and on any of the threads, and returns when all are done. Jobs must not throw.
    /// A job that calls run() itself does the jobs of that call one after the other, on its own thread.
    template <class Job>
    void run(std::size_t count, Job&& job)
    {
        using Called = std::remove_reference_t<Job>;
        run_jobs(
            count, [](void* called, std::size_t index) { (*static_cast<Called*>(called))(index); },
            const_cast<void*>(static_cast<const void*>(std::addressof(job))));
    }

protected:
    using Call = void (*)(void* job, std::size_t index);
    virtual void run_jobs(std::size_t count, Call call, void* job) = 0;
};

}  // namespace plab
