/// Threads that share a list of independent jobs. The result does not depend on which thread does which job.
#pragma once

#include <atomic>
#include <condition_variable>
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
    void run_jobs(std::size_t count, Call call, void* job) override;
    void work();
    void take_jobs();

    std::vector<std::thread> workers_;
    std::mutex mutex_;
    std::condition_variable wake_, done_;
    Call call_ = nullptr;
    void* job_ = nullptr;
    std::size_t count_ = 0;
    std::atomic<std::size_t> next_{0};
    std::size_t busy_ = 0;
    std::uint64_t round_ = 0;
    bool stop_ = false;
};

}  // namespace plab::simulation
