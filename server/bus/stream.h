/// One topic without keys or history for late joiners: a ring that the step thread fills, and a writer that the bus
/// thread empties it into.
#pragma once

#include <atomic>
#include <type_traits>

#include "bus/trouble.h"
#include "idl/entity.h"
#include "publish/records.h"
#include "publish/ring.h"

namespace plab::bus
{

/// T: type of the wire. Sample: makes one of a Record.
template <class T, class Sample, class Record>
class Stream
{
public:
    explicit Stream(std::size_t capacity) : ring_(capacity) {}

    // Step thread ------------------------------------------------------------------------------------------------------
    bool wanted() const { return wanted_.load(std::memory_order_relaxed); }
    std::uint64_t joins() const { return joins_.load(std::memory_order_relaxed); }
    Record& begin_push() { return ring_.begin_push(); }
    void end_push() { ring_.end_push(); }

    // Bus thread -------------------------------------------------------------------------------------------------------
    /// The writer is there while the scene has something to write with it.
    Result<void> be(bool there, const wire::Entity& participant, const wire::Entity& publisher)
    {
        if (there == writer_.entity().valid()) return {};
        wanted_.store(false, std::memory_order_relaxed);
        writer_ = {}, seen_ = 0;
        if (!there) return {};
        auto writer = wire::Writer<T>::make(participant, publisher);
        if (!writer) return writer.errors();
        writer_ = writer.take();
        return {};
    }
    /// Looks for readers. True if one has come since the last look.
    bool look()
    {
        const wire::Matched readers = writer_.entity().valid() ? writer_.matched() : wire::Matched{};
        const bool came = readers.ever > seen_ && readers.now > 0;
        seen_ = readers.ever;
        wanted_.store(readers.now > 0, std::memory_order_relaxed);
        if (came) joins_.fetch_add(1, std::memory_order_relaxed);
        return came;
    }
    /// Writes at most `most` records. True if there are more.
    bool send(std::size_t most, Trouble& trouble)
    {
        for (std::size_t i = 0; i < most; ++i)
        {
            Record* const record = ring_.begin_pop();
            if (record == nullptr) return false;
            if (wanted()) (void)trouble.check(topic(), writer_.write(sample_.of(*record)));
            // A frame's vectors are filled again in place; what a burst of events took is given back.
            if constexpr (!std::is_same_v<Record, publish::Frame>) *record = Record{};
            ring_.end_pop();
        }
        return !ring_.empty();
    }
    std::uint64_t dropped() const { return ring_.dropped(); }
    static const char* topic() { return wire::topic_of<T>().name; }
    const wire::Entity& writer() const { return writer_.entity(); }

private:
    publish::Ring<Record> ring_;
    Sample sample_;
    wire::Writer<T> writer_;
    std::atomic<bool> wanted_{false};
    std::atomic<std::uint64_t> joins_{0};
    std::uint32_t seen_ = 0;  ///< readers of this writer, ever, at the last look
};

}  // namespace plab::bus
