/// A chunk out of a file: decompressed, checked, taken apart.
#pragma once

#include <map>
#include <vector>

#include "idl/recording/compression.h"
#include "idl/recording/records.h"
#include "idl/recording/source.h"
#include "plab/result.h"

namespace plab::recording
{

/// What a reader takes from a file at the most, whatever the file says.
struct Limits
{
    std::uint64_t chunk_bytes = 512u << 20;  ///< of one chunk, decompressed; all open chunks together: twice that
    std::uint64_t record_bytes = 64u << 20;  ///< of one schema, channel or metadata record
    std::uint64_t attachment_bytes = 1u << 30;
};

/// Schemas and channels by id. Two of one id must be alike.
struct Declarations
{
    std::map<std::uint16_t, Schema> schemas;
    std::map<ChannelId, Channel> channels;

    /// False: there is another one of this id already, which stays.
    bool add(const Schema& schema);
    bool add(const Channel& channel);
    /// No id stands for one thing here and for another there.
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

    /// Reads the chunk at `offset`. An error: it is not all there, its CRC is wrong, its parts do not fit together; it
    /// holds nothing then. Errors say at which byte of the file.
    Result<void> load(const Source& source, std::uint64_t offset, const Limits& limits);

    const ChunkHeader& header() const { return header_; }
    /// Of the whole record, with its head.
    std::uint64_t length() const { return length_; }
    bool has_crc() const { return header_.uncompressed_crc != 0; }
    ByteView records() const { return records_; }
    /// As they are in the file.
    ByteView stored() const { return compressed_; }
    /// In file order.
    const std::vector<Entry>& messages() const { return messages_; }
    const Declarations& declarations() const { return declarations_; }
    /// The message of an entry; its data lives as long as this is not loaded again.
    Message message(const Entry& entry) const;
    /// Bytes of memory that its records take.
    std::size_t size() const { return records_.size(); }
    /// Whether what is said of its times is right. What the header says of them stands outside of what its CRC covers.
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
