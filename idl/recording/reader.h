/// Reads a recording: what is in it, its messages in the order of their time, and what stood at a certain time.
///
///   auto reader = McapReader::open("run.mcap");
///   auto messages = reader->messages({.topics = {"plab/states"}, .from = 3'000'000'000});
///   for (auto next = messages.next(); next && *next; next = messages.next()) use(**next);
///
/// A file that was closed is opened by its index; one that was cut by a scan that skips what it need not read. Every
/// chunk is checked before anything of it is handed out. Errors say at which byte of which file.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "idl/recording/chunk_data.h"
#include "idl/recording/file_index.h"
#include "idl/recording/records.h"
#include "idl/recording/source.h"
#include "plab/result.h"

namespace plab::recording
{

/// Selects messages; by default all.
struct Query
{
    std::vector<std::string> topics;                               ///< none: all
    std::uint64_t from = 0;                                        ///< log_time, inclusive
    std::uint64_t to = std::numeric_limits<std::uint64_t>::max();  ///< inclusive
};

/// A message in the reader's memory: valid until its cursor moves.
struct Found
{
    const Channel* channel = nullptr;
    Message message;
};

/// A message that owns its data.
struct Kept
{
    const Channel* channel = nullptr;
    Bytes data;
    Message message;  ///< its data are those above
};

class McapReader;

/// Iterates over messages by log_time; messages of equal time are in file order. The reader must not move. Each thread needs a
/// cursor of its own.
class Cursor
{
public:
    /// The next message, or nothing at the end. After an error the affected chunk is skipped, and the next call continues after
    /// it: count the errors to know what was lost.
    Result<std::optional<Found>> next();

private:
    friend class McapReader;
    Cursor(const McapReader& reader, const Query& query);

    struct OpenChunk
    {
        ChunkData data;
        std::vector<ChunkData::Entry> entries;  ///< those asked for, by time
        std::size_t next = 0;
        std::uint64_t offset = 0;
    };
    Result<void> open_due();
    Result<void> open(const ChunkPlace& place);
    bool is_wanted(const ChunkData::Entry& entry) const;
    std::size_t earliest() const;
    bool is_full() const;

    const McapReader* reader_;
    std::uint64_t from_;
    std::uint64_t to_;
    std::set<ChannelId> channels_;
    bool all_channels_;
    std::size_t next_chunk_;
    std::vector<std::unique_ptr<OpenChunk>> open_;
    std::vector<std::unique_ptr<OpenChunk>> spare_;  ///< reused memory
    std::size_t last_ = 0;                           ///< index in open_: origin of the message that was returned last
};

class McapReader
{
public:
    static Result<McapReader> open(const std::string& path, const Limits& limits = {});
    static Result<McapReader> open(std::unique_ptr<const Source> source, const Limits& limits = {});

    const FileIndex& index() const { return index_; }
    const std::map<ChannelId, Channel>& channels() const { return index_.declarations.channels; }
    /// Nothing: the channel has none, or it is lost.
    const Schema* schema_of(const Channel& channel) const;
    /// Ids of the channels of these topics. Topics without a channel in this file are left out.
    std::set<ChannelId> channels_of(const std::vector<std::string>& topics) const;
    const std::string& name() const { return source_->name(); }

    Cursor messages(const Query& query = {}) const { return Cursor(*this, query); }
    /// The last message of a topic whose log_time is at most `time`; of several with equal time, the last one in the file.
    Result<std::optional<Kept>> last_at(const std::string& topic, std::uint64_t time) const;

    struct AttachmentData
    {
        Bytes record;
        Attachment attachment;  ///< its data are in `record`
    };
    /// The first attachment of this name. An error: there is none, or it is damaged.
    Result<AttachmentData> attachment(const std::string& name) const;
    Result<AttachmentData> attachment(const AttachmentIndex& place) const;
    /// The first metadata record of this name. An error: there is none, or it is damaged.
    Result<Metadata> metadata(const std::string& name) const;
    Result<Metadata> metadata(const MetadataIndex& place) const;

private:
    friend class Cursor;
    McapReader(std::unique_ptr<const Source> source, FileIndex index, const Limits& limits)
        : source_(std::move(source)), index_(std::move(index)), limits_(limits)
    {
    }
    Error with_name(Error error) const;
    /// The first chunk that may have a message at or after `time`.
    std::size_t first_chunk_at(std::uint64_t time) const;
    Result<Bytes> record_at(std::uint64_t offset, std::uint64_t length, Opcode opcode, std::uint64_t most) const;

    std::unique_ptr<const Source> source_;
    FileIndex index_;
    Limits limits_;
};

}  // namespace plab::recording
