#include "simulation/threads/worker_pool.h"

#include <algorithm>
#include <chrono>

namespace plab::simulation
{
namespace
{

constexpr std::chrono::microseconds kWatch{50};
constexpr std::uint64_t kEnd = 0xffffffff;  // the lower half of a range

std::uint64_t range(std::size_t begin, std::size_t end) { return static_cast<std::uint64_t>(begin) << 32 | end; }
bool is_empty(std::uint64_t jobs) { return (jobs >> 32) >= (jobs & kEnd); }

/// This thread is doing a job.
thread_local bool at_work = false;

void pause_briefly()
{
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

}  // namespace

WorkerPool::WorkerPool(int threads)
    : may_watch_(static_cast<unsigned>(std::max(threads, 1)) <= std::thread::hardware_concurrency()),
      ranges_(static_cast<std::size_t>(std::max(threads, 1)))
{
    for (std::size_t i = 1; i < ranges_.size(); ++i) workers_.emplace_back([this, i] { work(i); });
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

bool WorkerPool::has_work() const
{
    return stop_ || std::any_of(ranges_.begin(), ranges_.end(), [](const Range& r) { return !is_empty(r.jobs.load()); });
}

/// A thread that was held up may take a job of a later call than the one it looked for. That does no harm: the range that it has changed
/// names the job, and the call cannot return before that job is done.
std::size_t WorkerPool::take_job(std::size_t self)
{
    std::atomic<std::uint64_t>& own = ranges_[self].jobs;
    for (std::uint64_t jobs = own.load(); !is_empty(jobs);)
        if (own.compare_exchange_weak(jobs, jobs + (std::uint64_t{1} << 32))) return static_cast<std::size_t>(jobs >> 32);
    for (std::size_t k = 1; k < ranges_.size(); ++k)
    {
        std::atomic<std::uint64_t>& other = ranges_[(self + k) % ranges_.size()].jobs;
        for (std::uint64_t jobs = other.load(); !is_empty(jobs);)
            if (other.compare_exchange_weak(jobs, jobs - 1)) return static_cast<std::size_t>((jobs & kEnd) - 1);
    }
    return kNone;
}

void WorkerPool::take_jobs(std::size_t self)
{
    for (std::size_t index = take_job(self); index != kNone; index = take_job(self))
    {
        at_work = true;
        call_(job_, index);
        at_work = false;
        if (--unfinished_ == 0 && caller_sleeps_)
        {
            const std::lock_guard lock(mutex_);
            done_.notify_one();
        }
    }
}

void WorkerPool::run_jobs(std::size_t count, Call call, void* job)
{
    if (workers_.empty() || count < 2 || at_work)
    {
        for (std::size_t i = 0; i < count; ++i) call(job, i);
        return;
    }
    call_ = call, job_ = job;
    unfinished_ = count;
    const std::size_t threads = ranges_.size();
    for (std::size_t t = threads; t-- > 0;) ranges_[t].jobs = range(count * t / threads, count * (t + 1) / threads);
    if (asleep_ != 0)
    {
        const std::lock_guard lock(mutex_);  // so that none is between its last look at the offer and its sleep
        wake_.notify_all();
    }
    take_jobs(0);
    const auto done = [this] { return unfinished_ == 0; };
    if (watch(done)) return;
    std::unique_lock lock(mutex_);
    caller_sleeps_ = true;
    done_.wait(lock, done);
    caller_sleeps_ = false;
}

void WorkerPool::work(std::size_t self)
{
    while (!stop_)
    {
        take_jobs(self);
        if (watch([this] { return has_work(); })) continue;
        std::unique_lock lock(mutex_);
        ++asleep_;
        wake_.wait(lock, [this] { return has_work(); });
        --asleep_;
    }
}

}  // namespace plab::simulation
