/// The thread that writes a recording. It empties a queue into the file, retries a disk that fails, notes in the file what is
/// missing there, and completes the file at the end.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "idl/recording/queue.h"
#include "idl/recording/topic_file.h"

namespace plab::recording
{

/// What a program may want to log; on the writer's thread.
enum class Notice : std::uint8_t
{
    Stalled,    ///< the disk fails; writing is retried each second
    Continues,  ///< the disk accepts writes again
    Refused,    ///< something cannot be written, whatever the disk does
};

struct AsyncWriterOptions
{
    std::string file;
    bool overwrite = false;
    Compression compression = Compression::Zstd;
    std::size_t most_waiting_bytes = 64u << 20;      ///< between the producer and the disk
    std::size_t most_waiting = 16384;                ///< entries
    std::string too_slow = "the disk was too slow";  ///< the reason of gaps whose messages found no room
    std::function<void(Notice, const std::string& why)> notice;
};

struct WriteProgress
{
    std::uint64_t messages = 0;         ///< in the file
    std::uint64_t bytes = 0;            ///< of the file
    std::uint64_t dropped = 0;          ///< messages: no room in the queue, or the disk failed
    std::optional<Error> trouble;       ///< why nothing is written at present
    std::optional<Error> last_trouble;  ///< the most recent trouble, even if the disk works again
    bool is_ended = false;              ///< after close(): the file is complete
};

/// The file that the options name, with nothing in it yet.
Result<McapWriter> open_writer(const AsyncWriterOptions& options);
/// For tests: any sink.
Result<McapWriter> open_writer(std::unique_ptr<Sink> sink, const AsyncWriterOptions& options);

class FileThread
{
public:
    /// What waits to be written.
    class Source
    {
    public:
        /// Writes some of it. False: nothing waited.
        virtual bool write_some(TopicFile& file) = 0;
        virtual bool is_empty() const = 0;

    protected:
        ~Source() = default;
    };

    /// `source` must outlive close().
    FileThread(McapWriter writer, AsyncWriterOptions options, Source& source);
    FileThread(const FileThread&) = delete;
    FileThread& operator=(const FileThread&) = delete;
    ~FileThread() { (void)close(0, 0); }

    void start();
    /// Something waits. Never blocks.
    void wake() { wake_up_.notify(); }
    /// On the writer's thread: an entry was written, before which `messages` with `bytes` found no room.
    void note(std::uint64_t log_time, std::uint64_t messages, std::uint64_t bytes);
    /// Writes what waits, notes what found no room since, and completes the file. Later calls return the same.
    Result<void> close(std::uint64_t messages, std::uint64_t bytes);
    WriteProgress progress() const;

private:
    void run();
    bool pass();
    std::chrono::nanoseconds time_to_sleep() const;
    void check_disk(Clock::time_point now);
    void note_gap();
    void report();
    void notify(Notice notice, const Error& why) const;

    AsyncWriterOptions options_;
    Source* source_;
    TopicFile file_;

    // Used by the writer's thread; by close() once that has ended.
    Clock::time_point tried_{}, noted_at_{};
    std::optional<Error> stalled_;
    bool is_refusal_reported_ = false;
    Losses no_room_;                   ///< not yet noted in the file
    std::uint64_t last_log_time_ = 0;  ///< of the last entry

    mutable std::mutex mutex_;  ///< of progress_, held for a copy
    WriteProgress progress_;
    std::optional<Result<void>> closed_;

    WakeUp wake_up_;
    std::atomic<bool> is_stopped_{false};
    std::thread thread_;
};

}  // namespace plab::recording
