/// Wakes the thread that sleeps at the other end, in this process or in another one.
#pragma once

#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <utility>

namespace plab::bus
{

class WakeEvent
{
public:
    /// Takes the descriptor of a non-blocking eventfd; -1: notify() does nothing.
    explicit WakeEvent(int descriptor = -1) : descriptor_(descriptor) {}
    static WakeEvent make() { return WakeEvent(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)); }
    WakeEvent(WakeEvent&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
    WakeEvent& operator=(WakeEvent&& other) noexcept
    {
        std::swap(descriptor_, other.descriptor_);
        return *this;
    }
    WakeEvent(const WakeEvent&) = delete;
    WakeEvent& operator=(const WakeEvent&) = delete;
    ~WakeEvent()
    {
        if (descriptor_ >= 0) (void)close(descriptor_);
    }

    int descriptor() const { return descriptor_; }
    /// Never waits: if the counter is full, the sleeper has not read an earlier notification yet.
    void notify() const
    {
        const std::uint64_t one = 1;
        [[maybe_unused]] const auto written = ::write(descriptor_, &one, sizeof one);
    }
    /// Like notify(), for the process that sleeps on it: it makes a system call only for the first call since the sleeper woke.
    void notify_once()
    {
        if (!is_set_.exchange(true, std::memory_order_acq_rel)) notify();
    }
    /// Called when the sleeper has woken: whatever was written before a notification is visible to what follows.
    void acknowledge()
    {
        std::uint64_t count = 0;
        [[maybe_unused]] const auto n = ::read(descriptor_, &count, sizeof count);
        (void)is_set_.exchange(false, std::memory_order_acq_rel);
    }

private:
    int descriptor_;
    std::atomic<bool> is_set_{false};
};

}  // namespace plab::bus
