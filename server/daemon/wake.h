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

    /// May be called from any thread, and from a signal handler.
    void wake() const;
    /// Sleeps until a wake or until `due`. True if there was a wake, also before this call.
    bool wait_until(Clock::time_point due) const;
    /// An eventfd: adding 1 to it wakes the loop.
    int descriptor() const { return descriptor_; }

private:
    explicit Wake(int descriptor) : descriptor_(descriptor) {}
    int descriptor_ = -1;  ///< eventfd
};

}  // namespace plab::daemon
