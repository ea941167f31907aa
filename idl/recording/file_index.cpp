#include "idl/recording/file_index.h"

#include <algorithm>

#include "idl/recording/crc.h"
#include "idl/recording/parse.h"

namespace plab::recording
{
namespace
{

constexpr std::size_t kPiece = 64u << 10;

/// Reads the records of a summary into an index.
class SummaryReader
{
public:
    SummaryReader(const Source& source, const Limits& limits) : source_(&source), limits_(limits) {}

    Result<FileIndex> read(std::uint64_t begin, std::uint64_t end)
    {
        Window window(*source_);
        for (std::uint64_t at = begin; at < end;)
        {
            auto bytes = window.exactly(at, kRecordHead);
            if (!bytes) return bytes.errors();
            const RecordHead head = parse_head(*bytes);
            if (head.length > end - at - kRecordHead) return damage(at, name_of(head.opcode) + " record extends beyond the summary");
            if (auto done = take(window, at, head); !done) return done.errors();
            at += kRecordHead + head.length;
        }
        index_.sort_chunks();
        index_.has_summary = true;
        return std::move(index_);
    }

private:
    Result<void> take(Window& window, std::uint64_t at, const RecordHead& head)
    {
        if (head.length > limits_.record_bytes) return damage(at, name_of(head.opcode) + " record is larger than the limit");
        const bool is_short = head.length <= Window::kMost;
        if (!is_short) long_body_.resize(head.length);
        ByteView body(long_body_);
        if (is_short)
        {
            auto view = window.exactly(at + kRecordHead, head.length);
            if (!view) return view.errors();
            body = *view;
        }
        else if (auto done = source_->read(at + kRecordHead, long_body_); !done)
            return done.errors();
        if (!take_body(head.opcode, body)) return damage(at, name_of(head.opcode) + " record of the summary is damaged");
        return {};
    }

    bool take_body(Opcode opcode, ByteView body)
    {
        switch (opcode)
        {
            case Opcode::Schema:
                if (const auto r = parse_schema(body)) return index_.declarations.add(*r);
                return false;
            case Opcode::Channel:
                if (const auto r = parse_channel(body)) return index_.declarations.add(*r);
                return false;
            case Opcode::Statistics:
                return keep(parse_statistics(body), [&](Statistics r) { index_.statistics = std::move(r); });
            case Opcode::ChunkIndex:
                if (!parse_chunk_index(body, chunk_)) return false;
                add(chunk_);
                return true;
            case Opcode::AttachmentIndex:
                return keep(parse_attachment_index(body), [&](AttachmentIndex r) { index_.attachments.push_back(std::move(r)); });
            case Opcode::MetadataIndex:
                return keep(parse_metadata_index(body), [&](MetadataIndex r) { index_.metadata.push_back(std::move(r)); });
            default:
                return true;  // summary offsets serve readers that read only a part; other records are of later versions
        }
    }

    template <class Record, class Keep>
    static bool keep(std::optional<Record> record, Keep&& keeper)
    {
        if (!record) return false;
        keeper(std::move(*record));
        return true;
    }

    void add(const ChunkIndex& chunk)
    {
        channels_.clear();
        for (const auto& [channel, offset] : chunk.message_indexes) channels_.push_back(channel);
        std::sort(channels_.begin(), channels_.end());
        index_.chunks.push_back({chunk.start_time, chunk.end_time, chunk.offset, chunk.compressed_size, chunk.uncompressed_size,
                                 index_.channel_sets.number_of(channels_)});
    }

    const Source* source_;
    Limits limits_;
    FileIndex index_;
    Bytes long_body_;
    ChunkIndex chunk_;
    ChannelSet channels_;
};

}  // namespace

std::uint32_t ChannelSets::number_of(const ChannelSet& channels)
{
    const auto [found, is_new] = numbers_.try_emplace(channels, static_cast<std::uint32_t>(sets_.size()));
    if (is_new) sets_.push_back(channels);
    return found->second;
}

bool FileIndex::may_hold(const ChunkPlace& chunk, const std::set<ChannelId>& wanted) const
{
    const ChannelSet& there = channel_sets.at(chunk.channels);
    const auto is_there = [&](ChannelId channel) { return std::binary_search(there.begin(), there.end(), channel); };
    return there.empty() || std::any_of(wanted.begin(), wanted.end(), is_there);
}

void FileIndex::sort_chunks()
{
    const auto before = [](const ChunkPlace& a, const ChunkPlace& b)
    { return std::pair(a.start_time, a.offset) < std::pair(b.start_time, b.offset); };
    std::sort(chunks.begin(), chunks.end(), before);
    latest_before.clear();
    std::uint64_t latest = 0;
    for (const ChunkPlace& chunk : chunks) latest_before.push_back(latest = std::max(latest, chunk.end_time));
}

Result<std::uint32_t> crc_of_range(const Source& source, std::uint64_t begin, std::uint64_t end)
{
    Bytes bytes;
    std::uint32_t crc = 0;
    for (std::uint64_t at = begin; at < end; at += bytes.size())
    {
        bytes.resize(std::min<std::uint64_t>(kPiece, end - at));
        auto done = source.read(at, bytes);
        if (!done) return done.errors();
        if (*done < bytes.size()) return damage(at, "the file ends here");
        crc = crc_onwards(crc, bytes);
    }
    return crc;
}

Result<FileStart> read_start(const Source& source, const Limits& limits)
{
    Bytes start(kMagic.size() + kRecordHead);
    auto got = source.read(0, start);
    if (!got) return got.errors();
    if (*got < start.size() || !std::equal(kMagic.begin(), kMagic.end(), start.begin()))
        return reason(*got == 0 ? "is empty" : "is not an MCAP file: it does not begin with the magic bytes");
    const RecordHead head = parse_head(ByteView(start).subspan(kMagic.size()));
    if (head.opcode != Opcode::Header || head.length > limits.record_bytes) return damage(kMagic.size(), "a Header record is missing here");
    Bytes body(head.length);
    got = source.read(start.size(), body);
    if (!got) return got.errors();
    const auto header = parse_header(ByteView(body).first(*got));
    if (!header || *got < body.size()) return damage(kMagic.size(), "the Header record is truncated or damaged");
    return FileStart{*header, start.size() + body.size()};
}

Result<std::optional<Footer>> read_footer(const Source& source)
{
    auto size = source.size();
    if (!size) return size.errors();
    if (*size < kFileEnd) return std::optional<Footer>();
    Bytes end(kFileEnd);
    auto got = source.read(*size - kFileEnd, end);
    if (!got) return got.errors();
    const RecordHead head = parse_head(end);
    const ByteView magic = ByteView(end).last(kMagic.size());
    const bool is_footer = *got == end.size() && head.opcode == Opcode::Footer && head.length == kFooterBody &&
                           std::equal(magic.begin(), magic.end(), kMagic.begin());
    if (!is_footer) return std::optional<Footer>();
    return parse_footer(ByteView(end).subspan(kRecordHead, kFooterBody));
}

Result<FileIndex> read_summary(const Source& source, const Footer& footer, const Limits& limits)
{
    auto size = source.size();
    if (!size) return size.errors();
    const std::uint64_t end = *size - kFileEnd;
    if (footer.summary_start == 0) return reason("there is no summary");
    const bool has_offsets = footer.summary_offset_start != 0;
    if (footer.summary_start < kMagic.size() || footer.summary_start > end ||
        (has_offsets && (footer.summary_offset_start < footer.summary_start || footer.summary_offset_start > end)))
        return damage(end, "the footer names a summary outside of the file");
    if (footer.summary_crc != 0)
    {
        auto crc = crc_of_range(source, footer.summary_start, end + kRecordHead + kFooterBody - sizeof footer.summary_crc);
        if (!crc) return crc.errors();
        if (*crc != footer.summary_crc) return damage(footer.summary_start, "the CRC of the summary is wrong: its bytes have changed");
    }
    return SummaryReader(source, limits).read(footer.summary_start, has_offsets ? footer.summary_offset_start : end);
}

}  // namespace plab::recording
