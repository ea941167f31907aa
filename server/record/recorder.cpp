#include "record/recorder.h"

#include <algorithm>
#include <cstdio>

#include "idl/identity.h"
#include "idl/recording/format.h"

namespace plab::record
{
namespace
{

/// Besides the frames in flight, this many are kept for reuse.
constexpr std::size_t kSpareFrames = 64;

/// The metadata and the attachment that the file starts with.
Result<void> introduce(recording::McapWriter& writer, const RecordOptions& o, const wire::Identity& self)
{
    const recording::Origin origin{.recorder = "plabd",
                                   .server = o.server,
                                   .version = o.version,
                                   .build = o.build,
                                   .host = self.host,
                                   .scene_file = o.scene_file,
                                   .started_ns = self.started_ns,
                                   .dt = o.dt,
                                   .threads = o.threads,
                                   .state_interval = o.state_interval,
                                   .moved_only = o.moved_only,
                                   .topics = o.topics};
    if (auto done = writer.add_metadata(recording::about(origin)); !done) return done;
    const auto* text = reinterpret_cast<const std::uint8_t*>(o.blueprint.data());
    return writer.attach(
        {0, static_cast<std::uint64_t>(self.started_ns), "blueprint.xml", "text/xml", recording::ByteView(text, o.blueprint.size())});
}

/// Logs what concerns the disk and the file.
std::function<void(recording::Notice, const std::string&)> log_of(const RecordOptions& o)
{
    return [log = o.log, argument = o.log_argument, file = o.file](recording::Notice notice, const std::string& why)
    {
        using recording::Notice;
        const std::string line = notice == Notice::Stalled     ? "recording is stalled, the simulation continues: " + why
                                 : notice == Notice::Continues ? "recording " + file + " continues: the disk accepts writes again"
                                                               : "recording " + file + ": " + why;
        if (log != nullptr)
            log(argument, line.c_str());
        else
            (void)std::fprintf(stderr, "%s\n", line.c_str());
    };
}

Result<void> check_topics(const std::vector<std::string>& topics)
{
    for (const std::string& topic : topics)
    {
        if (std::none_of(wire::topics().begin(), wire::topics().end(), [&](const wire::Topic& t) { return topic == t.name; }))
            return reason("'" + topic + "' is not a pLab topic");
        if (topic == wire::topic_of<plab_v2_FrameUpdate>().name)
            return reason("'" + topic + "' is not recorded: plab/states has the same frames, complete");
    }
    return {};
}

template <class Batch>
std::size_t size_of(const Batch& batch)
{
    return sizeof batch + batch.entries.size() * (sizeof(batch.entries[0]) + 64);
}

}  // namespace

Result<std::unique_ptr<Recorder>> Recorder::open(const RecordOptions& options)
{
    if (auto checked = check_topics(options.topics); !checked) return checked.errors();
    const auto compression = recording::parse_compression(options.compression);
    if (!compression) return compression.errors();
    recording::AsyncWriterOptions file;
    file.file = options.file, file.overwrite = options.overwrite, file.compression = *compression;
    file.most_waiting_bytes = options.most_waiting_bytes;
    file.too_slow = "the writer did not keep up with the simulation";
    file.notice = log_of(options);
    auto writer = recording::open_writer(file);
    if (!writer) return writer.errors();
    if (auto done = introduce(*writer, options, wire::identify(options.server, options.version)); !done) return done.errors();
    return std::unique_ptr<Recorder>(new Recorder(options, file, writer.take()));
}

Recorder::Recorder(const RecordOptions& options, const recording::AsyncWriterOptions& file, recording::McapWriter writer)
    : options_(options),
      topics_(wire::identify(options.server, options.version), options.topics, options.moved_only),
      spare_(kSpareFrames),
      writer_(std::move(writer), file, [this](recording::TopicFile& to, Entry& entry) { return write(to, entry); })
{
}

Recorder::~Recorder() { (void)close(); }

Result<void> Recorder::close()
{
    push(hash_batch_.flush());
    return writer_.close();
}

std::uint64_t Recorder::write(recording::TopicFile& file, Entry& entry)
{
    // Snapshots are serialized in parallel with the run and arrive late: they are placed at the time when they were taken, a
    // run's first one before the run.
    const auto* snapshot = std::get_if<wire::Snapshot>(&entry.body);
    const std::uint64_t log_time = snapshot ? timeline_.at(snapshot->run, snapshot->time) : timeline_.at(entry.run, entry.time);
    topics_.put(file, entry, {log_time, static_cast<std::uint64_t>(entry.stamp_ns), recording::Clock::now()});
    if (auto* frame = std::get_if<std::unique_ptr<wire::Frame>>(&entry.body)) (void)spare_.push(*frame);
    return log_time;
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
        case publish::Stream::Forces:
            return false;
        case publish::Stream::Contacts:
            return topics_.has(wire::topic_of<plab_v2_ContactForces>().name);
    }
    return false;
}

std::optional<double> Recorder::interval(publish::Stream stream) const
{
    if (stream == publish::Stream::States || stream == publish::Stream::Contacts) return options_.state_interval;
    if (stream == publish::Stream::Metrics) return options_.metrics_interval;
    if (stream == publish::Stream::Snapshots) return options_.snapshot_interval;
    return {};
}

bool Recorder::push(Entry::Body&& body, std::size_t bytes, Weight weight)
{
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return writer_.push({run_, time_, std::chrono::duration_cast<std::chrono::nanoseconds>(now).count(), std::move(body)}, bytes, weight);
}

wire::Frame& Recorder::begin_frame()
{
    if (!filling_)
        if (auto spare = spare_.pop()) filling_ = std::move(*spare);
    if (!filling_) filling_ = std::make_unique<wire::Frame>();
    return *filling_;
}

void Recorder::end_frame()
{
    const std::size_t bytes =
        sizeof(wire::Frame) + filling_->bodies.size() * sizeof(wire::BodyState) + filling_->shafts.size() * sizeof(wire::ShaftState);
    if (!writer_.has_room(bytes, Weight::Detail)) return writer_.drop(bytes);  // the frame stays here and is refilled
    (void)push(std::move(filling_), bytes, Weight::Detail);
}

void Recorder::end_contacts()
{
    std::size_t bytes = sizeof contacts_;
    for (const wire::ContactInfo& c : contacts_.entries) bytes += sizeof c + c.points.size() * sizeof(wire::ContactPoint);
    (void)push(std::exchange(contacts_, {}), bytes, Weight::Detail);
}

void Recorder::collisions(wire::Collisions&& batch)
{
    const std::size_t bytes = size_of(batch);
    (void)push(std::move(batch), bytes, Weight::Detail);
}

void Recorder::events(wire::Events&& batch)
{
    const std::size_t bytes = size_of(batch);
    (void)push(std::move(batch), bytes, Weight::Essential);
}

void Recorder::metrics(wire::Metrics&& metrics)
{
    const std::size_t bytes = sizeof metrics + metrics.interactions.size() * 512;
    (void)push(std::move(metrics), bytes, Weight::Detail);
}

void Recorder::image(wire::Image&& image)
{
    const std::size_t bytes = sizeof image + image.data.size();
    (void)push(std::move(image), bytes, Weight::Detail);
}

void Recorder::journal(wire::Journal&& entry)
{
    std::size_t bytes = sizeof entry;
    for (const wire::Operation& op : entry.operations) bytes += sizeof op + op.blueprint.size();
    (void)push(std::move(entry), bytes, Weight::Vital);
}

void Recorder::hash(std::uint64_t run, Tick step, std::uint64_t hash) { push(hash_batch_.add(run, step, hash, publish::monotonic_now())); }

void Recorder::push(std::optional<wire::Hashes> record)
{
    if (!record) return;
    const std::size_t bytes = sizeof *record + record->values.size() * sizeof(std::uint64_t);
    (void)push(*std::move(record), bytes, Weight::Vital);
}

void Recorder::snapshot(wire::Snapshot&& snapshot)
{
    const std::size_t bytes = sizeof snapshot + snapshot.data.size() + snapshot.blueprint.size();
    (void)push(std::move(snapshot), bytes, Weight::Essential);
}

void Recorder::status(const wire::Server& status)
{
    push(status.paused ? hash_batch_.flush() : hash_batch_.flush_old(publish::monotonic_now()));
    (void)push(wire::Server(status), sizeof status, Weight::Detail);
}

bool Recorder::catalogue(publish::CatalogueChange&& change)
{
    constexpr std::size_t kEntry = 1024;
    const std::size_t entries = change.objects.size() + change.shapes.size() + change.interactions.size() + change.types.size();
    std::size_t bytes = sizeof change + entries * kEntry;
    for (const wire::Shape& s : change.shapes) bytes += s.vertices.size() * sizeof(Vec3) + s.triangles.size() * 4;
    return push(std::move(change), bytes, Weight::Essential);
}

wire::RecordingInfo Recorder::progress() const
{
    const recording::WriteProgress p = writer_.progress();
    wire::RecordingInfo out;
    out.file = options_.file, out.bytes = p.bytes, out.messages = p.messages, out.dropped = p.dropped;
    if (p.trouble) out.trouble = p.trouble->reason;
    return out;
}

}  // namespace plab::record
