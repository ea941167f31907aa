#include "recorder/async_writer.h"

#include "idl/recording/topic_schema.h"

namespace plab::recorder
{
namespace
{

using recording::Clock;

constexpr std::chrono::seconds kPatience(1);  ///< between two retries of a disk that failed
constexpr std::chrono::milliseconds kNap(200);
/// Memory of a message in addition to its bytes.
constexpr std::size_t kOverhead = sizeof(Message);

recording::WriterOptions writer_options(const AsyncWriterOptions& options)
{
    recording::WriterOptions out;
    // Of the 20 ms that a kill may cost, the rest is for the queue and for the write.
    out.chunk_time = std::chrono::milliseconds(12);
    out.compression = options.compression;
    return out;
}

}  // namespace

Result<std::unique_ptr<AsyncWriter>> AsyncWriter::open(const AsyncWriterOptions& options, recording::Metadata about)
{
    auto sink = recording::FileSink::open(options.file, options.overwrite ? recording::Overwrite::Yes : recording::Overwrite::No);
    if (!sink) return sink.errors();
    return open(std::make_unique<recording::FileSink>(sink.take()), options, std::move(about));
}

Result<std::unique_ptr<AsyncWriter>> AsyncWriter::open(std::unique_ptr<recording::Sink> sink, const AsyncWriterOptions& options,
                                                       recording::Metadata about)
{
    auto writer = recording::Writer::open(std::move(sink), writer_options(options));
    if (!writer) return writer.errors();
    if (auto added = writer->add_metadata(std::move(about)); !added) return added.errors();
    std::unique_ptr<AsyncWriter> out(new AsyncWriter(options, writer.take()));
    out->thread_ = std::jthread([self = out.get()](const std::stop_token& stop) { self->run(stop); });
    return out;
}

AsyncWriter::AsyncWriter(const AsyncWriterOptions& options, recording::Writer writer) : options_(options), writer_(std::move(writer)) {}

AsyncWriter::~AsyncWriter() { (void)stop(); }

bool AsyncWriter::put(Message&& message)
{
    {
        const std::lock_guard lock(mutex_);
        const std::size_t bytes = message.data.size() + kOverhead;
        if (waiting_.bytes + bytes > options_.most_waiting_bytes)
        {
            const recording::Losses lost{1, message.data.size(), message.log_time, message.log_time};
            no_room_.add(lost), unnoted_.add(lost), progress_.dropped.add(lost);
            return false;
        }
        waiting_.bytes += bytes;
        waiting_.messages.push_back(std::move(message));
    }
    came_.notify_one();
    return true;
}

void AsyncWriter::put_gap(const recording::Losses& losses, const std::string& why)
{
    const std::lock_guard lock(mutex_);
    progress_.missing += losses.messages;
    waiting_.gaps.push_back({losses, why});
}

void AsyncWriter::attach(std::uint64_t log_time, std::string name, std::string media_type, std::string text)
{
    const std::lock_guard lock(mutex_);
    waiting_.enclosures.push_back({log_time, std::move(name), std::move(media_type), std::move(text)});
}

WriteProgress AsyncWriter::progress() const
{
    const std::lock_guard lock(mutex_);
    return progress_;
}

Result<void> AsyncWriter::stop()
{
    {
        const std::lock_guard lock(mutex_);
        if (is_closed_) return {};
        is_closed_ = true;
    }
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
    // A last attempt: data that waits since the disk failed may still be written.
    if (writer_.retry()) attach_pending();
    note_no_room();
    const Result<void> closed = writer_.close();
    if (!pending_.empty() && !refused_) refused_ = reason(options_.file + ": " + pending_.front().name + " could not be stored in it");
    report();
    note_end(closed);
    if (!closed) return closed;
    if (refused_) return *refused_;
    return {};
}

Result<WriteProgress> AsyncWriter::close()
{
    if (auto stopped = stop(); !stopped) return stopped.errors();
    return progress();
}

void AsyncWriter::run(const std::stop_token& stop)
{
    Work work;
    while (wait_for_work(stop, work) || !stop.stop_requested()) write(work);
}

/// Takes queued messages, or waits until the writer has work of its own. False: there is nothing left.
bool AsyncWriter::wait_for_work(const std::stop_token& stop, Work& work)
{
    work = {};
    const auto due = std::min(writer_.due().value_or(Clock::now() + kNap), Clock::now() + kNap);
    std::unique_lock lock(mutex_);
    (void)came_.wait_until(lock, stop, due, [this] { return !waiting_.empty(); });
    std::swap(work, waiting_);
    return !work.empty();
}

void AsyncWriter::write(Work& work)
{
    const Clock::time_point now = Clock::now();
    for (Enclosure& e : work.enclosures) pending_.push_back(std::move(e));
    attach_pending();
    for (const Message& m : work.messages)
    {
        const auto channel = channel_of(*m.topic);
        if (channel)
            (void)writer_.write({*channel, 0, m.log_time, m.publish_time, m.data}, now);
        else if (!refused_)
            refused_ = channel.error();
    }
    for (const Gap& gap : work.gaps) (void)writer_.add_gap(gap.losses, gap.why);
    writer_.tick(Clock::now());
    mend(now);
    report();
}

Result<recording::ChannelId> AsyncWriter::channel_of(const wire::Topic& topic)
{
    if (const auto known = channels_.find(topic.name); known != channels_.end()) return known->second;
    auto schema = recording::schema_of(topic);
    if (!schema) return schema.errors();
    const auto schema_id = writer_.add_schema(schema.take());
    if (!schema_id) return schema_id.errors();
    const auto id = writer_.add_channel(recording::channel_of(topic, *schema_id));
    if (id) channels_.emplace(topic.name, *id);
    return id;
}

void AsyncWriter::attach_pending()
{
    while (!pending_.empty())
    {
        const Enclosure& e = pending_.front();
        const auto* text = reinterpret_cast<const std::uint8_t*>(e.text.data());
        if (!writer_.attach({e.log_time, 0, e.name, e.media_type, {text, e.text.size()}})) return;
        pending_.pop_front();
    }
}

/// Retries a failed disk from time to time, and notes in the file what found no room in the queue.
void AsyncWriter::mend(Clock::time_point now)
{
    if (now - tried_ < kPatience) return;
    tried_ = now;
    if (writer_.trouble())
    {
        report();  // a failure must be reported even if it occurs only once
        if (!writer_.retry()) return;
    }
    note_no_room();
}

void AsyncWriter::note_no_room()
{
    recording::Losses lost;
    {
        const std::lock_guard lock(mutex_);
        lost = std::exchange(unnoted_, {});
    }
    if (lost.messages > 0) (void)writer_.add_gap(lost, "the disk was too slow for the data from the bus");
}

void AsyncWriter::report()
{
    const recording::Statistics statistics = writer_.statistics();
    const std::lock_guard lock(mutex_);
    progress_.messages = statistics.messages;
    progress_.bytes = writer_.file_size();
    progress_.trouble = writer_.trouble();
    if (writer_.trouble()) progress_.last_trouble = writer_.trouble();
    progress_.dropped = no_room_;
    progress_.dropped.add(writer_.dropped());
}

void AsyncWriter::note_end(const Result<void>& closed)
{
    const std::lock_guard lock(mutex_);
    progress_.is_ended = closed.ok();
    if (!closed) progress_.last_trouble = closed.error();
}

}  // namespace plab::recorder
