/// One topic without keys or history for late joiners: writes the records of one stream.
#pragma once

#include "bus/channel/archive.h"
#include "bus/process/trouble.h"
#include "idl/entity.h"
#include "idl/samples.h"

namespace plab::bus
{

/// T: type on the wire. Record: its value. Writer: writes Ts.
template <class T, class Record, class Writer = wire::DataWriter<T>>
class Stream
{
public:
    /// The writer exists while the scene has something to write with it.
    Result<void> be(bool there, const wire::Entity& participant, const wire::Entity& publisher)
    {
        if (there == writer_.entity().valid()) return {};
        writer_ = {}, seen_ = 0;
        if (!there) return {};
        auto writer = Writer::make(participant, publisher);
        if (!writer) return writer.errors();
        writer_ = writer.take();
        return {};
    }
    /// Checks for readers. True if anything changed since the last check.
    bool check_readers()
    {
        const wire::Matched readers = writer_.entity().valid() ? writer_.matched() : wire::Matched{};
        const bool came = readers.ever > seen_ && readers.now > 0, was_wanted = is_wanted_;
        seen_ = readers.ever, is_wanted_ = readers.now > 0;
        joins_ += came ? 1 : 0;
        return came || was_wanted != is_wanted_;
    }
    bool wanted() const { return is_wanted_; }
    std::uint64_t joins() const { return joins_; }
    /// False if the bytes are not a record.
    bool write(std::span<const std::byte> bytes, Trouble& trouble)
    {
        if (!is_wanted_ || !writer_.entity().valid()) return true;
        Decoder decoder(bytes);
        decoder.get(record_);
        if (decoder.whole()) (void)trouble.check(topic(), writer_.write(sample_.of(record_)));
        return decoder.whole();
    }
    static const char* topic() { return wire::topic_of<T>().name; }
    const wire::Entity& writer() const { return writer_.entity(); }

private:
    Record record_;  ///< refilled each time, reusing its memory
    wire::SampleView<T> sample_;
    Writer writer_;
    bool is_wanted_ = false;
    std::uint64_t joins_ = 0;
    std::uint32_t seen_ = 0;  ///< total number of readers of this writer, at the last check
};

}  // namespace plab::bus
