/// The file of a recording and the thread that writes it. The producer never waits for the disk: a bounded queue is in between,
/// and messages that find no room are counted, also in the file.
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

/// A sample in wire format.
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
    std::uint64_t missing = 0;          ///< that never arrived
    std::optional<Error> trouble;       ///< why nothing is written at present
    std::optional<Error> last_trouble;  ///< the most recent trouble, even if the disk works again
    bool is_ended = false;              ///< after close(): the file is complete
};

class AsyncWriter
{
public:
    /// Creates the file; `about` is its first record.
    static Result<std::unique_ptr<AsyncWriter>> open(const AsyncWriterOptions& options, recording::Metadata about);
    /// For tests: any sink.
    static Result<std::unique_ptr<AsyncWriter>> open(std::unique_ptr<recording::Sink> sink, const AsyncWriterOptions& options,
                                                     recording::Metadata about);
    /// Without close(): writes what waits and completes the file, but errors are not reported.
    ~AsyncWriter();
    AsyncWriter(const AsyncWriter&) = delete;
    AsyncWriter& operator=(const AsyncWriter&) = delete;

    /// False: there was no room.
    bool put(Message&& message);
    /// Samples that never arrived, to be noted in the file.
    void put_gap(const recording::Losses& losses, const std::string& why);
    void attach(std::uint64_t log_time, std::string name, std::string media_type, std::string text);

    WriteProgress progress() const;
    /// Writes what waits and completes the file. An error: the file is as after a crash, intact up to the failure; progress()
    /// still reports how far it got.
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
    std::optional<Error> refused_;  ///< errors of the file itself, not of the disk

    mutable std::mutex mutex_;  ///< of the following
    std::condition_variable_any came_;
    Work waiting_;
    recording::Losses no_room_, unnoted_;  ///< total; and those not yet noted in the file
    WriteProgress progress_;
    bool is_closed_ = false;

    std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace plab::recorder
