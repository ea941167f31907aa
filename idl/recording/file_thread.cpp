#include "idl/recording/file_thread.h"

#include <pthread.h>

#include <algorithm>
#include <csignal>
#include <filesystem>

namespace plab::recording
{
namespace
{

constexpr std::chrono::seconds kIdle(1);
constexpr std::chrono::seconds kPatience(1);  ///< between two retries of a disk that failed, and between two gaps
/// While entries come at each step, the thread wakes at this interval, not for each entry.
constexpr std::chrono::milliseconds kGather(2);

WriterOptions writer_options(const AsyncWriterOptions& options)
{
    WriterOptions out;
    // Of the 20 ms that a kill may cost, a chunk takes 12; the rest is for what gathers before it, for this thread's sleep and for the
    // write.
    out.chunk_time = std::chrono::milliseconds(12);
    out.compression = options.compression;
    return out;
}

}  // namespace

Result<McapWriter> open_writer(const AsyncWriterOptions& options)
{
    return McapWriter::create(options.file, writer_options(options), options.overwrite ? Overwrite::Yes : Overwrite::No);
}

Result<McapWriter> open_writer(std::unique_ptr<Sink> sink, const AsyncWriterOptions& options)
{
    return McapWriter::open(std::move(sink), writer_options(options));
}

FileThread::FileThread(McapWriter writer, AsyncWriterOptions options, Source& source)
    : options_(std::move(options)), source_(&source), file_(std::move(writer))
{
}

void FileThread::start()
{
    // Signals are for the threads of the program.
    sigset_t all, before;
    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    thread_ = std::thread([this] { run(); });
    (void)pthread_sigmask(SIG_SETMASK, &before, nullptr);
    (void)pthread_setname_np(thread_.native_handle(), "plab-record");
    // Batch: waking this thread does not preempt the producer on the same core.
    const sched_param priority{};
    (void)pthread_setschedparam(thread_.native_handle(), SCHED_BATCH, &priority);
}

void FileThread::run()
{
    bool is_busy = false;
    while (!is_stopped_.load(std::memory_order_acquire))
    {
        const bool any = pass();
        if (is_busy && any)
            std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(kGather, time_to_sleep()));
        else if (source_->is_empty())
            wake_up_.sleep(time_to_sleep());
        is_busy = any;
    }
    while (pass()) continue;
}

std::chrono::nanoseconds FileThread::time_to_sleep() const
{
    const auto due = file_.writer().due();
    if (!due) return kIdle;
    return std::clamp<std::chrono::nanoseconds>(*due - Clock::now(), std::chrono::nanoseconds(0), kIdle);
}

/// Writes what waits. True if there was something.
bool FileThread::pass()
{
    const bool any = source_->write_some(file_);
    const Clock::time_point now = Clock::now();
    file_.tick(now);
    check_disk(now);
    if (no_room_.messages > 0 && now - noted_at_ >= kPatience) noted_at_ = now, note_gap();
    return any;
}

void FileThread::check_disk(Clock::time_point now)
{
    if (file_.refused() && !is_refusal_reported_) is_refusal_reported_ = true, notify(Notice::Refused, *file_.refused());
    report();  // before a retry: a failure must be seen even if it occurs only once
    if (const auto& trouble = file_.writer().trouble())
    {
        if (!stalled_) notify(Notice::Stalled, *trouble);
        stalled_ = trouble;
        if (now - tried_ < kPatience) return;
        tried_ = now;
        file_.retry();
        report();
    }
    else if (stalled_ && now - tried_ >= 2 * kPatience)
    {
        // A disk that accepted a few bytes is not yet considered healthy.
        notify(Notice::Continues, *stalled_);
        stalled_.reset();
    }
}

void FileThread::note(std::uint64_t log_time, std::uint64_t messages, std::uint64_t bytes)
{
    no_room_.add({messages, bytes, std::min(last_log_time_, log_time), std::max(last_log_time_, log_time)});
    last_log_time_ = log_time;
}

/// At most one a second, with all that found no room since the last: a disk that is too slow must not get more to write.
void FileThread::note_gap()
{
    if (no_room_.messages > 0) file_.add_gap(no_room_, options_.too_slow);
    no_room_ = {};
}

void FileThread::report()
{
    const McapWriter& writer = file_.writer();
    const std::uint64_t messages = writer.messages();
    const std::lock_guard lock(mutex_);
    progress_.messages = messages;
    progress_.bytes = writer.file_size();
    progress_.dropped = writer.dropped().messages;
    progress_.trouble = writer.trouble();
    if (writer.trouble()) progress_.last_trouble = writer.trouble();
}

void FileThread::notify(Notice notice, const Error& why) const
{
    if (options_.notice) options_.notice(notice, why.reason);
}

Result<void> FileThread::close(std::uint64_t messages, std::uint64_t bytes)
{
    if (closed_) return *closed_;
    is_stopped_.store(true, std::memory_order_release);
    wake_up_.notify();
    if (thread_.joinable()) thread_.join();
    note(last_log_time_, messages, bytes);
    // Data that waits since the disk failed may still be written, and a gap is noted only by a disk that works.
    file_.retry();
    note_gap();
    closed_ = file_.close();
    report();
    const std::lock_guard lock(mutex_);
    progress_.is_ended = closed_->ok();
    if (!*closed_) progress_.last_trouble = closed_->error();
    // The end of the file is not counted by the writer.
    std::error_code no_size;
    if (const auto size = std::filesystem::file_size(options_.file, no_size); !no_size) progress_.bytes = size;
    return *closed_;
}

WriteProgress FileThread::progress() const
{
    const std::lock_guard lock(mutex_);
    return progress_;
}

}  // namespace plab::recording
