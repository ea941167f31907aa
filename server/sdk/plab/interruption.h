/// The word by which work that takes long is given up: asked for by a signal, a client or a deadline, looked at by the work itself.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

namespace plab
{

/// Asked for on any thread or in a signal handler; never taken back. Who looks and finds it due leaves off at once, wherever
/// that leaves the numbers: the host gives up the whole step, and the world is as it was where the step began. So the moment at
/// which it comes is no part of the state's course.
class Interruption
{
public:
    Interruption() = default;
    /// Due where the other one is, too.
    explicit Interruption(const Interruption* also) : also_(also) {}
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    /// Work in hand is to end when `grace` is over; what is done by then is done. The earliest counts.
    void ask(std::chrono::nanoseconds grace = {}) noexcept
    {
        const std::int64_t at = now() + grace.count();
        std::int64_t before = at_.load(std::memory_order_relaxed);
        while (at < before && !at_.compare_exchange_weak(before, at, std::memory_order_release, std::memory_order_relaxed)) continue;
    }
    /// Whether anybody asked; it may not be due yet.
    bool asked() const noexcept { return at_.load(std::memory_order_relaxed) != kNever || (also_ && also_->asked()); }
    /// Whether to leave off now. Costs a load where nobody asked.
    bool due() const noexcept
    {
        const std::int64_t at = at_.load(std::memory_order_relaxed);
        if ((at == kNever || now() < at) && !(also_ && also_->due())) return false;
        heeded_.store(true, std::memory_order_relaxed);
        return true;
    }
    /// Whether somebody found it due, and left something undone.
    bool heeded() const noexcept { return heeded_.load(std::memory_order_relaxed); }
    /// Before the next piece of work.
    void forget_heeded() const noexcept { heeded_.store(false, std::memory_order_relaxed); }

private:
    static constexpr std::int64_t kNever = INT64_MAX;
    static std::int64_t now() noexcept { return std::chrono::steady_clock::now().time_since_epoch().count(); }

    std::atomic<std::int64_t> at_{kNever};  ///< ns of the steady clock
    mutable std::atomic<bool> heeded_{false};
    const Interruption* also_ = nullptr;
};
static_assert(std::atomic<std::int64_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free, "signal handlers ask");

}  // namespace plab
