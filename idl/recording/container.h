/// Writes a file record by record: appends to a sink, and keeps the position of each record. Used by writers and by copies.
#pragma once

#include <memory>

#include "idl/recording/chunk_builder.h"
#include "idl/recording/records.h"
#include "idl/recording/sink.h"
#include "idl/recording/summary.h"
#include "plab/result.h"

namespace plab::recording
{

/// After a failed append, the end of the file is undefined: everything is refused until repair() has truncated it.
class Container
{
public:
    /// Writes magic and header.
    static Result<Container> begin(std::unique_ptr<Sink> sink, const Header& header, std::size_t most_index_memory);

    /// For the summary. Schemas and channels that messages refer to must also be in a chunk, before these messages.
    void declare(const Schema& schema) { summary_.add(schema); }
    void declare(const Channel& channel) { summary_.add(channel); }

    /// A chunk with its message indexes, as ChunkBuilder::write() made them; `index` counts from the start of `bytes`.
    Result<void> put_chunk(ByteView bytes, ChunkIndex index, const ChunkContents& contents);
    Result<void> put(const Attachment& attachment);
    Result<void> put(const Metadata& metadata);

    /// Until finish(), and not after a move.
    bool is_open() const { return sink_ != nullptr; }
    /// Truncates what a failed append left.
    Result<void> repair();
    /// Flushes the appended data to the disk.
    Result<void> sync() { return sink_->sync(); }
    /// Writes the end of data, summary and footer; closes the sink. If that fails, everything written before stays readable.
    Result<void> finish();

    /// Bytes that are certainly in the file.
    std::uint64_t size() const { return size_; }
    /// Statistics of the data that are certainly in the file.
    Statistics statistics() const { return summary_.statistics(); }
    std::uint64_t messages() const { return summary_.messages(); }

private:
    Container(std::unique_ptr<Sink> sink, std::size_t most_index_memory) : sink_(std::move(sink)), summary_(most_index_memory) {}
    Result<void> append_whole(ByteView bytes);
    Result<void> write_end();

    std::unique_ptr<Sink> sink_;
    Summary summary_;
    Bytes scratch_;
    std::uint64_t size_ = 0;
    std::uint32_t crc_ = 0;
    bool is_damaged_ = false;
};

}  // namespace plab::recording
