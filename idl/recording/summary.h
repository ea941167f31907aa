/// The last section of a file: collected while the file grows, written when it is closed.
#pragma once

#include <functional>
#include <vector>

#include "idl/recording/chunk_builder.h"
#include "idl/recording/compression.h"
#include "idl/recording/records.h"
#include "idl/recording/sink.h"
#include "plab/result.h"

namespace plab::recording
{

/// Many small records of one kind, compressed incrementally: a hundred bytes each in the file, a fifth of that here.
class PackedRecords
{
public:
    Result<void> add(const ChunkIndex& record);
    /// Bytes of all records in the file.
    std::uint64_t size() const { return size_; }
    /// Bytes of memory that they take.
    std::size_t memory() const { return memory_ + open_.size(); }
    /// Passes on all records, in order, in batches.
    Result<void> each_piece(const std::function<Result<void>(ByteView)>& take) const;

private:
    struct Piece
    {
        Bytes bytes;
        std::uint64_t size = 0;
    };
    Result<void> pack();

    std::vector<Piece> packed_;
    Bytes open_;
    std::uint64_t size_ = 0;
    std::size_t memory_ = 0;
    Compressor compressor_{Compression::Zstd, 3};
};

class Summary
{
public:
    /// Beyond `most_index_memory` bytes the index is dropped and the file gets no summary: readers scan it.
    explicit Summary(std::size_t most_index_memory) : most_index_memory_(most_index_memory) {}

    void add(const Schema& schema) { schemas_.push_back(schema); }
    void add(const Channel& channel) { channels_.push_back(channel); }
    void add(const AttachmentIndex& index) { attachments_.push_back(index); }
    void add(const MetadataIndex& index) { metadata_.push_back(index); }
    Result<void> add(const ChunkIndex& index, const ChunkContents& contents);

    Statistics statistics() const;
    std::uint64_t messages() const { return statistics_.messages; }
    /// Writes summary, summary offsets, footer and closing magic; `begin`: where they start in the file.
    Result<void> write(Sink& sink, std::uint64_t begin) const;

private:
    std::vector<Schema> schemas_;
    std::vector<Channel> channels_;
    std::vector<AttachmentIndex> attachments_;
    std::vector<MetadataIndex> metadata_;
    PackedRecords chunks_;
    Statistics statistics_;  ///< of chunks and messages; the rest is counted when it is asked for
    std::size_t most_index_memory_;
    bool has_index_ = true;
};

}  // namespace plab::recording
