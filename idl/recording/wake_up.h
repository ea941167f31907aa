/// What the thread of a recording sleeps on. Any thread may notify it; several notifications before it wakes count as one.
#pragma once

#include <semaphore.h>

#include <atomic>
#include <chrono>
#include <ctime>

namespace plab::recording
{

class WakeUp
{
public:
    WakeUp() { (void)sem_init(&semaphore_, 0, 0); }
    ~WakeUp() { (void)sem_destroy(&semaphore_); }
    WakeUp(const WakeUp&) = delete;
    WakeUp& operator=(const WakeUp&) = delete;

    /// Never waits. Costs a system call only for the first call since the sleeper woke.
    void notify()
    {
        if (!is_signalled_.exchange(true, std::memory_order_acq_rel)) (void)sem_post(&semaphore_);
    }
    /// Sleeps until a notification, or for this time. Whatever was written before it is visible to what follows the return.
    void sleep(std::chrono::nanoseconds longest)
    {
        timespec end{};
        (void)clock_gettime(CLOCK_MONOTONIC, &end);
        const std::int64_t ns = end.tv_nsec + longest.count();
        end.tv_sec += static_cast<std::time_t>(ns / 1'000'000'000), end.tv_nsec = static_cast<long>(ns % 1'000'000'000);
        // An interrupted wait only makes one early pass, which is harmless.
        (void)sem_clockwait(&semaphore_, CLOCK_MONOTONIC, &end);
        (void)is_signalled_.exchange(false, std::memory_order_acq_rel);
    }

private:
    sem_t semaphore_{};
    std::atomic<bool> is_signalled_{false};
};

}  // namespace plab::recording
