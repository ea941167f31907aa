#include "idl/recording/chunk_data.h"

#include <algorithm>

#include "idl/recording/crc.h"
#include "idl/recording/parse.h"

namespace plab::recording
{
namespace
{

/// An error that concerns the chunk at `offset`.
Error of_chunk(std::uint64_t offset, const std::string& why) { return damage(offset, "Chunk: " + why); }

}  // namespace

bool Declarations::add(const Schema& schema) { return schemas.try_emplace(schema.id, schema).first->second == schema; }

bool Declarations::add(const Channel& channel) { return channels.try_emplace(channel.id, channel).first->second == channel; }

bool Declarations::agrees_with(const Declarations& other) const
{
    const auto agree = [](const auto& mine, const auto& others)
    {
        const auto is_same = [&](const auto& record)
        {
            const auto found = others.find(record.first);
            return found == others.end() || found->second == record.second;
        };
        return std::all_of(mine.begin(), mine.end(), is_same);
    };
    return agree(schemas, other.schemas) && agree(channels, other.channels);
}

void ChunkData::clear()
{
    header_ = {};
    length_ = 0;
    records_.clear();
    messages_.clear();
    declarations_ = {};
}

Result<void> ChunkData::load(const Source& source, std::uint64_t offset, const Limits& limits)
{
    clear();
    auto done = load_compressed(source, offset, limits);
    if (done)
    {
        const auto compression = compression_of(header_.compression);
        if (!compression)
            done = reason("compression \"" + header_.compression + "\" is unknown; \"\", \"lz4\" and \"zstd\" are read");
        else
            done = decompressor_.decompress(*compression, compressed_, header_.uncompressed_size, records_);
    }
    if (done && has_crc() && crc_of(records_) != header_.uncompressed_crc) done = reason("its CRC is wrong: its bytes have changed");
    if (done) done = take_apart();
    if (done) return {};
    clear();
    return of_chunk(offset, done.error().reason);
}

Result<void> ChunkData::load_compressed(const Source& source, std::uint64_t offset, const Limits& limits)
{
    Bytes beginning(kRecordHead + kLongestChunkHead);
    auto got = source.read(offset, beginning);
    if (!got) return got.errors();
    beginning.resize(*got);
    if (beginning.size() < kRecordHead) return reason("the file ends here");
    const RecordHead head = parse_head(beginning);
    if (head.opcode != Opcode::Chunk) return reason("a " + name_of(head.opcode) + " record is here");
    auto size = source.size();
    if (!size) return size.errors();
    if (head.length > *size - offset - kRecordHead) return reason("the file ends within it");

    const ByteView body = ByteView(beginning).subspan(kRecordHead);
    const auto header = parse_chunk_header(body.first(std::min<std::uint64_t>(body.size(), head.length)), head.length);
    if (!header) return reason("its header does not fit its length");
    if (header->uncompressed_size > limits.chunk_bytes || header->compressed_size > limits.chunk_bytes)
        return reason("larger than " + std::to_string(limits.chunk_bytes) + " bytes, which is the limit");
    header_ = *header;
    length_ = kRecordHead + head.length;
    compressed_.resize(header_.compressed_size);
    auto read = source.read(offset + kRecordHead + size_of_head(header_), compressed_);
    if (!read) return read.errors();
    return *read == compressed_.size() ? Result<void>() : reason("the file ends within it");
}

Result<void> ChunkData::take_apart()
{
    FieldReader in(records_);
    while (!in.rest().empty())
    {
        const std::uint64_t at = records_.size() - in.rest().size();
        const RecordHead head = parse_head(in.bytes(kRecordHead));
        const ByteView body = in.bytes(head.length);
        if (in.failed()) return reason("record " + std::to_string(at) + " extends beyond its end");
        if (auto done = take_record(head.opcode, at, body); !done) return done;
    }
    return {};
}

Result<void> ChunkData::take_record(Opcode opcode, std::uint64_t at, ByteView body)
{
    const auto bad = [&](const char* what) { return reason(name_of(opcode) + " record " + std::to_string(at) + " " + what); };
    if (opcode == Opcode::Message)
    {
        const auto message = parse_message(body);
        if (!message) return bad("is too short");
        messages_.push_back({message->log_time, at + kRecordHead, body.size(), message->channel});
    }
    else if (opcode == Opcode::Schema)
    {
        const auto schema = parse_schema(body);
        if (!schema) return bad("is too short");
        if (!declarations_.add(*schema)) return bad("contradicts another one of its id");
    }
    else if (opcode == Opcode::Channel)
    {
        const auto channel = parse_channel(body);
        if (!channel) return bad("is too short");
        if (!declarations_.add(*channel)) return bad("contradicts another one of its id");
    }
    else if (opcode <= Opcode::DataEnd)
        return bad("is not allowed in a chunk");
    return {};  // a record of a later version, or a private one
}

Message ChunkData::message(const Entry& entry) const
{
    return parse_message(ByteView(records_).subspan(entry.offset, entry.length)).value_or(Message{});
}

Result<void> ChunkData::check_times(std::uint64_t offset, std::uint64_t start_time, std::uint64_t end_time) const
{
    const auto earlier = [](const Entry& a, const Entry& b) { return a.log_time < b.log_time; };
    const auto [first, last] = std::minmax_element(messages_.begin(), messages_.end(), earlier);
    const bool is_empty = messages_.empty();
    if (start_time == (is_empty ? 0 : first->log_time) && end_time == (is_empty ? 0 : last->log_time)) return {};
    return of_chunk(offset, "its header, or the index, gives other times than its messages");
}

}  // namespace plab::recording
