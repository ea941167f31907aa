/// A bounded queue between two threads whose producer never waits: when it is full, the oldest entry is given up.
///
/// Entries are written and read in place, in slots that are made once, so that an entry's vectors keep their memory.
///
///     producer                         consumer
///     Frame& f = ring.begin_push();    while (Frame* f = ring.begin_pop())
///     fill(f);                         {
///     ring.end_push();                     send(*f);
///                                          ring.end_pop();
///                                      }
#pragma once

#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace plab::publish
{

/// Exactly one thread pushes and exactly one pops; neither ever waits for the other.
/// Each slot has one word: a ticket (the number of entries before it) and the owner of the slot. The entry with ticket t is in
/// slot t mod size. The producer takes a Ready slot away from the consumer, and the consumer one from the producer, by
/// compare-and-swap, so exactly one of them gets it. The producer skips a slot that is being read: its ticket is left out.
template <class T>
class Ring
{
public:
    /// Room for `capacity` unread entries (at least 1), and for the one that is being read.
    explicit Ring(std::size_t capacity) : slots_((capacity == 0 ? 1 : capacity) + 1) {}
    Ring(const Ring&) = delete;
    Ring& operator=(const Ring&) = delete;

    // Producer ---------------------------------------------------------------------------------------------------------
    /// A slot to fill, which still holds the data of an earlier entry. Hidden from the consumer until end_push().
    T& begin_push();
    void end_push();

    // Consumer ---------------------------------------------------------------------------------------------------------
    /// The oldest entry, held until end_pop(); null if there is none.
    T* begin_pop();
    void end_pop();

    // Both -------------------------------------------------------------------------------------------------------------
    /// Entries that were dropped because they were not read in time.
    std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }
    /// Whether there may be something to read.
    bool empty() const { return read_.load(std::memory_order_acquire) >= pushed_.load(std::memory_order_acquire); }

private:
    enum Owner : std::uint64_t
    {
        kEmpty,
        kWriting,
        kReady,
        kReading,
    };
    struct alignas(64) Slot
    {
        std::atomic<std::uint64_t> word{kEmpty};
        T value{};
    };
    static constexpr std::uint64_t word_of(std::uint64_t ticket, Owner owner) { return ticket << 2 | owner; }
    static constexpr Owner owner_in(std::uint64_t word) { return static_cast<Owner>(word & 3); }
    Slot& slot_of(std::uint64_t ticket) { return slots_[ticket % slots_.size()]; }

    std::vector<Slot> slots_;
    std::uint64_t next_ = 0;  ///< producer's: ticket of the next entry
    Slot* written_ = nullptr;
    alignas(64) std::atomic<std::uint64_t> pushed_{0};  ///< all smaller tickets were pushed, or left out
    std::atomic<std::uint64_t> dropped_{0};
    alignas(64) std::atomic<std::uint64_t> read_{0};  ///< consumer's: ticket of the next entry; other threads only read it
    Slot* held_ = nullptr;
};

template <class T>
T& Ring<T>::begin_push()
{
    assert(!written_ && "end_push() first");
    // Each turn that finds a slot held by the consumer continues with the next one. There is always one that it does not hold,
    // and it can empty each slot only once while nothing is pushed: no more than two rounds.
    for (;; ++next_)
    {
        Slot& slot = slot_of(next_);
        std::uint64_t word = slot.word.load(std::memory_order_acquire);
        const bool unread = owner_in(word) == kReady;
        if (unread && !slot.word.compare_exchange_strong(word, word_of(next_, kWriting), std::memory_order_acquire)) continue;
        if (owner_in(word) == kReading) continue;
        if (unread)
            dropped_.fetch_add(1, std::memory_order_relaxed);
        else
            slot.word.store(word_of(next_, kWriting), std::memory_order_relaxed);
        written_ = &slot;
        return slot.value;
    }
}

template <class T>
void Ring<T>::end_push()
{
    assert(written_ && "begin_push() first");
    written_->word.store(word_of(next_, kReady), std::memory_order_release);
    written_ = nullptr;
    pushed_.store(++next_, std::memory_order_release);
}

template <class T>
T* Ring<T>::begin_pop()
{
    assert(!held_ && "end_pop() first");
    const std::uint64_t pushed = pushed_.load(std::memory_order_acquire);
    std::uint64_t ticket = read_.load(std::memory_order_relaxed);
    // Older ones have already been overwritten.
    if (pushed > slots_.size() && ticket < pushed - slots_.size()) ticket = pushed - slots_.size();
    for (; ticket < pushed && !held_; ++ticket)
    {
        Slot& slot = slot_of(ticket);
        std::uint64_t word = word_of(ticket, kReady);
        if (slot.word.compare_exchange_strong(word, word_of(ticket, kReading), std::memory_order_acquire)) held_ = &slot;
    }
    read_.store(ticket, std::memory_order_release);
    return held_ ? &held_->value : nullptr;
}

template <class T>
void Ring<T>::end_pop()
{
    assert(held_ && "begin_pop() first");
    held_->word.store(kEmpty, std::memory_order_release);
    held_ = nullptr;
}

}  // namespace plab::publish
