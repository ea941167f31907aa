#include <algorithm>
#include <tuple>

#include "idl/recording/parse.h"
#include "idl/recording/reader.h"

namespace plab::recording
{
namespace
{

/// A file whose chunks overlap more than this would have to be held in memory as a whole.
constexpr std::size_t kMostOpen = 256;

}  // namespace

Cursor::Cursor(const McapReader& reader, const Query& query)
    : reader_(&reader),
      from_(query.from),
      to_(query.to),
      channels_(reader.channels_of(query.topics)),
      all_channels_(query.topics.empty()),
      next_chunk_(reader.first_chunk_at(query.from))
{
}

bool Cursor::is_wanted(const ChunkData::Entry& entry) const
{
    return entry.log_time >= from_ && entry.log_time <= to_ && (all_channels_ || channels_.contains(entry.channel));
}

Result<void> Cursor::open(const ChunkPlace& place)
{
    if (!all_channels_ && !reader_->index_.may_hold(place, channels_)) return {};
    std::unique_ptr<OpenChunk> chunk = spare_.empty() ? std::make_unique<OpenChunk>() : std::move(spare_.back());
    if (!spare_.empty()) spare_.pop_back();
    chunk->entries.clear();
    chunk->next = 0;
    chunk->offset = place.offset;
    if (auto done = chunk->data.load(*reader_->source_, place.offset, reader_->limits_); !done) return reader_->with_name(done.error());
    if (auto done = chunk->data.check_times(place.offset, place.start_time, place.end_time); !done) return reader_->with_name(done.error());
    if (!chunk->data.declarations().agrees_with(reader_->index_.declarations))
        return reader_->with_name(damage(place.offset, "a chunk whose declaration of an id differs from the rest of the file"));
    for (const auto& entry : chunk->data.messages())
    {
        if (!reader_->channels().contains(entry.channel))
            return reader_->with_name(
                damage(place.offset, "a message of channel " + std::to_string(entry.channel) + ", which is not declared"));
        if (is_wanted(entry)) chunk->entries.push_back(entry);
    }
    const auto earlier = [](const ChunkData::Entry& a, const ChunkData::Entry& b) { return a.log_time < b.log_time; };
    std::stable_sort(chunk->entries.begin(), chunk->entries.end(), earlier);
    (chunk->entries.empty() ? spare_ : open_).push_back(std::move(chunk));
    return {};
}

/// The open chunk with the next message.
std::size_t Cursor::earliest() const
{
    const auto key = [](const OpenChunk& chunk) { return std::pair(chunk.entries[chunk.next].log_time, chunk.offset); };
    std::size_t best = 0;
    for (std::size_t i = 1; i < open_.size(); ++i)
        if (key(*open_[i]) < key(*open_[best])) best = i;
    return best;
}

bool Cursor::is_full() const
{
    std::uint64_t bytes = 0;
    for (const auto& chunk : open_) bytes += chunk->data.size();
    return open_.size() >= kMostOpen || bytes > 2 * reader_->limits_.chunk_bytes;
}

/// Opens the chunks that may hold the next message.
Result<void> Cursor::open_due()
{
    const auto& chunks = reader_->index_.chunks;
    while (next_chunk_ < chunks.size() && chunks[next_chunk_].start_time <= to_)
    {
        const ChunkPlace& place = chunks[next_chunk_];
        if (!open_.empty())
        {
            const OpenChunk& first = *open_[earliest()];
            if (place.start_time > first.entries[first.next].log_time) return {};
        }
        ++next_chunk_;
        if (is_full()) return reader_->with_name(damage(place.offset, "too many chunks overlap in time: skipped"));
        if (place.end_time < from_) continue;
        if (auto done = open(place); !done) return done;
    }
    return {};
}

Result<std::optional<Found>> Cursor::next()
{
    // The memory of the message that was returned last may be released now.
    if (last_ < open_.size() && open_[last_]->next == open_[last_]->entries.size())
    {
        spare_.push_back(std::move(open_[last_]));
        open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(last_));
    }
    last_ = open_.size();
    if (auto done = open_due(); !done) return done.errors();
    if (open_.empty()) return std::optional<Found>();
    last_ = earliest();
    OpenChunk& chunk = *open_[last_];
    const ChunkData::Entry& entry = chunk.entries[chunk.next++];
    return std::optional<Found>({&reader_->channels().at(entry.channel), chunk.data.message(entry)});
}

}  // namespace plab::recording
