// Where everything is in a file: from its summary, or by a scan of the records if there is no complete one.
#include "idl/recording/file_index.h"

#include <algorithm>

#include "idl/recording/parse.h"

namespace plab::recording
{
namespace
{

class Scan
{
public:
    Scan(const Source& source, const Limits& limits) : source_(&source), limits_(limits), window_(source) {}

    Result<FileIndex> run(std::uint64_t begin)
    {
        auto size = source_->size();
        if (!size) return size.errors();
        std::uint64_t at = begin;
        while (!index_.is_closed && *size - at >= kRecordHead)
        {
            auto head = head_at(at);
            if (!head) return head.errors();
            if (head->length > *size - at - kRecordHead) break;  // truncated
            if (auto done = take(at, *head); !done)
            {
                index_.troubles.push_back(done.error());
                break;
            }
            at += kRecordHead + head->length;
        }
        end_chunk();
        declare_unknown();
        count();
        index_.sort_chunks();
        return std::move(index_);
    }

private:
    Result<RecordHead> head_at(std::uint64_t at)
    {
        auto bytes = window_.exactly(at, kRecordHead);
        if (!bytes) return bytes.errors();
        return parse_head(*bytes);
    }

    /// The first bytes of a body, at most `most`.
    Result<ByteView> beginning(std::uint64_t at, const RecordHead& head, std::size_t most)
    {
        return window_.exactly(at + kRecordHead, std::min<std::uint64_t>(head.length, most));
    }

    Result<void> take(std::uint64_t at, const RecordHead& head)
    {
        if (head.opcode != Opcode::MessageIndex) end_chunk();
        switch (head.opcode)
        {
            case Opcode::Chunk:
                return take_chunk(at, head);
            case Opcode::MessageIndex:
                return take_message_index(at, head);
            case Opcode::Attachment:
                return take_attachment(at, head);
            case Opcode::Schema:
            case Opcode::Channel:
            case Opcode::Metadata:
                return take_short(at, head);
            case Opcode::DataEnd:
                index_.is_closed = true;
                return {};
            case Opcode::Message:
                return damage(at, "a message outside of a chunk; only files with chunks are read");
            default:
                if (head.opcode > Opcode::DataEnd) return {};  // a record of a later version, or a private one
                return damage(at, "a " + name_of(head.opcode) + " record is not allowed here");
        }
    }

    Result<void> take_chunk(std::uint64_t at, const RecordHead& head)
    {
        auto bytes = beginning(at, head, kLongestChunkHead);
        if (!bytes) return bytes.errors();
        const auto header = parse_chunk_header(*bytes, head.length);
        if (!header) return damage(at, "the header of a Chunk record does not fit its length");
        chunk_ = ChunkPlace{header->start_time, header->end_time, at, header->compressed_size, header->uncompressed_size, 0};
        return {};
    }

    Result<void> take_message_index(std::uint64_t at, const RecordHead& head)
    {
        auto bytes = beginning(at, head, 6);
        if (!bytes) return bytes.errors();
        const auto index = parse_message_index_head(*bytes, head.length);
        if (!index || !chunk_) return damage(at, "a MessageIndex record is damaged, or follows no chunk");
        chunk_channels_.insert(index->channel);
        index_.statistics.channel_messages[index->channel] += index->messages;
        return {};
    }

    /// The message indexes follow their chunk: now they are complete.
    void end_chunk()
    {
        if (!chunk_) return;
        chunk_->channels = index_.channel_sets.number_of({chunk_channels_.begin(), chunk_channels_.end()});
        for (const ChannelId channel : chunk_channels_)
            if (seen_.insert(channel).second) first_seen_.push_back({channel, chunk_->offset});
        if (chunk_channels_.empty()) without_index_.push_back(chunk_->offset);
        index_.chunks.push_back(*chunk_);
        chunk_channels_.clear();
        chunk_.reset();
    }

    Result<void> take_attachment(std::uint64_t at, const RecordHead& head)
    {
        if (head.length > limits_.attachment_bytes) return damage(at, "an attachment larger than the limit");
        Bytes body(head.length);
        if (auto done = source_->read(at + kRecordHead, body); !done) return done.errors();
        const auto parsed = parse_attachment(body);
        if (!parsed || !parsed->crc_is_right) return damage(at, "an Attachment record is damaged");
        const Attachment& a = parsed->attachment;
        index_.attachments.push_back({at, kRecordHead + head.length, a.log_time, a.create_time, a.data.size(), a.name, a.media_type});
        return {};
    }

    Result<void> take_short(std::uint64_t at, const RecordHead& head)
    {
        if (head.length > limits_.record_bytes) return damage(at, name_of(head.opcode) + " record is larger than the limit");
        Bytes body(head.length);
        if (auto done = source_->read(at + kRecordHead, body); !done) return done.errors();
        bool is_good = false;
        if (head.opcode == Opcode::Schema)
        {
            const auto schema = parse_schema(body);
            is_good = schema && index_.declarations.add(*schema);
        }
        else if (head.opcode == Opcode::Channel)
        {
            const auto channel = parse_channel(body);
            is_good = channel && index_.declarations.add(*channel);
        }
        else if (const auto metadata = parse_metadata(body))
        {
            index_.metadata.push_back({at, kRecordHead + head.length, metadata->name});
            is_good = true;
        }
        return is_good ? Result<void>() : damage(at, name_of(head.opcode) + " record is damaged");
    }

    /// Channels are declared where they are first used (or before, by other writers): those chunks are opened.
    void declare_unknown()
    {
        for (const std::uint64_t offset : without_index_) harvest(offset, true);
        for (const auto& [channel, offset] : first_seen_)
            if (!index_.declarations.channels.contains(channel)) harvest(offset, false);
        const auto is_known = [&](const auto& first) { return index_.declarations.channels.contains(first.first); };
        for (const ChunkPlace& chunk : index_.chunks)
        {
            if (std::all_of(first_seen_.begin(), first_seen_.end(), is_known)) return;
            harvest(chunk.offset, false);
        }
        for (const auto& [channel, offset] : first_seen_)
            if (!index_.declarations.channels.contains(channel))
                index_.troubles.push_back(damage(offset, "messages of channel " + std::to_string(channel) + ", which is not declared"));
    }

    void harvest(std::uint64_t offset, bool count_messages)
    {
        ChunkData chunk;
        if (auto done = chunk.load(*source_, offset, limits_); !done)
        {
            index_.troubles.push_back(done.error());
            return;
        }
        for (const auto& [id, schema] : chunk.declarations().schemas) (void)index_.declarations.add(schema);
        for (const auto& [id, channel] : chunk.declarations().channels) (void)index_.declarations.add(channel);
        if (!count_messages) return;
        for (const auto& message : chunk.messages()) ++index_.statistics.channel_messages[message.channel];
    }

    void count()
    {
        Statistics& s = index_.statistics;
        for (const auto& [channel, messages] : s.channel_messages) s.messages += messages;
        s.chunks = static_cast<std::uint32_t>(index_.chunks.size());
        s.schemas = static_cast<std::uint16_t>(index_.declarations.schemas.size());
        s.channels = static_cast<std::uint32_t>(index_.declarations.channels.size());
        s.attachments = static_cast<std::uint32_t>(index_.attachments.size());
        s.metadata = static_cast<std::uint32_t>(index_.metadata.size());
        bool is_first = true;
        for (const ChunkPlace& chunk : index_.chunks)
        {
            const bool has_messages = chunk.end_time > 0 || !index_.channel_sets.at(chunk.channels).empty();
            if (!has_messages) continue;
            s.start_time = is_first ? chunk.start_time : std::min(s.start_time, chunk.start_time);
            s.end_time = std::max(s.end_time, chunk.end_time);
            is_first = false;
        }
    }

    const Source* source_;
    Limits limits_;
    Window window_;
    FileIndex index_;
    std::optional<ChunkPlace> chunk_;
    std::set<ChannelId> chunk_channels_;
    std::set<ChannelId> seen_;
    std::vector<std::pair<ChannelId, std::uint64_t>> first_seen_;
    std::vector<std::uint64_t> without_index_;
};

/// Reads record by record from `begin`, skipping the bodies of chunks and attachments; opens chunks only where a channel occurs
/// for the first time. Ends at DataEnd, where the file is truncated, or where it is damaged, which is added to the troubles. An
/// incomplete chunk does not count.
Result<FileIndex> scan_file(const Source& source, std::uint64_t begin, const Limits& limits) { return Scan(source, limits).run(begin); }

}  // namespace

Result<FileIndex> read_index(const Source& source, const Limits& limits)
{
    auto start = read_start(source, limits);
    if (!start) return start.errors();
    auto footer = read_footer(source);
    if (!footer) return footer.errors();
    Errors troubles;
    if (*footer && (*footer)->summary_start != 0)
    {
        auto index = read_summary(source, **footer, limits);
        if (index)
        {
            index->header = start->header;
            index->is_closed = true;
            return index;
        }
        troubles = index.errors();
    }
    auto scanned = scan_file(source, start->end, limits);
    if (!scanned) return scanned.errors();
    scanned->header = start->header;
    scanned->troubles.insert(scanned->troubles.begin(), troubles.begin(), troubles.end());
    scanned->is_closed = scanned->is_closed && *footer;
    return scanned;
}

}  // namespace plab::recording
