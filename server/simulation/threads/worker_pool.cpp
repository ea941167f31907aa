#include "simulation/threads/worker_pool.h"

namespace plab::simulation
{

WorkerPool::WorkerPool(int threads)
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

void WorkerPool::take_jobs()
{
    for (std::size_t i = next_++; i < count_; i = next_++) call_(job_, i);
}

void WorkerPool::run_jobs(std::size_t count, Call call, void* job)
{
    if (workers_.empty() || count < 2)
    {
        for (std::size_t i = 0; i < count; ++i) call(job, i);
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        call_ = call, job_ = job, count_ = count, next_ = 0, busy_ = workers_.size();
        ++round_;
    }
    wake_.notify_all();
    take_jobs();
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return busy_ == 0; });
}

void WorkerPool::work()
{
    std::uint64_t seen = 0;
    std::unique_lock lock(mutex_);
    while (true)
    {
        wake_.wait(lock, [&] { return stop_ || round_ != seen; });
        if (stop_) return;
        seen = round_;
        lock.unlock();
        take_jobs();
        lock.lock();
        if (--busy_ == 0) done_.notify_one();
    }
}

}  // namespace plab::simulation
