#include "idl/recording/encode.h"

#include <bit>
#include <cstring>

#include "idl/recording/crc.h"
#include "idl/recording/fields.h"

namespace plab::recording
{
namespace
{

static_assert(std::endian::native == std::endian::little, "numbers are copied byte for byte");

template <class T>
void put(Bytes& out, T v)
{
    const std::size_t at = out.size();
    out.resize(at + sizeof v);
    std::memcpy(out.data() + at, &v, sizeof v);
}

template <class List>
void put_list(Bytes& out, const List& list);

/// Appends fields, each by its type.
struct FieldWriter
{
    Bytes* out;

    template <class... Fields>
    void operator()(const Fields&... all)
    {
        (one(all), ...);
    }
    template <class Number>
    requires std::is_integral_v<Number>
    void one(Number v) { put(*out, v); }
    void one(Opcode v) { put(*out, static_cast<std::uint8_t>(v)); }
    void one(const std::string& v) { put_text(*out, v); }
    template <class List>
    requires requires(const List& list) { list.begin()->second; }
    void one(const List& v) { put_list(*out, v); }
};

/// Maps and arrays are preceded by their length in bytes, which is known afterwards.
template <class List>
void put_list(Bytes& out, const List& list)
{
    const std::size_t at = out.size();
    put_u32(out, 0);
    for (const auto& [first, second] : list) FieldWriter{&out}(first, second);
    const auto length = static_cast<std::uint32_t>(out.size() - at - 4);
    std::memcpy(out.data() + at, &length, sizeof length);
}

/// Begins a record; returns where, for end_record, which fills in its length.
std::size_t begin_record(Bytes& out, Opcode opcode)
{
    const std::size_t begin = out.size();
    put(out, static_cast<std::uint8_t>(opcode));
    put(out, std::uint64_t{0});
    return begin;
}

void end_record(Bytes& out, std::size_t begin)
{
    const std::uint64_t length = out.size() - begin - kRecordHead;
    std::memcpy(out.data() + begin + 1, &length, sizeof length);
}

template <class Record>
void append_fields(Bytes& out, Opcode opcode, const Record& record)
{
    const std::size_t begin = begin_record(out, opcode);
    fields(FieldWriter{&out}, record);
    end_record(out, begin);
}

}  // namespace

void put_u32(Bytes& out, std::uint32_t v) { put(out, v); }

void put_text(Bytes& out, std::string_view text)
{
    put_u32(out, static_cast<std::uint32_t>(text.size()));
    out.insert(out.end(), text.begin(), text.end());
}

void put_bytes(Bytes& out, ByteView bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); }

void append(Bytes& out, const Header& record) { append_fields(out, Opcode::Header, record); }
void append(Bytes& out, const Footer& record) { append_fields(out, Opcode::Footer, record); }
void append(Bytes& out, const Schema& record) { append_fields(out, Opcode::Schema, record); }
void append(Bytes& out, const Channel& record) { append_fields(out, Opcode::Channel, record); }
void append(Bytes& out, const ChunkIndex& record) { append_fields(out, Opcode::ChunkIndex, record); }
void append(Bytes& out, const AttachmentIndex& record) { append_fields(out, Opcode::AttachmentIndex, record); }
void append(Bytes& out, const Statistics& record) { append_fields(out, Opcode::Statistics, record); }
void append(Bytes& out, const Metadata& record) { append_fields(out, Opcode::Metadata, record); }
void append(Bytes& out, const MetadataIndex& record) { append_fields(out, Opcode::MetadataIndex, record); }
void append(Bytes& out, const SummaryOffset& record) { append_fields(out, Opcode::SummaryOffset, record); }
void append(Bytes& out, const DataEnd& record) { append_fields(out, Opcode::DataEnd, record); }

void append(Bytes& out, const Message& record)
{
    const std::size_t begin = begin_record(out, Opcode::Message);
    fields(FieldWriter{&out}, record);
    put_bytes(out, record.data);
    end_record(out, begin);
}

void append(Bytes& out, const Attachment& record)
{
    const std::size_t begin = begin_record(out, Opcode::Attachment);
    fields(FieldWriter{&out}, record);
    put(out, std::uint64_t{record.data.size()});
    put_bytes(out, record.data);
    put(out, crc_of(ByteView(out).subspan(begin + kRecordHead)));
    end_record(out, begin);
}

void append_chunk(Bytes& out, const ChunkHeader& header, ByteView records)
{
    const std::size_t begin = begin_record(out, Opcode::Chunk);
    fields(FieldWriter{&out}, header);
    put_bytes(out, records);
    end_record(out, begin);
}

void append_message_index(Bytes& out, ChannelId channel, const MessageTimes& entries)
{
    const std::size_t begin = begin_record(out, Opcode::MessageIndex);
    put(out, channel);
    put_list(out, entries);
    end_record(out, begin);
}

}  // namespace plab::recording
