#include "idl/recording/summary.h"

#include <algorithm>

#include "idl/recording/crc.h"
#include "idl/recording/encode.h"

namespace plab::recording
{
namespace
{

constexpr std::size_t kSummaryPiece = 64u << 10;

/// Appends to a sink, and keeps the CRC and the position.
class Tail
{
public:
    Tail(Sink& sink, std::uint64_t begin) : sink_(&sink), begin_(begin), at_(begin) {}

    Result<void> append(ByteView bytes)
    {
        crc_ = crc_onwards(crc_, bytes);
        at_ += bytes.size();
        return sink_->append(bytes);
    }
    /// Writes the records of one kind, and keeps their positions.
    template <class Record>
    Result<void> group(Opcode opcode, const std::vector<Record>& records)
    {
        Bytes bytes;
        for (const Record& record : records) recording::append(bytes, record);
        const std::uint64_t from = at_;
        auto done = append(bytes);
        note(opcode, from);
        return done;
    }
    void note(Opcode opcode, std::uint64_t from)
    {
        if (at_ > from) offsets_.push_back({opcode, from, at_ - from});
    }

    /// Summary offsets, footer and magic.
    Result<void> finish()
    {
        Bytes bytes;
        for (const SummaryOffset& offset : offsets_) recording::append(bytes, offset);
        Footer footer{offsets_.empty() ? 0 : begin_, offsets_.empty() ? 0 : at_, 0};
        const std::size_t footer_at = bytes.size();
        recording::append(bytes, footer);
        footer.summary_crc = crc_onwards(crc_, ByteView(bytes).first(bytes.size() - sizeof footer.summary_crc));
        bytes.resize(footer_at);
        recording::append(bytes, footer);
        put_bytes(bytes, kMagic);
        return sink_->append(bytes);
    }

    std::uint64_t at() const { return at_; }

private:
    Sink* sink_;
    std::uint64_t begin_;
    std::uint64_t at_;
    std::uint32_t crc_ = 0;
    std::vector<SummaryOffset> offsets_;
};

}  // namespace

Result<void> PackedRecords::add(const ChunkIndex& record)
{
    const std::size_t before = open_.size();
    append(open_, record);
    size_ += open_.size() - before;
    return open_.size() < kSummaryPiece ? Result<void>() : pack();
}

Result<void> PackedRecords::pack()
{
    Bytes packed;
    if (auto done = compressor_.compress(open_, packed); !done) return done;
    packed.shrink_to_fit();
    memory_ += packed.size();
    packed_.push_back({std::move(packed), open_.size()});
    open_.clear();
    return {};
}

Result<void> PackedRecords::each_piece(const std::function<Result<void>(ByteView)>& take) const
{
    Decompressor decompressor;
    Bytes bytes;
    for (const Piece& piece : packed_)
    {
        if (auto done = decompressor.decompress(Compression::Zstd, piece.bytes, piece.size, bytes); !done) return done;
        if (auto done = take(bytes); !done) return done;
    }
    return take(open_);
}

Result<void> Summary::add(const ChunkIndex& index, const ChunkContents& contents)
{
    const bool is_first = statistics_.messages == 0;
    ++statistics_.chunks;
    statistics_.messages += contents.total;
    for (const auto& [channel, count] : contents.messages) statistics_.channel_messages[channel] += count;
    if (contents.total > 0)
    {
        statistics_.start_time = is_first ? index.start_time : std::min(statistics_.start_time, index.start_time);
        statistics_.end_time = is_first ? index.end_time : std::max(statistics_.end_time, index.end_time);
    }
    if (has_index_ && chunks_.memory() > most_index_memory_)
    {
        has_index_ = false;
        chunks_ = PackedRecords();
    }
    return has_index_ ? chunks_.add(index) : Result<void>();
}

Statistics Summary::statistics() const
{
    Statistics out = statistics_;
    out.schemas = static_cast<std::uint16_t>(schemas_.size());
    out.channels = static_cast<std::uint32_t>(channels_.size());
    out.attachments = static_cast<std::uint32_t>(attachments_.size());
    out.metadata = static_cast<std::uint32_t>(metadata_.size());
    return out;
}

Result<void> Summary::write(Sink& sink, std::uint64_t begin) const
{
    Tail tail(sink, begin);
    // A summary without the index of chunks would look like a file without messages.
    if (!has_index_) return tail.finish();

    if (auto done = tail.group(Opcode::Schema, schemas_); !done) return done;
    if (auto done = tail.group(Opcode::Channel, channels_); !done) return done;
    if (auto done = tail.group(Opcode::Statistics, std::vector{statistics()}); !done) return done;
    const std::uint64_t chunks_at = tail.at();
    if (auto done = chunks_.each_piece([&](ByteView piece) { return tail.append(piece); }); !done) return done;
    tail.note(Opcode::ChunkIndex, chunks_at);
    if (auto done = tail.group(Opcode::AttachmentIndex, attachments_); !done) return done;
    if (auto done = tail.group(Opcode::MetadataIndex, metadata_); !done) return done;
    return tail.finish();
}

}  // namespace plab::recording
