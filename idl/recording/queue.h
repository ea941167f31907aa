/// A bounded queue between two threads that keeps the order and refuses entries that find no room. If the newest entry matters
/// more than the oldest, use Ring.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
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

}  // namespace plab::recording
