/// The signal that interrupts long computations: set by a signal handler, a client or a deadline, and polled by the computation.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

namespace plab
{

/// Can be set on any thread or in a signal handler, and is never withdrawn. A computation that finds it due returns at once, whatever
/// state its values are in. The host then discards the whole step and restores the world to the start of the step, so the moment of the
/// interruption does not influence the state.
class Interruption
{
public:
    Interruption() = default;
    /// Also due whenever the other one is due.
    explicit Interruption(const Interruption* also) : also_(also) {}
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    /// Requests that work in progress ends after `grace`; what is completed by then is valid. The earliest request counts.
    void ask(std::chrono::nanoseconds grace = {}) noexcept
    {
        const std::int64_t at = now() + grace.count();
        std::int64_t before = at_.load(std::memory_order_relaxed);
        while (at < before && !at_.compare_exchange_weak(before, at, std::memory_order_release, std::memory_order_relaxed)) continue;
    }
    /// Whether an interruption was requested; it may not be due yet.
    bool asked() const noexcept { return at_.load(std::memory_order_relaxed) != kNever || (also_ && also_->asked()); }
    /// Whether to return now. Costs one load if nothing was requested.
    bool due() const noexcept
    {
        const std::int64_t at = at_.load(std::memory_order_relaxed);
        if ((at == kNever || now() < at) && !(also_ && also_->due())) return false;
        has_interrupted_.store(true, std::memory_order_relaxed);
        return true;
    }
    /// Whether a computation found it due and left work unfinished.
    bool has_interrupted() const noexcept { return has_interrupted_.load(std::memory_order_relaxed); }
    /// To be called before the next computation.
    void clear_interrupted() const noexcept { has_interrupted_.store(false, std::memory_order_relaxed); }

private:
    static constexpr std::int64_t kNever = INT64_MAX;
    static std::int64_t now() noexcept { return std::chrono::steady_clock::now().time_since_epoch().count(); }

    std::atomic<std::int64_t> at_{kNever};  ///< ns of the steady clock
    mutable std::atomic<bool> has_interrupted_{false};
    const Interruption* also_ = nullptr;
};
static_assert(std::atomic<std::int64_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free, "signal handlers ask");

}  // namespace plab
