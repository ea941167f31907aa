/// The records of an MCAP file (https://mcap.dev/spec) as plain data.
///
/// Times are in ns: log_time on the recording's own time line, publish_time and create_time since 1970 (README.md).
/// Offsets count bytes from the start of the file. Text is UTF-8.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace plab::recording
{

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;
using Pairs = std::map<std::string, std::string>;
using ChannelId = std::uint16_t;

/// First and last bytes of every file; '0' is the major version.
inline constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
/// What stands before each record's body: its opcode and its length.
inline constexpr std::size_t kRecordHead = 1 + 8;

enum class Opcode : std::uint8_t
{
    Header = 0x01,
    Footer = 0x02,
    Schema = 0x03,
    Channel = 0x04,
    Message = 0x05,
    Chunk = 0x06,
    MessageIndex = 0x07,
    ChunkIndex = 0x08,
    Attachment = 0x09,
    AttachmentIndex = 0x0A,
    Statistics = 0x0B,
    Metadata = 0x0C,
    MetadataIndex = 0x0D,
    SummaryOffset = 0x0E,
    DataEnd = 0x0F,
};

struct Header
{
    std::string profile;
    std::string library;
};

/// Zero start: the file has no such section. Zero CRC: it was not computed.
struct Footer
{
    std::uint64_t summary_start = 0;
    std::uint64_t summary_offset_start = 0;
    std::uint32_t summary_crc = 0;
};
/// A footer with its record head, and the magic behind it: how a closed file ends.
inline constexpr std::size_t kFooterBody = 8 + 8 + 4;
inline constexpr std::size_t kFileEnd = kRecordHead + kFooterBody + kMagic.size();

struct Schema
{
    std::uint16_t id = 0;  ///< from 1
    std::string name;
    std::string encoding;
    std::string data;

    bool operator==(const Schema&) const = default;
};

struct Channel
{
    ChannelId id = 0;
    std::uint16_t schema_id = 0;  ///< 0: none
    std::string topic;
    std::string message_encoding;
    Pairs metadata;

    bool operator==(const Channel&) const = default;
};

struct Message
{
    ChannelId channel = 0;
    std::uint32_t sequence = 0;
    std::uint64_t log_time = 0;
    std::uint64_t publish_time = 0;
    ByteView data;  ///< owned by the caller
};

/// A chunk without its records.
struct ChunkHeader
{
    std::uint64_t start_time = 0;  ///< earliest log_time; both are zero in a chunk without messages
    std::uint64_t end_time = 0;
    std::uint64_t uncompressed_size = 0;
    std::uint32_t uncompressed_crc = 0;  ///< 0: was not computed
    std::string compression;             ///< "", "lz4", "zstd"
    std::uint64_t compressed_size = 0;   ///< bytes of records that follow
};

/// Where a chunk stands, and its message indexes behind it.
struct ChunkIndex
{
    std::uint64_t start_time = 0;
    std::uint64_t end_time = 0;
    std::uint64_t offset = 0;
    std::uint64_t length = 0;  ///< with its record head
    std::vector<std::pair<ChannelId, std::uint64_t>> message_indexes;
    std::uint64_t message_index_length = 0;
    std::string compression;
    std::uint64_t compressed_size = 0;
    std::uint64_t uncompressed_size = 0;
};

struct Attachment
{
    std::uint64_t log_time = 0;
    std::uint64_t create_time = 0;
    std::string name;
    std::string media_type;
    ByteView data;  ///< owned by the caller
};

struct AttachmentIndex
{
    std::uint64_t offset = 0;
    std::uint64_t length = 0;  ///< with its record head
    std::uint64_t log_time = 0;
    std::uint64_t create_time = 0;
    std::uint64_t data_size = 0;
    std::string name;
    std::string media_type;
};

struct Metadata
{
    std::string name;
    Pairs values;

    bool operator==(const Metadata&) const = default;
};

struct MetadataIndex
{
    std::uint64_t offset = 0;
    std::uint64_t length = 0;  ///< with its record head
    std::string name;
};

struct Statistics
{
    std::uint64_t messages = 0;
    std::uint16_t schemas = 0;
    std::uint32_t channels = 0;
    std::uint32_t attachments = 0;
    std::uint32_t metadata = 0;
    std::uint32_t chunks = 0;
    std::uint64_t start_time = 0;  ///< earliest log_time; both are zero if there are no messages
    std::uint64_t end_time = 0;
    std::map<ChannelId, std::uint64_t> channel_messages;

    bool operator==(const Statistics&) const = default;
};

struct SummaryOffset
{
    Opcode group = Opcode::Schema;
    std::uint64_t start = 0;
    std::uint64_t length = 0;
};

/// CRC of all bytes before this record; 0: was not computed.
struct DataEnd
{
    std::uint32_t data_crc = 0;
};

}  // namespace plab::recording
