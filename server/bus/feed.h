/// One outgoing stream of records: a ring that the step thread fills, and the thread that communicates with plab-bus empties.
#pragma once

#include <atomic>
#include <type_traits>

#include "bus/channel/messages.h"
#include "publish/ring.h"

namespace plab::bus
{

enum class Sent : std::uint8_t
{
    Nothing,  ///< nothing was left to send
    More,     ///< there may be more
    Full,     ///< the pipe is full
    Broken,   ///< the other end's counter is invalid
};

template <class Record>
class Feed
{
public:
    Feed(publish::Stream stream, std::size_t capacity) : stream_(stream), ring_(capacity) {}

    // Step thread ------------------------------------------------------------------------------------------------------
    bool wanted() const { return wanted_.load(std::memory_order_relaxed); }
    std::uint64_t joins() const { return joins_.load(std::memory_order_relaxed); }
    Record& begin_push() { return ring_.begin_push(); }
    void end_push() { ring_.end_push(); }

    // Bus thread -------------------------------------------------------------------------------------------------------
    /// Takes over what plab-bus reports about readers. True if a new reader has joined.
    bool receive(const WantsMessage& wants, bool may_forget)
    {
        const auto i = static_cast<std::size_t>(stream_);
        is_read_ = wants.wanted[i] != 0;
        if (is_read_ || may_forget) wanted_.store(is_read_, std::memory_order_relaxed);
        const bool came = std::exchange(seen_, wants.joins[i]) < wants.joins[i];
        if (came) joins_.fetch_add(1, std::memory_order_relaxed);
        return came;
    }
    /// A new plab-bus has started and knows of no readers yet: streams that were wanted stay wanted until forget().
    void begin_anew() { is_read_ = false, seen_ = 0; }
    void forget() { wanted_.store(is_read_, std::memory_order_relaxed); }
    /// Sends at most `most` records. Records without a reader are kept while plab-bus is new.
    Sent send(std::size_t most, MessageWriter& to, bool is_new)
    {
        if (is_new && !is_read_) return Sent::Nothing;
        for (std::size_t i = 0; i < most; ++i)
        {
            if (!to.ready()) return Sent::Full;
            Record* const record = ring_.begin_pop();
            if (record == nullptr) return Sent::Nothing;
            const auto kind = static_cast<std::uint32_t>(Down::Stream) + static_cast<std::uint32_t>(stream_);
            const bool fine = to.send(kind, *record);
            // The vectors of frames and contacts are refilled in place; the memory of a burst of events is released.
            if constexpr (!std::is_same_v<Record, wire::Frame> && !std::is_same_v<Record, wire::ContactForces>) *record = Record{};
            ring_.end_pop();
            if (!fine) return Sent::Broken;
        }
        return ring_.empty() ? Sent::Nothing : Sent::More;
    }
    std::uint64_t dropped() const { return ring_.dropped(); }

private:
    publish::Stream stream_;
    publish::Ring<Record> ring_;
    std::atomic<bool> wanted_{false};
    std::atomic<std::uint64_t> joins_{0};
    bool is_read_ = false;    ///< as reported by the current plab-bus
    std::uint64_t seen_ = 0;  ///< total number of readers that it has seen
};

}  // namespace plab::bus
