/// Threads that share a list of independent jobs. The result does not depend on which thread does which job.
///
/// Each thread has a range of the jobs of its own, the same share in each call, and takes from the others' ranges only when its own is
/// empty. The parts of a step divide the same bodies and contacts in the same order, so a thread mostly meets data that are in its caches.
///
/// A call returns when its jobs are done, whether or not all threads have noticed it: one that wakes late finds nothing left. Between
/// calls a thread looks for work for kWatch and then sleeps, so calls that follow one another quickly, as the colours of a sweep do, cost
/// about a microsecond each, and a server that is paused needs no processor time. If there are more threads than processors, threads that
/// look for work would hold up those that do it, so they sleep at once.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

#include "plab/workers.h"

namespace plab::simulation
{

class WorkerPool final : public Workers
{
public:
    /// `threads` in all, the caller's included; 1 starts none.
    explicit WorkerPool(int threads);
    ~WorkerPool() override;
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    int threads() const override { return static_cast<int>(workers_.size()) + 1; }

private:
    /// The jobs that nobody has taken yet of one thread's share: those from the upper half of the number to the lower half less one.
    struct alignas(64) Range
    {
        std::atomic<std::uint64_t> jobs{0};
    };
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

    void run_jobs(std::size_t count, Call call, void* job) override;
    void work(std::size_t self);
    /// Takes jobs until none is left.
    void take_jobs(std::size_t self);
    /// A job of this thread's own range from its beginning, or of another one's from its end; kNone: there is none left.
    std::size_t take_job(std::size_t self);
    /// Looks at `holds` for kWatch. Returns whether it came to hold.
    template <class Condition>
    bool watch(const Condition& holds) const;
    bool has_work() const;

    std::vector<std::thread> workers_;
    bool may_watch_ = false;  ///< there is a processor for each thread
    // Written before jobs are offered, and read only by those who have taken one.
    Call call_ = nullptr;
    void* job_ = nullptr;
    std::vector<Range> ranges_;  ///< by thread; the caller's is the first
    alignas(64) std::atomic<std::size_t> unfinished_{0};
    alignas(64) std::atomic<std::uint32_t> asleep_{0};  ///< threads that wait for wake_
    std::atomic<bool> caller_sleeps_{false}, stop_{false};
    std::mutex mutex_;
    std::condition_variable wake_, done_;
};

}  // namespace plab::simulation
