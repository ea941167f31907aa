/// A bounded queue between two threads that keeps the order and refuses entries that find no room. If the newest entry matters
/// more than the oldest, use Ring.
#pragma once

#include <semaphore.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <optional>
#include <utility>
#include <vector>

namespace plab::recording
{

/// Exactly one thread pushes and exactly one pops; neither ever waits.
template <class T>
class Queue
{
public:
    explicit Queue(std::size_t capacity) : slots_(capacity == 0 ? 1 : capacity) {}
    Queue(const Queue&) = delete;
    Queue& operator=(const Queue&) = delete;

    /// False: the queue is full, and `value` is unchanged.
    bool push(T& value)
    {
        const std::uint64_t pushed = pushed_.load(std::memory_order_relaxed);
        if (pushed - popped_.load(std::memory_order_acquire) >= slots_.size()) return false;
        slots_[pushed % slots_.size()] = std::move(value);
        pushed_.store(pushed + 1, std::memory_order_release);
        return true;
    }
    std::optional<T> pop()
    {
        const std::uint64_t popped = popped_.load(std::memory_order_relaxed);
        if (popped == pushed_.load(std::memory_order_acquire)) return {};
        std::optional<T> out(std::move(slots_[popped % slots_.size()]));
        popped_.store(popped + 1, std::memory_order_release);
        return out;
    }
    /// Number of waiting entries, as either side may see it.
    std::size_t size() const
    {
        const std::uint64_t popped = popped_.load(std::memory_order_acquire);
        return static_cast<std::size_t>(pushed_.load(std::memory_order_acquire) - popped);
    }
    std::size_t capacity() const { return slots_.size(); }

private:
    std::vector<T> slots_;
    alignas(64) std::atomic<std::uint64_t> pushed_{0};
    alignas(64) std::atomic<std::uint64_t> popped_{0};
};

// What the thread of a recording sleeps on. Any thread may notify it; several notifications before it wakes count as one.

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
