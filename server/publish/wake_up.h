/// What a thread that serves the step thread sleeps on. Any thread may ring; many rings before it wakes are one.
#pragma once

#include <semaphore.h>

#include <atomic>
#include <chrono>
#include <ctime>

namespace plab::publish
{

class WakeUp
{
public:
    WakeUp() { (void)sem_init(&semaphore_, 0, 0); }
    ~WakeUp() { (void)sem_destroy(&semaphore_); }
    WakeUp(const WakeUp&) = delete;
    WakeUp& operator=(const WakeUp&) = delete;

    /// Never waits. Costs a system call only for the first ring since the sleeper woke.
    void ring()
    {
        if (!algorithm_.exchange(true, std::memory_order_acq_rel)) (void)sem_post(&semaphore_);
    }
    /// Until a ring, or for so long. What was algorithm for before this returns is seen by what follows it.
    void sleep(std::chrono::nanoseconds longest)
    {
        timespec end{};
        (void)clock_gettime(CLOCK_MONOTONIC, &end);
        const std::int64_t ns = end.tv_nsec + longest.count();
        end.tv_sec += static_cast<std::time_t>(ns / 1'000'000'000), end.tv_nsec = static_cast<long>(ns % 1'000'000'000);
        // An interrupted wait is an early pass, which does no harm.
        (void)sem_clockwait(&semaphore_, CLOCK_MONOTONIC, &end);
        (void)algorithm_.exchange(false, std::memory_order_acq_rel);
    }

private:
    sem_t semaphore_{};
    std::atomic<bool> algorithm_{false};
};

}  // namespace plab::publish
