#include "idl/recording/parse.h"

#include <array>
#include <bit>
#include <cstring>

#include "idl/recording/crc.h"
#include "idl/recording/fields.h"

namespace plab::recording
{
namespace
{

static_assert(std::endian::native == std::endian::little, "numbers are copied byte for byte");

/// The record, unless a field was missing.
template <class T>
std::optional<T> unless_failed(const FieldReader& in, T record)
{
    if (in.failed()) return std::nullopt;
    return record;
}

template <class Record>
std::optional<Record> parse_fields(ByteView body)
{
    FieldReader in(body);
    Record out;
    fields(in, out);
    return unless_failed(in, std::move(out));
}

}  // namespace

template <class T>
T FieldReader::number()
{
    T v{};
    if (rest_.size() < sizeof v)
    {
        fail();
        return v;
    }
    std::memcpy(&v, rest_.data(), sizeof v);
    rest_ = rest_.subspan(sizeof v);
    return v;
}

ByteView FieldReader::bytes(std::uint64_t n)
{
    if (n > rest_.size())
    {
        fail();
        return {};
    }
    const ByteView taken = rest_.first(n);
    rest_ = rest_.subspan(n);
    return taken;
}

template <class Entry>
void FieldReader::list(Entry&& entry)
{
    FieldReader in(counted());
    while (!in.failed() && !in.rest().empty()) entry(in);
    if (in.failed()) fail();
}

void FieldReader::one(std::string& v)
{
    const ByteView view = counted();
    v.assign(view.begin(), view.end());
}

void FieldReader::one(Pairs& v)
{
    list(
        [&](FieldReader& in)
        {
            std::string key, value;
            in(key, value);
            v.insert_or_assign(std::move(key), std::move(value));
        });
}

void FieldReader::one(std::map<ChannelId, std::uint64_t>& v)
{
    list(
        [&](FieldReader& in)
        {
            const ChannelId channel = in.u16();
            v[channel] = in.u64();
        });
}

void FieldReader::one(std::vector<std::pair<ChannelId, std::uint64_t>>& v)
{
    v.clear();
    list(
        [&](FieldReader& in)
        {
            const ChannelId channel = in.u16();
            v.emplace_back(channel, in.u64());
        });
}

Error damage(std::uint64_t offset, const std::string& why) { return reason("byte " + std::to_string(offset) + ": " + why); }

std::string name_of(Opcode opcode)
{
    constexpr std::array kNames{"Header",     "Footer",       "Schema",        "Channel",       "Message",
                                "Chunk",      "MessageIndex", "ChunkIndex",    "Attachment",    "AttachmentIndex",
                                "Statistics", "Metadata",     "MetadataIndex", "SummaryOffset", "DataEnd"};
    const auto number = static_cast<std::size_t>(opcode);
    if (number >= 1 && number <= kNames.size()) return kNames[number - 1];
    constexpr std::string_view kDigits = "0123456789abcdef";
    return std::string("0x") + kDigits[number >> 4] + kDigits[number & 15];
}

RecordHead parse_head(ByteView bytes)
{
    FieldReader in(bytes);
    const auto opcode = static_cast<Opcode>(in.u8());
    return {opcode, in.u64()};
}

std::optional<Header> parse_header(ByteView body) { return parse_fields<Header>(body); }
std::optional<Footer> parse_footer(ByteView body) { return parse_fields<Footer>(body); }
std::optional<Channel> parse_channel(ByteView body) { return parse_fields<Channel>(body); }
std::optional<AttachmentIndex> parse_attachment_index(ByteView body) { return parse_fields<AttachmentIndex>(body); }
std::optional<Statistics> parse_statistics(ByteView body) { return parse_fields<Statistics>(body); }
std::optional<Metadata> parse_metadata(ByteView body) { return parse_fields<Metadata>(body); }
std::optional<MetadataIndex> parse_metadata_index(ByteView body) { return parse_fields<MetadataIndex>(body); }
std::optional<DataEnd> parse_data_end(ByteView body) { return parse_fields<DataEnd>(body); }

std::optional<Schema> parse_schema(ByteView body)
{
    auto out = parse_fields<Schema>(body);
    if (out && out->id == 0) return std::nullopt;
    return out;
}

std::optional<Message> parse_message(ByteView body)
{
    FieldReader in(body);
    Message out;
    fields(in, out);
    out.data = in.rest();
    return unless_failed(in, out);
}

bool parse_chunk_index(ByteView body, ChunkIndex& out)
{
    FieldReader in(body);
    fields(in, out);
    return !in.failed() && out.start_time <= out.end_time;
}

std::optional<ParsedAttachment> parse_attachment(ByteView body)
{
    FieldReader in(body);
    ParsedAttachment out;
    fields(in, out.attachment);
    out.attachment.data = in.bytes(in.u64());
    const std::size_t covered = body.size() - in.rest().size();
    const std::uint32_t crc = in.u32();
    if (in.failed()) return std::nullopt;
    out.has_crc = crc != 0;
    out.crc_is_right = !out.has_crc || crc == crc_of(body.first(covered));
    return out;
}

std::optional<ChunkHeader> parse_chunk_header(ByteView head, std::uint64_t body_length)
{
    FieldReader in(head);
    ChunkHeader out;
    fields(in, out);
    if (in.failed() || out.compression.size() > kLongestCompression || out.start_time > out.end_time) return std::nullopt;
    const std::size_t head_size = size_of_head(out);
    if (body_length < head_size || out.compressed_size != body_length - head_size) return std::nullopt;
    return out;
}

std::size_t size_of_head(const ChunkHeader& header) { return 8 + 8 + 8 + 4 + 4 + header.compression.size() + 8; }

std::optional<MessageIndexHead> parse_message_index_head(ByteView head, std::uint64_t body_length)
{
    constexpr std::uint64_t kEntry = 16;
    FieldReader in(head);
    MessageIndexHead out;
    out.channel = in.u16();
    const std::uint32_t length = in.u32();
    if (in.failed() || body_length != 6u + std::uint64_t{length} || length % kEntry != 0) return std::nullopt;
    out.messages = length / kEntry;
    return out;
}

}  // namespace plab::recording
