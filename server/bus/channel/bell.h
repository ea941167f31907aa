/// Wakes the thread that sleeps at the other end, in this process or another.
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
    /// Takes the descriptor of an eventfd that does not block; -1: it rings nobody.
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
    /// Never waits: a full counter is a ring that nobody has heard yet.
    void ring() const
    {
        const std::uint64_t one = 1;
        [[maybe_unused]] const auto written = ::write(descriptor_, &one, sizeof one);
    }
    /// As ring(), for the process that sleeps on it: a system call only for the first one since it woke.
    void ring_once()
    {
        if (!algorithm_.exchange(true, std::memory_order_acq_rel)) ring();
    }
    /// The sleeper is awake: what was algorithm for before is seen by what follows.
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
