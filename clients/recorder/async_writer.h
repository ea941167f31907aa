/// The file of a recording and the thread that writes it. Who hands over never waits for the disk: between the two is a
/// queue with an end, and what finds no room is counted, in the file as well.
#pragma once

#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "idl/recording/writer.h"
#include "idl/topics.h"

namespace plab::recorder
{

/// A sample as it was on the wire.
struct Message
{
    const wire::Topic* topic = nullptr;
    std::uint64_t log_time = 0;      ///< ns on the recording's time line
    std::uint64_t publish_time = 0;  ///< ns since 1970
    recording::Bytes data;
};

struct AsyncWriterOptions
{
    std::string file;
    bool overwrite = false;
    recording::Compression compression = recording::Compression::Zstd;
    std::size_t most_waiting_bytes = 64u << 20;  ///< between the bus and the disk
};

struct WriteProgress
{
    std::uint64_t messages = 0;         ///< in the file
    std::uint64_t bytes = 0;            ///< of the file
    recording::Losses dropped;          ///< no room in the queue, or the disk failed
    std::uint64_t missing = 0;          ///< that never came
    std::optional<Error> trouble;       ///< why nothing is written at present
    std::optional<Error> last_trouble;  ///< the last of all, though the disk may take data again
    bool is_ended = false;              ///< after close(): the file has its end
};

class AsyncWriter
{
public:
    /// Makes the file; `about` is its first record.
    static Result<std::unique_ptr<AsyncWriter>> open(const AsyncWriterOptions& options, recording::Metadata about);
    /// For tests: any sink.
    static Result<std::unique_ptr<AsyncWriter>> open(std::unique_ptr<recording::Sink> sink, const AsyncWriterOptions& options,
                                                     recording::Metadata about);
    /// Without close(): what waits is written, the file is ended, and nobody hears how that went.
    ~AsyncWriter();
    AsyncWriter(const AsyncWriter&) = delete;
    AsyncWriter& operator=(const AsyncWriter&) = delete;

    /// False: there was no room.
    bool put(Message&& message);
    /// Samples that never came, for the file to tell.
    void put_gap(const recording::Losses& losses, const std::string& why);
    void attach(std::uint64_t log_time, std::string name, std::string media_type, std::string text);

    WriteProgress progress() const;
    /// Writes what waits and ends the file. An error: the file is as after a crash, whole up to what failed; progress() still
    /// says how far it came.
    Result<WriteProgress> close();

private:
    struct Gap
    {
        recording::Losses losses;
        std::string why;
    };
    struct Enclosure
    {
        std::uint64_t log_time = 0;
        std::string name, media_type, text;
    };
    struct Work
    {
        std::deque<Message> messages;
        std::deque<Gap> gaps;
        std::deque<Enclosure> enclosures;
        std::size_t bytes = 0;

        bool empty() const { return messages.empty() && gaps.empty() && enclosures.empty(); }
    };

    AsyncWriter(const AsyncWriterOptions& options, recording::Writer writer);
    Result<void> stop();
    // Writer's thread -------------------------------------------------------------------------------------------------
    void run(const std::stop_token& stop);
    bool wait_for_work(const std::stop_token& stop, Work& work);
    void write(Work& work);
    Result<recording::ChannelId> channel_of(const wire::Topic& topic);
    void attach_pending();
    void mend(recording::Clock::time_point now);
    void note_no_room();
    void report();
    void note_end(const Result<void>& closed);

    AsyncWriterOptions options_;
    recording::Writer writer_;
    std::map<std::string, recording::ChannelId> channels_;
    std::deque<Enclosure> pending_;  ///< until the disk takes them
    recording::Clock::time_point tried_{};
    std::optional<Error> refused_;  ///< what the file would not take, though the disk would

    mutable std::mutex mutex_;  ///< of the following
    std::condition_variable_any came_;
    Work waiting_;
    recording::Losses no_room_, unnoted_;  ///< altogether; and those that the file does not tell of yet
    WriteProgress progress_;
    bool is_closed_ = false;

    std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace plab::recorder
