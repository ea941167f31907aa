#include "record/recorder.h"

#include <pthread.h>

#include <array>
#include <csignal>
#include <filesystem>

#include "idl/identity.h"
#include "idl/recording/format.h"

namespace plab::record
{
namespace
{

constexpr std::size_t kQueue = 16384;
/// Besides the frames in flight, this many are kept for reuse.
constexpr std::size_t kSpareFrames = 64;

Result<recording::Compression> compression_of(const std::string& name)
{
    if (name == "none") return recording::Compression::None;
    if (name == "lz4") return recording::Compression::Lz4;
    if (name == "zstd") return recording::Compression::Zstd;
    return reason("'" + name + "' is not a compression: use none, lz4 or zstd");
}

std::string number(double value)
{
    std::array<char, 32> text{};
    (void)std::snprintf(text.data(), text.size(), "%.17g", value);
    return text.data();
}

std::string joined(const std::vector<std::string>& words)
{
    std::string out;
    for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
    return out;
}

/// The metadata that the file starts with.
Result<void> introduce(recording::Writer& writer, const RecordOptions& o, const wire::Identity& self)
{
    recording::Metadata about{recording::kAbout, {}};
    about.values = {{"format", std::to_string(recording::kFormat)},
                    {"recorder", "plabd"},
                    {"server", o.server},
                    {"version", o.version},
                    {"build", o.build},
                    {"host", self.host},
                    {"started_ns", std::to_string(self.started_ns)},
                    {"scene_file", o.scene_file},
                    {"dt", number(o.dt)},
                    {"threads", std::to_string(o.threads)},
                    {"state_interval", number(o.state_interval)},
                    {"states", o.moved_only ? "moved" : "all"}};
    if (!o.topics.empty()) about.values["topics"] = joined(o.topics);
    if (auto done = writer.add_metadata(std::move(about)); !done) return done;
    const auto* text = reinterpret_cast<const std::uint8_t*>(o.blueprint.data());
    return writer.attach(
        {0, static_cast<std::uint64_t>(self.started_ns), "blueprint.xml", "text/xml", recording::ByteView(text, o.blueprint.size())});
}

Result<void> check_topics(const std::vector<std::string>& topics)
{
    for (const std::string& topic : topics)
        if (std::none_of(wire::topics().begin(), wire::topics().end(), [&](const wire::Topic& t) { return topic == t.name; }))
            return reason("'" + topic + "' is not a pLab topic");
    return {};
}

template <class T>
std::size_t size_of(const publish::Batch<T>& batch)
{
    return sizeof batch + batch.entries.size() * (sizeof(T) + 64);
}

}  // namespace

Result<std::unique_ptr<Recorder>> Recorder::open(const RecordOptions& options)
{
    if (auto checked = check_topics(options.topics); !checked) return checked.errors();
    const auto compression = compression_of(options.compression);
    if (!compression) return compression.errors();
    recording::WriterOptions file;
    file.compression = *compression;
    // Of the 20 ms that a kill may cost, a chunk takes 12, the gathering of hashes 3, and the sleep of the writer 2.
    file.chunk_time = std::chrono::milliseconds(12);
    auto writer = recording::Writer::create(options.file, file, options.overwrite ? recording::Overwrite::Yes : recording::Overwrite::No);
    if (!writer) return writer.errors();
    if (auto done = introduce(*writer, options, wire::identify(options.server, options.version)); !done) return done.errors();
    return std::unique_ptr<Recorder>(new Recorder(options, writer.take()));
}

Recorder::Recorder(const RecordOptions& options, recording::Writer writer)
    : options_(options),
      writer_(std::move(writer)),
      topics_(writer_, wire::identify(options.server, options.version), options.topics, options.moved_only),
      queue_(kQueue),
      spare_(kSpareFrames)
{
    progress_.file = options.file;
    sigset_t all, before;
    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    thread_ = std::thread([this] { run(); });
    (void)pthread_sigmask(SIG_SETMASK, &before, nullptr);
    (void)pthread_setname_np(thread_.native_handle(), "plab-record");
    // Batch: waking this thread does not preempt the step thread on the same core.
    const sched_param priority{};
    (void)pthread_setschedparam(thread_.native_handle(), SCHED_BATCH, &priority);
}

Recorder::~Recorder() { (void)close(); }

Result<void> Recorder::close()
{
    if (!closed_)
    {
        closed_ = true;
        push(hash_batch_.flush());
        stop_.store(true, std::memory_order_release);
        wake_up_.ring();
        thread_.join();
        if (const auto done = writer_.close(); !done) close_error_ = done.error();
        tell_progress();
        std::error_code no_size;
        if (const auto size = std::filesystem::file_size(options_.file, no_size); !no_size) progress_.bytes = size;
    }
    if (close_error_) return *close_error_;
    return {};
}

bool Recorder::wants(publish::Stream stream) const
{
    switch (stream)
    {
        case publish::Stream::States:
            return topics_.has(wire::topic_of<plab_v2_Frame>().name);
        case publish::Stream::Collisions:
            return topics_.has(wire::topic_of<plab_v2_Collisions>().name);
        case publish::Stream::Events:
            return topics_.has(wire::topic_of<plab_v2_Events>().name);
        case publish::Stream::Metrics:
            return topics_.has(wire::topic_of<plab_v2_Metrics>().name);
        case publish::Stream::Images:
            return topics_.has(wire::topic_of<plab_v2_Image>().name);
        case publish::Stream::Journal:
            return topics_.has(wire::topic_of<plab_v2_Journal>().name);
        case publish::Stream::Hashes:
            return topics_.has(wire::topic_of<plab_v2_Hashes>().name);
        case publish::Stream::Snapshots:
            return topics_.has(wire::topic_of<plab_v2_Snapshot>().name);
    }
    return false;
}

std::optional<double> Recorder::interval(publish::Stream stream) const
{
    if (stream == publish::Stream::States) return options_.state_interval;
    if (stream == publish::Stream::Metrics) return options_.metrics_interval;
    if (stream == publish::Stream::Snapshots) return options_.snapshot_interval;
    return {};
}

bool Recorder::has_room(std::size_t bytes, Weight weight) const
{
    if (weight == Weight::Vital) return queue_.size() < kQueue;
    const std::size_t part = weight == Weight::Detail ? 2 : 1;
    return queue_.size() < kQueue - kQueue / 4 * part &&
           waiting_bytes_.load(std::memory_order_relaxed) + bytes <= options_.most_waiting_bytes / part;
}

bool Recorder::push(Entry::Body&& body, std::size_t bytes, Weight weight)
{
    Entry entry;
    entry.run = run_, entry.time = time_, entry.bytes = bytes, entry.lost = lost_;
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    entry.stamp_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
    entry.body = std::move(body);
    // A single entry larger than the room is accepted when nothing else waits: a snapshot of a huge scene.
    const bool fits = has_room(bytes, weight) || (weight == Weight::Essential && queue_.size() == 0);
    waiting_bytes_.fetch_add(bytes, std::memory_order_relaxed);
    if (fits && queue_.push(entry))
    {
        lost_ = {};
        wake_up_.ring();
        return true;
    }
    waiting_bytes_.fetch_sub(bytes, std::memory_order_relaxed);
    ++lost_.messages, lost_.bytes += bytes;
    dropped_here_.fetch_add(1, std::memory_order_relaxed);
    return false;
}

publish::Frame& Recorder::begin_frame()
{
    if (!filling_)
        if (auto spare = spare_.pop()) filling_ = std::move(*spare);
    if (!filling_) filling_ = std::make_unique<publish::Frame>();
    return *filling_;
}

void Recorder::end_frame()
{
    const std::size_t bytes = sizeof(publish::Frame) + filling_->bodies.size() * sizeof(publish::BodyState) +
                              filling_->shafts.size() * sizeof(publish::ShaftState);
    if (!has_room(bytes, Weight::Detail))
    {
        // The frame stays here and is refilled.
        ++lost_.messages, lost_.bytes += bytes;
        dropped_here_.fetch_add(1, std::memory_order_relaxed);
        return;
    }
    (void)push(std::move(filling_), bytes, Weight::Detail);
}

void Recorder::collisions(publish::Batch<publish::CollisionRecord>&& batch)
{
    const std::size_t bytes = size_of(batch);
    (void)push(std::move(batch), bytes, Weight::Detail);
}

void Recorder::events(publish::Batch<publish::EventRecord>&& batch)
{
    const std::size_t bytes = size_of(batch);
    (void)push(std::move(batch), bytes, Weight::Essential);
}

void Recorder::metrics(publish::Metrics&& metrics)
{
    const std::size_t bytes = sizeof metrics + metrics.interactions.size() * 512;
    (void)push(std::move(metrics), bytes, Weight::Detail);
}

void Recorder::image(publish::Image&& image)
{
    const std::size_t bytes = sizeof image + image.rgba.size();
    (void)push(std::move(image), bytes, Weight::Detail);
}

void Recorder::journal(publish::JournalRecord&& entry)
{
    std::size_t bytes = sizeof entry;
    for (const publish::OperationText& op : entry.operations) bytes += sizeof op + op.blueprint.size();
    (void)push(std::move(entry), bytes, Weight::Vital);
}

void Recorder::hash(std::uint64_t run, Tick step, std::uint64_t hash) { push(hash_batch_.add(run, step, hash, publish::monotonic_now())); }

void Recorder::push(std::optional<publish::HashRecord> record)
{
    if (!record) return;
    const std::size_t bytes = sizeof *record + record->hashes.size() * sizeof(std::uint64_t);
    (void)push(*std::move(record), bytes, Weight::Vital);
}

void Recorder::snapshot(publish::SnapshotRecord&& snapshot)
{
    const std::size_t bytes = sizeof snapshot + snapshot.data.size() + snapshot.blueprint.size();
    (void)push(std::move(snapshot), bytes, Weight::Essential);
}

void Recorder::status(const publish::Status& status)
{
    push(status.paused ? hash_batch_.flush() : hash_batch_.flush_old(publish::monotonic_now()));
    (void)push(publish::Status(status), sizeof status, Weight::Detail);
}

bool Recorder::catalogue(publish::CatalogueChange&& change)
{
    constexpr std::size_t kEntry = 1024;
    const std::size_t entries = change.objects.size() + change.shapes.size() + change.interactions.size() + change.types.size();
    std::size_t bytes = sizeof change + entries * kEntry;
    for (const publish::ShapeEntry& s : change.shapes) bytes += s.geometry.vertices.size() * sizeof(Vec3) + s.geometry.triangles.size() * 4;
    return push(std::move(change), bytes, Weight::Essential);
}

publish::RecordingStatus Recorder::progress() const
{
    const std::lock_guard lock(mutex_);
    publish::RecordingStatus out = progress_;
    out.dropped += dropped_here_.load(std::memory_order_relaxed);
    return out;
}

}  // namespace plab::record
