/// What the step loop sleeps on: a time, a request, a signal.
#pragma once

#include <chrono>

#include "plab/result.h"

namespace plab::daemon
{

class Wake
{
public:
    using Clock = std::chrono::steady_clock;

    static Result<Wake> make();
    Wake(Wake&& other) noexcept;
    Wake& operator=(Wake&& other) = delete;
    Wake(const Wake&) = delete;
    Wake& operator=(const Wake&) = delete;
    ~Wake();

    /// From any thread, and from a signal handler.
    void wake() const;
    /// Until somebody wakes, or `due`. True if somebody did, also before this call.
    bool wait_until(Clock::time_point due) const;
    /// An eventfd: who adds 1 to it wakes.
    int descriptor() const { return descriptor_; }

private:
    explicit Wake(int descriptor) : descriptor_(descriptor) {}
    int descriptor_ = -1;  ///< eventfd
};

}  // namespace plab::daemon
