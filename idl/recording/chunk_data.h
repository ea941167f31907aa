/// A chunk of a file: decompressed, verified, and split into records.
#pragma once

#include <map>
#include <vector>

#include "idl/recording/compression.h"
#include "idl/recording/records.h"
#include "idl/recording/source.h"
#include "plab/result.h"

namespace plab::recording
{

/// Limits for what a reader accepts, whatever the file says.
struct Limits
{
    std::uint64_t chunk_bytes = 512u << 20;  ///< of one chunk, decompressed; all open chunks together may have twice that
    std::uint64_t record_bytes = 64u << 20;  ///< of one schema, channel or metadata record
    std::uint64_t attachment_bytes = 1u << 30;
};

/// Schemas and channels by id. Two with the same id must be equal.
struct Declarations
{
    std::map<std::uint16_t, Schema> schemas;
    std::map<ChannelId, Channel> channels;

    /// False: there is already a different one with this id, which is kept.
    bool add(const Schema& schema);
    bool add(const Channel& channel);
    /// No id has different meanings here and there.
    bool agrees_with(const Declarations& other) const;
};

class ChunkData
{
public:
    struct Entry
    {
        std::uint64_t log_time = 0;
        std::uint64_t offset = 0;  ///< of the body in records()
        std::uint64_t length = 0;
        ChannelId channel = 0;
    };

    /// Reads the chunk at `offset`. An error: it is incomplete, its CRC is wrong, or its parts are inconsistent; it then holds
    /// nothing. Errors name the byte of the file.
    Result<void> load(const Source& source, std::uint64_t offset, const Limits& limits);

    const ChunkHeader& header() const { return header_; }
    /// Of the whole record, including its head.
    std::uint64_t length() const { return length_; }
    bool has_crc() const { return header_.uncompressed_crc != 0; }
    ByteView records() const { return records_; }
    /// As they are in the file.
    ByteView stored() const { return compressed_; }
    /// In file order.
    const std::vector<Entry>& messages() const { return messages_; }
    const Declarations& declarations() const { return declarations_; }
    /// The message of an entry; its data are valid until this object is loaded again.
    Message message(const Entry& entry) const;
    /// Bytes of memory that its records take.
    std::size_t size() const { return records_.size(); }
    /// Whether the times in the header are correct. The header is not covered by the CRC.
    Result<void> check_times(std::uint64_t offset, std::uint64_t start_time, std::uint64_t end_time) const;

private:
    Result<void> load_compressed(const Source& source, std::uint64_t offset, const Limits& limits);
    Result<void> take_apart();
    Result<void> take_record(Opcode opcode, std::uint64_t at, ByteView body);
    void clear();

    ChunkHeader header_;
    std::uint64_t length_ = 0;
    Bytes compressed_;
    Bytes records_;
    std::vector<Entry> messages_;
    Declarations declarations_;
    Decompressor decompressor_;
};

}  // namespace plab::recording
