/// Parses records. Every length is checked against the available bytes; data that does not fit is an error, never a guess.
/// Views in records point into the parsed bytes.
#pragma once

#include <optional>
#include <string_view>

#include "idl/recording/records.h"
#include "plab/result.h"

namespace plab::recording
{

/// Takes fields from the front of a record's body. After a failure all further fields are zero or empty.
class FieldReader
{
public:
    explicit FieldReader(ByteView bytes) : rest_(bytes) {}

    std::uint8_t u8() { return number<std::uint8_t>(); }
    std::uint16_t u16() { return number<std::uint16_t>(); }
    std::uint32_t u32() { return number<std::uint32_t>(); }
    std::uint64_t u64() { return number<std::uint64_t>(); }
    ByteView bytes(std::uint64_t n);
    /// A text, a map or an array, preceded by its length in bytes.
    ByteView counted() { return bytes(u32()); }

    /// Reads fields, each by its type; called by fields() of fields.h.
    template <class... Fields>
    void operator()(Fields&... all)
    {
        (one(all), ...);
    }

    ByteView rest() const { return rest_; }
    bool failed() const { return failed_; }
    void fail() { failed_ = true, rest_ = {}; }

private:
    template <class T>
    T number();
    void one(std::uint16_t& v) { v = u16(); }
    void one(std::uint32_t& v) { v = u32(); }
    void one(std::uint64_t& v) { v = u64(); }
    void one(std::string& v);
    void one(Pairs& v);
    void one(std::map<ChannelId, std::uint64_t>& v);
    void one(std::vector<std::pair<ChannelId, std::uint64_t>>& v);
    /// Calls `entry` with a reader as long as the list has entries.
    template <class Entry>
    void list(Entry&& entry);

    ByteView rest_;
    bool failed_ = false;
};

/// "byte 4711: why": an error about a position in a file.
Error damage(std::uint64_t offset, const std::string& why);
/// "Chunk", or "0x85" for an opcode without a name.
std::string name_of(Opcode opcode);

/// The head before a body.
struct RecordHead
{
    Opcode opcode = Opcode::Header;
    std::uint64_t length = 0;  ///< of the body
};
/// `bytes`: kRecordHead of them.
RecordHead parse_head(ByteView bytes);

// Parse bodies, without their head. Empty: a field extends beyond the body, or its value is invalid. Fields that a later
// version of the format added at the end are ignored, as the format demands.
std::optional<Header> parse_header(ByteView body);
std::optional<Footer> parse_footer(ByteView body);
std::optional<Schema> parse_schema(ByteView body);
std::optional<Channel> parse_channel(ByteView body);
std::optional<Message> parse_message(ByteView body);
/// Into a record whose memory is reused, since files have a million of these.
bool parse_chunk_index(ByteView body, ChunkIndex& out);
std::optional<AttachmentIndex> parse_attachment_index(ByteView body);
std::optional<Statistics> parse_statistics(ByteView body);
std::optional<Metadata> parse_metadata(ByteView body);
std::optional<MetadataIndex> parse_metadata_index(ByteView body);
std::optional<DataEnd> parse_data_end(ByteView body);

struct ParsedAttachment
{
    Attachment attachment;
    bool crc_is_right = false;
    bool has_crc = false;
};
std::optional<ParsedAttachment> parse_attachment(ByteView body);

/// The head of a chunk, from the available part of its body; `body_length`: length of the whole body. Empty if the parts do not
/// add up to body_length.
std::optional<ChunkHeader> parse_chunk_header(ByteView head, std::uint64_t body_length);
/// Bytes of a chunk's body before its records.
std::size_t size_of_head(const ChunkHeader& header);
/// Longest accepted name of a compression.
inline constexpr std::size_t kLongestCompression = 16;
/// Number of bytes that is enough for parse_chunk_header.
inline constexpr std::size_t kLongestChunkHead = 8 + 8 + 8 + 4 + 4 + kLongestCompression + 8;

/// The head of a message index; the whole index has 6 + 16 * messages bytes.
struct MessageIndexHead
{
    ChannelId channel = 0;
    std::uint64_t messages = 0;
};
std::optional<MessageIndexHead> parse_message_index_head(ByteView head, std::uint64_t body_length);

}  // namespace plab::recording
