#include "simulation/threads/worker_pool.h"

#include <algorithm>
#include <chrono>

namespace plab::simulation
{
namespace
{

constexpr std::chrono::microseconds kWatch{50};
constexpr std::uint64_t kJobs = 0xffffffff;  // the lower half of an offer

/// This thread is doing a job.
thread_local bool at_work = false;

void pause_briefly()
{
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

}  // namespace

WorkerPool::WorkerPool(int threads) : may_watch_(static_cast<unsigned>(std::max(threads, 1)) <= std::thread::hardware_concurrency())
{
    for (int i = 1; i < threads; ++i) workers_.emplace_back([this] { work(); });
}

WorkerPool::~WorkerPool()
{
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    wake_.notify_all();
    for (std::thread& t : workers_) t.join();
}

template <class Condition>
bool WorkerPool::watch(const Condition& holds) const
{
    constexpr int kPolls = 64;  // between two readings of the clock
    if (holds()) return true;
    if (!may_watch_) return false;
    const auto end = std::chrono::steady_clock::now() + kWatch;
    do
        for (int i = 0; i < kPolls; ++i)
        {
            if (holds()) return true;
            pause_briefly();
        }
    while (std::chrono::steady_clock::now() < end);
    return false;
}

bool WorkerPool::has_work() const { return stop_ || (offer_.load() & kJobs) != 0; }

/// A job is taken by counting the offer down. As the number of the call is part of the offer, a thread that was held up cannot take a job
/// of a later call for one of this; and while a taken job is unfinished, the call it belongs to has not returned.
void WorkerPool::take_jobs()
{
    std::uint64_t offer = offer_.load();
    while ((offer & kJobs) != 0)
    {
        if (!offer_.compare_exchange_weak(offer, offer - 1)) continue;
        at_work = true;
        call_(job_, count_ - static_cast<std::size_t>(offer & kJobs));
        at_work = false;
        if (--unfinished_ == 0 && caller_sleeps_)
        {
            const std::lock_guard lock(mutex_);
            done_.notify_one();
        }
        offer = offer_.load();
    }
}

void WorkerPool::run_jobs(std::size_t count, Call call, void* job)
{
    if (workers_.empty() || count < 2 || at_work)
    {
        for (std::size_t i = 0; i < count; ++i) call(job, i);
        return;
    }
    call_ = call, job_ = job, count_ = count;
    unfinished_ = count;
    offer_ = (((offer_.load() >> 32) + 1) << 32) | count;
    if (asleep_ != 0)
    {
        const std::lock_guard lock(mutex_);  // so that none is between its last look at the offer and its sleep
        wake_.notify_all();
    }
    take_jobs();
    const auto done = [this] { return unfinished_ == 0; };
    if (watch(done)) return;
    std::unique_lock lock(mutex_);
    caller_sleeps_ = true;
    done_.wait(lock, done);
    caller_sleeps_ = false;
}

void WorkerPool::work()
{
    while (!stop_)
    {
        take_jobs();
        if (watch([this] { return has_work(); })) continue;
        std::unique_lock lock(mutex_);
        ++asleep_;
        wake_.wait(lock, [this] { return has_work(); });
        --asleep_;
    }
}

}  // namespace plab::simulation
