/// Writes a recording, message by message. Made for a thread that does nothing else.
/// Messages are collected in a chunk; a chunk is written to the file with one write, when it is `chunk_time` old or
/// `chunk_bytes` large. So a crash loses younger messages, but nothing that is already in the file. The caller passes the time
/// in, and calls tick() when due() says so; only the disk can block.
/// When the disk fails, the writer continues without it: it counts what it drops, gives the reason in trouble(), and resumes
/// when retry() succeeds; a metadata record "gap" then reports what is missing. No function throws.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "idl/recording/container.h"
#include "idl/recording/records.h"
#include "idl/recording/sink.h"
#include "plab/result.h"

namespace plab::recording
{

using Clock = std::chrono::steady_clock;

struct WriterOptions
{
    Compression compression = Compression::Zstd;
    int level = 1;  ///< of zstd
    std::chrono::nanoseconds chunk_time = std::chrono::milliseconds(20);
    std::size_t chunk_bytes = 1u << 20;                            ///< uncompressed
    std::chrono::nanoseconds sync_time = std::chrono::seconds(1);  ///< between two fdatasync; 0: never
    /// Channels are declared again in the chunks after this time, so that a file whose beginning is lost can still be read.
    std::chrono::nanoseconds declare_time = std::chrono::seconds(5);
    std::size_t most_message_bytes = 256u << 20;  ///< larger ones are dropped; readers refuse larger chunks
    std::size_t most_index_memory = 64u << 20;    ///< beyond it the file gets no index: days of 20 ms chunks
    std::string profile = "plab";
    std::string library = "pLab";
};

/// Messages that are not in the file.
struct Losses
{
    std::uint64_t messages = 0;
    std::uint64_t bytes = 0;
    std::uint64_t first_log_time = 0;
    std::uint64_t last_log_time = 0;

    void add(const Losses& more);
};

class McapWriter
{
public:
    static Result<McapWriter> open(std::unique_ptr<Sink> sink, WriterOptions options);
    static Result<McapWriter> create(const std::string& path, WriterOptions options = {}, Overwrite overwrite = Overwrite::No);
    McapWriter(McapWriter&&) noexcept = default;
    McapWriter& operator=(McapWriter&&) = delete;
    /// Closes the file if necessary; call close() to learn whether that succeeded.
    ~McapWriter();

    /// Ids count from 1. The id of `schema` is ignored.
    Result<std::uint16_t> add_schema(Schema schema);
    /// The id of `channel` is ignored; its schema must be there. A topic may have several channels.
    Result<ChannelId> add_channel(Channel channel);

    /// False: the message was dropped (and counted), because the disk fails, or it is larger than most_message_bytes, or there
    /// is no such channel. Its sequence is set here: it counts the channel's messages from 0, including dropped ones. log_time
    /// need not ascend, but readers are faster if it does.
    bool write(const Message& message, Clock::time_point now);
    /// Written at once, not in a chunk.
    Result<void> attach(const Attachment& attachment);
    /// Written at once, and sealed (metadata.h).
    Result<void> add_metadata(Metadata metadata);
    /// Notes messages as a gap that were lost on their way to this writer, for example because a ring was full.
    Result<void> add_gap(const Losses& losses, const std::string& why);

    /// Does what is due: completes a chunk that is old enough, syncs.
    void tick(Clock::time_point now);
    /// When tick() has something to do; nothing: not before the next message.
    std::optional<Clock::time_point> due() const;
    /// Writes the chunk as it is.
    void flush();
    /// Retries a disk that failed: truncates what a failed write left, notes the gap. Success if there was no trouble.
    Result<void> retry();
    /// Completes the file. If there is trouble, retries first. An error: the file is as after a crash, intact up to the
    /// failure.
    Result<void> close();

    /// Why nothing is written at present.
    const std::optional<Error>& trouble() const { return trouble_; }
    /// All that was dropped since the file was opened.
    const Losses& dropped() const { return dropped_; }
    /// Of what is in the file.
    Statistics statistics() const { return container_.statistics(); }
    std::uint64_t messages() const { return container_.messages(); }
    std::uint64_t file_size() const { return container_.size(); }

private:
    McapWriter(Container container, WriterOptions options);
    void declare(ChannelId channel, Clock::time_point now);
    void declare_rest();
    void forget_declarations();
    void drop(const Losses& losses);
    void drop_chunk();
    Result<void> note_gap(const std::string& why);
    void fail(const Error& error);
    Result<void> note(Result<void> done);
    void sync();

    struct Known
    {
        Channel channel;
        std::uint32_t next_sequence = 0;
        bool is_declared = false;   ///< in a chunk since declared_since_
        bool was_declared = false;  ///< in any chunk
    };

    WriterOptions options_;
    Container container_;
    Compressor compressor_;
    ChunkBuilder chunk_;
    Bytes out_;
    std::vector<Schema> schemas_;
    std::vector<Known> channels_;
    Clock::time_point chunk_since_{};
    Clock::time_point declared_since_{};
    std::optional<Clock::time_point> unsynced_since_;  ///< when the oldest bytes were written that no sync has seen
    Clock::time_point now_{};
    std::optional<Error> trouble_;
    Losses dropped_;
    Losses gap_;  ///< dropped and not yet noted in the file
};

}  // namespace plab::recording
