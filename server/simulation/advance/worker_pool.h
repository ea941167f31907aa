/// Threads that share a list of independent jobs. The result does not depend on which thread does which job.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace plab::simulation
{

class WorkerPool
{
public:
    /// `threads` in all, the caller's included; 1 starts none.
    explicit WorkerPool(int threads);
    ~WorkerPool();
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    int threads() const { return static_cast<int>(workers_.size()) + 1; }
    /// Runs job(0) .. job(count - 1), each once, and returns when all are done.
    void run(std::size_t count, const std::function<void(std::size_t)>& job);

private:
    void work();
    void take_jobs();

    std::vector<std::thread> workers_;
    std::mutex mutex_;
    std::condition_variable wake_, done_;
    const std::function<void(std::size_t)>* job_ = nullptr;
    std::size_t count_ = 0;
    std::atomic<std::size_t> next_{0};
    std::size_t busy_ = 0;
    std::uint64_t round_ = 0;
    bool stop_ = false;
};

}  // namespace plab::simulation
