/// Wakes the thread that sleeps at the other end, in this process or in another one.
#pragma once

#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <utility>

namespace plab::bus
{

class Bell
{
public:
    /// Takes the descriptor of a non-blocking eventfd; -1: ring() does nothing.
    explicit Bell(int descriptor = -1) : descriptor_(descriptor) {}
    static Bell make() { return Bell(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)); }
    Bell(Bell&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
    Bell& operator=(Bell&& other) noexcept
    {
        std::swap(descriptor_, other.descriptor_);
        return *this;
    }
    Bell(const Bell&) = delete;
    Bell& operator=(const Bell&) = delete;
    ~Bell()
    {
        if (descriptor_ >= 0) (void)close(descriptor_);
    }

    int descriptor() const { return descriptor_; }
    /// Never waits: if the counter is full, the sleeper has not read an earlier ring yet.
    void ring() const
    {
        const std::uint64_t one = 1;
        [[maybe_unused]] const auto written = ::write(descriptor_, &one, sizeof one);
    }
    /// Like ring(), for the process that sleeps on it: it makes a system call only for the first ring since the sleeper woke.
    void ring_once()
    {
        if (!algorithm_.exchange(true, std::memory_order_acq_rel)) ring();
    }
    /// Called when the sleeper has woken: whatever was written before a ring is visible to what follows.
    void heard()
    {
        std::uint64_t count = 0;
        [[maybe_unused]] const auto n = ::read(descriptor_, &count, sizeof count);
        (void)algorithm_.exchange(false, std::memory_order_acq_rel);
    }

private:
    int descriptor_;
    std::atomic<bool> algorithm_{false};
};

}  // namespace plab::bus
