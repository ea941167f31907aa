#include "idl/recording/reader.h"

#include <algorithm>

#include "idl/recording/metadata.h"
#include "idl/recording/file_index.h"
#include "idl/recording/parse.h"

namespace plab::recording
{

Result<McapReader> McapReader::open(const std::string& path, const Limits& limits)
{
    auto source = FileSource::open(path);
    if (!source) return source.errors();
    return open(std::make_unique<FileSource>(source.take()), limits);
}

Result<McapReader> McapReader::open(std::unique_ptr<const Source> source, const Limits& limits)
{
    auto index = read_index(*source, limits);
    if (!index)
    {
        Error error = index.error();
        error.where.file = source->name();
        return error;
    }
    return McapReader(std::move(source), index.take(), limits);
}

Error McapReader::with_name(Error error) const
{
    error.where.file = source_->name();
    return error;
}

const Schema* McapReader::schema_of(const Channel& channel) const
{
    const auto found = index_.declarations.schemas.find(channel.schema_id);
    return found == index_.declarations.schemas.end() ? nullptr : &found->second;
}

std::set<ChannelId> McapReader::channels_of(const std::vector<std::string>& topics) const
{
    std::set<ChannelId> out;
    for (const auto& [id, channel] : channels())
        if (std::find(topics.begin(), topics.end(), channel.topic) != topics.end()) out.insert(id);
    return out;
}

std::size_t McapReader::first_chunk_at(std::uint64_t time) const
{
    const auto& latest = index_.latest_before;
    return static_cast<std::size_t>(std::lower_bound(latest.begin(), latest.end(), time) - latest.begin());
}

Result<std::optional<Kept>> McapReader::last_at(const std::string& topic, std::uint64_t time) const
{
    const std::set<ChannelId> wanted = channels_of({topic});
    if (wanted.empty()) return std::optional<Kept>();
    const auto& chunks = index_.chunks;
    const auto is_later = [](std::uint64_t t, const ChunkPlace& chunk) { return t < chunk.start_time; };
    auto i = static_cast<std::size_t>(std::upper_bound(chunks.begin(), chunks.end(), time, is_later) - chunks.begin());

    std::optional<Kept> best;
    std::uint64_t best_offset = 0;
    ChunkData data;
    while (i-- > 0 && (!best || index_.latest_before[i] >= best->message.log_time))
    {
        if (!index_.may_hold(chunks[i], wanted)) continue;
        auto done = data.load(*source_, chunks[i].offset, limits_);
        if (done) done = data.check_times(chunks[i].offset, chunks[i].start_time, chunks[i].end_time);
        if (!done) return with_name(done.error());
        for (const auto& entry : data.messages())
        {
            const bool is_better =
                !best || std::pair(entry.log_time, chunks[i].offset + entry.offset) > std::pair(best->message.log_time, best_offset);
            if (entry.log_time > time || !wanted.contains(entry.channel) || !is_better) continue;
            const Message message = data.message(entry);
            best = Kept{&channels().at(entry.channel), Bytes(message.data.begin(), message.data.end()), message};
            best->message.data = best->data;
            best_offset = chunks[i].offset + entry.offset;
        }
    }
    return best;
}

Result<Bytes> McapReader::record_at(std::uint64_t offset, std::uint64_t length, Opcode opcode, std::uint64_t most) const
{
    auto size = source_->size();
    if (!size) return size.errors();
    if (length < kRecordHead || length > *size || offset > *size - length)
        return with_name(damage(offset, "the index names a " + name_of(opcode) + " record outside of the file"));
    if (length > most) return with_name(damage(offset, name_of(opcode) + " record is larger than the limit"));
    Bytes record(length);
    auto got = source_->read(offset, record);
    if (!got) return got.errors();
    const RecordHead head = parse_head(record);
    if (*got < length || head.opcode != opcode || head.length != length - kRecordHead)
        return with_name(damage(offset, "the index names a " + name_of(opcode) + " record that is not there"));
    return record;
}

Result<McapReader::AttachmentData> McapReader::attachment(const AttachmentIndex& place) const
{
    auto record = record_at(place.offset, place.length, Opcode::Attachment, limits_.attachment_bytes);
    if (!record) return record.errors();
    AttachmentData out{record.take(), {}};
    const auto parsed = parse_attachment(ByteView(out.record).subspan(kRecordHead));
    if (!parsed || !parsed->crc_is_right) return with_name(damage(place.offset, "attachment \"" + place.name + "\" is damaged"));
    out.attachment = parsed->attachment;
    return out;
}

Result<McapReader::AttachmentData> McapReader::attachment(const std::string& name) const
{
    const auto has_name = [&](const AttachmentIndex& place) { return place.name == name; };
    const auto found = std::find_if(index_.attachments.begin(), index_.attachments.end(), has_name);
    if (found == index_.attachments.end()) return with_name(reason("has no attachment \"" + name + "\""));
    return attachment(*found);
}

Result<Metadata> McapReader::metadata(const MetadataIndex& place) const
{
    auto record = record_at(place.offset, place.length, Opcode::Metadata, limits_.record_bytes);
    if (!record) return record.errors();
    auto parsed = parse_metadata(ByteView(*record).subspan(kRecordHead));
    if (!parsed || parsed->name != place.name || seal_of(*parsed) == Seal::Broken)
        return with_name(damage(place.offset, "metadata \"" + place.name + "\" is damaged"));
    return *parsed;
}

Result<Metadata> McapReader::metadata(const std::string& name) const
{
    const auto has_name = [&](const MetadataIndex& place) { return place.name == name; };
    const auto found = std::find_if(index_.metadata.begin(), index_.metadata.end(), has_name);
    if (found == index_.metadata.end()) return with_name(reason("has no metadata \"" + name + "\""));
    return metadata(*found);
}

}  // namespace plab::recording
