#include "idl/recording/chunk_builder.h"

#include <algorithm>

#include "idl/recording/crc.h"

namespace plab::recording
{

void ChunkBuilder::add(const Message& message)
{
    note(message.channel, message.log_time, records_.size());
    append(records_, message);
}

void ChunkBuilder::copy(const ChunkData& chunk)
{
    clear();
    records_.assign(chunk.records().begin(), chunk.records().end());
    for (const auto& entry : chunk.messages()) note(entry.channel, entry.log_time, entry.offset - kRecordHead);
}

void ChunkBuilder::note(ChannelId channel, std::uint64_t log_time, std::uint64_t offset)
{
    if (times_.size() <= channel) times_.resize(channel + 1u);
    MessageTimes& times = times_[channel];
    if (times.empty()) contents_.messages.emplace_back(channel, 0);
    times.emplace_back(log_time, offset);

    const bool is_first = contents_.total == 0;
    contents_.start_time = is_first ? log_time : std::min(contents_.start_time, log_time);
    contents_.end_time = is_first ? log_time : std::max(contents_.end_time, log_time);
    ++contents_.total;
}

void ChunkBuilder::clear()
{
    for (const auto& [channel, count] : contents_.messages) times_[channel].clear();
    contents_.messages.clear();
    contents_.total = contents_.start_time = contents_.end_time = 0;
    records_.clear();
}

const ChunkContents& ChunkBuilder::contents()
{
    std::sort(contents_.messages.begin(), contents_.messages.end());
    for (auto& [channel, count] : contents_.messages) count = times_[channel].size();
    return contents_;
}

Result<ChunkIndex> ChunkBuilder::write(Bytes& out, Compressor& compressor)
{
    if (compressor.compression() == Compression::None) return write_stored(out, records_, Compression::None);
    if (auto done = compressor.compress(records_, compressed_); !done) return done.errors();
    // If compression does not reduce the size, the data are stored uncompressed.
    if (compressed_.size() >= records_.size()) return write_stored(out, records_, Compression::None);
    return write_stored(out, compressed_, compressor.compression());
}

ChunkIndex ChunkBuilder::write_stored(Bytes& out, ByteView stored, Compression compression)
{
    ChunkIndex index;
    index.start_time = contents_.start_time;
    index.end_time = contents_.end_time;
    index.compression = name_of(compression);
    index.compressed_size = stored.size();
    index.uncompressed_size = records_.size();
    const std::size_t begin = out.size();
    append_chunk(out,
                 {index.start_time, index.end_time, index.uncompressed_size, crc_of(records_), index.compression, index.compressed_size},
                 stored);
    index.length = out.size() - begin;
    for (const auto& [channel, count] : contents().messages)
    {
        index.message_indexes.emplace_back(channel, out.size() - begin);
        append_message_index(out, channel, times_[channel]);
    }
    index.message_index_length = out.size() - begin - index.length;
    return index;
}

}  // namespace plab::recording
