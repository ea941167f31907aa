/// Collects the records of one chunk, and writes the chunk with its message indexes.
#pragma once

#include <vector>

#include "idl/recording/chunk_data.h"
#include "idl/recording/compression.h"
#include "idl/recording/encode.h"
#include "idl/recording/records.h"

namespace plab::recording
{

/// The contents of a chunk: messages by channel, in order of channel ids, and their times.
struct ChunkContents
{
    std::vector<std::pair<ChannelId, std::uint64_t>> messages;
    std::uint64_t total = 0;
    std::uint64_t start_time = 0;
    std::uint64_t end_time = 0;
};

/// Keeps its memory when it is cleared.
class ChunkBuilder
{
public:
    void add(const Schema& schema) { append(records_, schema); }
    void add(const Channel& channel) { append(records_, channel); }
    void add(const Message& message);
    void clear();

    bool empty() const { return records_.empty(); }
    std::size_t size() const { return records_.size(); }
    ByteView records() const { return records_; }
    std::uint64_t messages() const { return contents_.total; }
    /// Sorts the channels; call it when the chunk is complete.
    const ChunkContents& contents();

    /// Copies the contents of another chunk.
    void copy(const ChunkData& chunk);

    /// Appends the chunk and its message indexes. The index's offsets count from the start of the chunk in `out`.
    Result<ChunkIndex> write(Bytes& out, Compressor& compressor);
    /// As above; `stored` are the records as they were compressed before.
    ChunkIndex write_stored(Bytes& out, ByteView stored, Compression compression);

private:
    void note(ChannelId channel, std::uint64_t log_time, std::uint64_t offset);

    Bytes records_;
    Bytes compressed_;
    std::vector<MessageTimes> times_;  ///< by channel id
    ChunkContents contents_;           ///< channels in the order of their first message, until contents() sorts them
};

}  // namespace plab::recording
