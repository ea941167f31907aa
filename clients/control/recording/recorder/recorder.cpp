#include "control/recording/recorder/recorder.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "idl/recording/format.h"

namespace plab::recorder
{
namespace
{

constexpr std::chrono::seconds kReportEvery(1);  ///< gaps of one topic are reported together
/// Times that differ by less are the same (s): far below any step, far above the rounding of n * dt.
constexpr double kSameTime = 1e-9;

template <class T>
bool is_topic(const wire::Topic& topic)
{
    return std::strcmp(topic.name, wire::topic_of<T>().name) == 0;
}

/// How many samples may wait to be taken, per instance. A dedicated thread takes them.
std::int32_t depth_of(wire::Delivery delivery)
{
    switch (delivery)
    {
        case wire::Delivery::Newest:
            return 256;  // of 1000 bodies: 27 MB
        case wire::Delivery::Catalogue:
            return 64;
        case wire::Delivery::Log:
        case wire::Delivery::Request:
        case wire::Delivery::Reply:
            break;
    }
    return 4096;
}

/// Samples between the bus and the disk; at 1000 samples a second, a disk that stops for 48 s.
constexpr std::size_t kMostWaiting = 65536;

recording::Origin origin_of(const link::ServerInfo& server, const RecorderOptions& options)
{
    return {.recorder = "plabctl",
            .server = server.name,
            .version = server.version,
            .build = "",
            .host = server.host,
            .scene_file = server.scene_file,
            .started_ns = server.started_ns,
            .dt = server.dt,
            .threads = server.threads,
            .state_interval = options.state_rate ? 1 / *options.state_rate : 0,
            .moved_only = false,
            .topics = options.topics};
}

recording::AsyncWriterOptions writer_options(const RecorderOptions& options)
{
    recording::AsyncWriterOptions out = options.writer;
    out.most_waiting = kMostWaiting;
    out.too_slow = "the disk was too slow for the data from the bus";
    return out;
}

/// On the writer's thread.
std::uint64_t write_waiting(recording::TopicFile& file, Waiting& waiting)
{
    if (const auto* message = std::get_if<Message>(&waiting.what))
        file.write(*message->topic, message->data, {waiting.log_time, message->publish_time, recording::Clock::now()});
    else if (const auto* gap = std::get_if<Gap>(&waiting.what))
        file.add_gap(gap->losses, gap->why);
    else if (auto* blueprint = std::get_if<Blueprint>(&waiting.what))
        file.attach(waiting.log_time, "blueprint.xml", "text/xml", std::move(blueprint->text));
    return waiting.log_time;
}

}  // namespace

Result<std::vector<const wire::Topic*>> choose_topics(const std::vector<std::string>& names)
{
    // plab/updates has the frames of plab/states once more; a recording holds complete ones.
    const auto on_bus = [](const wire::Topic& t) { return !is_topic<plab_v2_Gone>(t) && !is_topic<plab_v2_FrameUpdate>(t); };
    // Pictures and contacts are large; what people send is in the journal as it took effect.
    const auto is_by_itself = [](const wire::Topic& t)
    {
        return !is_topic<plab_v2_Image>(t) && !is_topic<plab_v2_ViewerSample>(t) && !is_topic<plab_v2_UserSample>(t) &&
               !is_topic<plab_v2_Forces>(t) && !is_topic<plab_v2_ContactForces>(t);
    };
    std::vector<const wire::Topic*> out;
    for (const wire::Topic& t : wire::topics())
    {
        const bool is_named = std::find(names.begin(), names.end(), t.name) != names.end();
        if (on_bus(t) && (is_named || (names.empty() && is_by_itself(t)))) out.push_back(&t);
    }
    for (const std::string& name : names)
        if (std::none_of(out.begin(), out.end(), [&](const wire::Topic* t) { return name == t->name; }))
            return name == wire::topic_of<plab_v2_FrameUpdate>().name
                       ? reason("'" + name + "' is not recorded: plab/states has the same frames, complete")
                       : reason("'" + name + "' is not a pLab topic: plabctl topics lists them");
    // States last: a client that sees their reader knows that the others exist.
    std::stable_partition(out.begin(), out.end(), [](const wire::Topic* t) { return !is_topic<plab_v2_Frame>(*t); });
    return out;
}

Recorder::Recorder(const RecorderOptions& options, const link::ServerInfo& server, recording::McapWriter writer)
    : options_(options),
      started_ns_(server.started_ns),
      run_(server.run),
      writer_(std::move(writer), writer_options(options), write_waiting)
{
    // The recording begins now, whichever sample comes first.
    (void)timeline_.at(server.run, server.time);
}

Result<std::unique_ptr<Recorder>> Recorder::open(const link::Session& session, const link::ServerInfo& server,
                                                 const RecorderOptions& options)
{
    auto topics = choose_topics(options.topics);
    if (!topics) return topics.errors();
    // Without plab/server, the end of the server would go unnoticed.
    const wire::Topic* const presence = &wire::topic_of<plab_v2_Server>();
    if (std::find(topics->begin(), topics->end(), presence) == topics->end()) topics->insert(topics->begin(), presence);
    auto writer = recording::open_writer(options.writer);
    if (!writer) return writer.errors();
    if (auto added = writer->add_metadata(recording::about(origin_of(server, options))); !added) return added.errors();
    std::unique_ptr<Recorder> out(new Recorder(options, server, writer.take()));
    if (auto subscribed = out->subscribe(session, *topics); !subscribed) return subscribed.errors();
    return out;
}

Result<void> Recorder::subscribe(const link::Session& session, const std::vector<const wire::Topic*>& topics)
{
    waitset_ = wire::Entity(dds_create_waitset(session.participant().get()));
    for (const wire::Topic* topic : topics)
    {
        auto reader = link::RawReader::open(session, *topic, depth_of(topic->delivery));
        if (!reader) return reader.errors();
        // A condition, unlike a status, stays true while samples are left.
        const dds_entity_t condition = dds_create_readcondition(reader->entity().get(), DDS_ANY_STATE);
        if (const auto code = dds_waitset_attach(waitset_.get(), condition, 0); code < 0)
            return wire::failed(std::string("cannot wait for ") + topic->name, code);
        Track track;
        track.topic = topic, track.reader = reader.take(), track.peek = recording::make_peek(*topic);
        tracks_.push_back(std::move(track));
    }
    return {};
}

State Recorder::step(link::Seconds longest)
{
    if (state_ != State::Running) return state_;
    (void)dds_waitset_wait(waitset_.get(), nullptr, 0, link::duration_of(longest));
    take_all();
    const auto now = Clock::now();
    write(disposals_.take(now));
    if (now - reported_at_ >= kReportEvery) reported_at_ = now, report_gaps();
    return state_;
}

Result<void> Recorder::close()
{
    if (state_ == State::Running) take_all();
    // The latest disposals count, except those of a server's end.
    if (state_ == State::Running || state_ == State::Done) write(disposals_.take(Clock::time_point::max()));
    report_gaps();
    return writer_.close();
}

/// Topics arrive independently; the time stamps of the server's single writing thread give the order in which it wrote. In any
/// other order a new run could seem to begin in the middle.
void Recorder::take_all()
{
    arrived_.clear();
    for (Track& track : tracks_) take(track);
    const auto earlier = [](const Arrived& a, const Arrived& b) { return a.written_ns < b.written_ns; };
    std::stable_sort(arrived_.begin(), arrived_.end(), earlier);
    for (Arrived& sample : arrived_) process(sample);
}

void Recorder::take(Track& track)
{
    // A topic that never pauses must not keep the others waiting forever.
    constexpr std::size_t kMost = 256;
    std::size_t taken = 0, batch = 0;
    do {
        batch = track.reader.take(
            [&](const link::RawSample& sample)
            {
                const auto* const begin = reinterpret_cast<const std::uint8_t*>(sample.bytes.data());
                arrived_.push_back(
                    {&track, {begin, begin + sample.bytes.size()}, sample.has_value, sample.is_gone, sample.written_ns, sample.writer});
            });
        taken += batch;
    } while (batch > 0 && taken < kMost);
}

void Recorder::process(Arrived& sample)
{
    if (state_ != State::Running) return;
    if (sample.is_gone) return process_gone(sample);
    if (!sample.has_value) return;
    Track& track = *sample.track;
    const auto header = track.peek->at(sample.data);
    if (!header)
    {
        ++broken_;
        return;
    }
    if (is_topic<plab_v2_Server>(*track.topic)) note_server(*header);
    if (state_ != State::Running) return;
    const std::uint64_t log_time = header->time && header->run > 0 ? timeline_.at(header->run, *header->time) : timeline_.now();
    run_ = std::max(run_, header->run);
    if (header->entries > 0) note_gap(track, *header, sample.writer, log_time);
    track.last_log_time = log_time;
    const auto stamp_ns = static_cast<std::uint64_t>(header->stamp_ns > 0 ? header->stamp_ns : sample.written_ns);
    if (!is_left_out(track, *header)) keep(track, *header, log_time, {track.topic, stamp_ns, std::move(sample.data)});
    const bool has_time = is_topic<plab_v2_Frame>(*track.topic) || is_topic<plab_v2_Server>(*track.topic);
    if (options_.until && has_time && *header->time >= *options_.until - kSameTime) state_ = State::Done;
}

void Recorder::keep(const Track& track, const recording::SampleHeader& header, std::uint64_t log_time, Message&& message)
{
    if (!header.key.empty()) write(disposals_.take_before_return(track.topic->name, header.key));
    if (!has_blueprint_ && !header.blueprint.empty())
    {
        has_blueprint_ = true;
        (void)writer_.push({log_time, Blueprint{header.blueprint}}, header.blueprint.size(), recording::Weight::Vital);
    }
    put(log_time, std::move(message));
}

void Recorder::put(std::uint64_t log_time, Message&& message)
{
    const std::size_t bytes = sizeof(Waiting) + message.data.size();
    (void)writer_.push({log_time, std::move(message)}, bytes, recording::Weight::Essential);  // what finds no room is counted there
}

void Recorder::process_gone(const Arrived& sample)
{
    const wire::Topic& topic = *sample.track->topic;
    if (is_topic<plab_v2_Server>(topic))
    {
        state_ = State::Gone;
        disposals_.forget();
        return;
    }
    const std::string key = recording::key_of_gone(sample.data);
    // Metrics and replies have no instances that a scene could lose.
    if (key.empty() || is_topic<plab_v2_Reply>(topic)) return;
    disposals_.add({topic.name, key, run_, timeline_.now(), static_cast<std::uint64_t>(sample.written_ns)}, Clock::now());
}

void Recorder::note_server(const recording::SampleHeader& header)
{
    if (header.started_ns == started_ns_) return;
    state_ = State::Restarted;
    disposals_.forget();
}

void Recorder::note_gap(Track& track, const recording::SampleHeader& header, std::uint64_t writer, std::uint64_t log_time)
{
    const auto missing = track.numbers.note(writer, header.first, header.entries);
    track.missing.add({missing.count, 0, track.last_log_time, log_time});
}

bool Recorder::is_left_out(const Track& track, const recording::SampleHeader& header)
{
    const bool is_asked_for =
        options_.topics.empty() || std::find(options_.topics.begin(), options_.topics.end(), track.topic->name) != options_.topics.end();
    if (!is_asked_for) return true;
    if (!options_.state_rate || !is_topic<plab_v2_Frame>(*track.topic)) return false;
    if (!next_frame_ || next_frame_->first != header.run) next_frame_ = {header.run, *header.time};
    if (*header.time < next_frame_->second - kSameTime) return true;
    // On a fixed grid, so that a late frame does not delay all following ones.
    const double interval = 1 / *options_.state_rate;
    next_frame_->second += interval * std::max(1.0, std::ceil((*header.time + kSameTime - next_frame_->second) / interval));
    return false;
}

void Recorder::write(const std::vector<Disposal>& disposals)
{
    for (const Disposal& p : disposals)
    {
        plab_v2_Gone gone{};
        std::string topic = p.topic, key = p.key;
        gone.run = p.run, gone.topic_name = topic.data(), gone.component_id = key.data();
        const auto bytes = encoder_.encode(gone);
        if (!bytes) continue;  // two texts and a number always form a sample
        put(p.log_time, {&wire::topic_of<plab_v2_Gone>(), p.publish_time, recording::Bytes(bytes->begin(), bytes->end())});
    }
}

void Recorder::report_gaps()
{
    for (Track& track : tracks_)
    {
        if (track.missing.messages == 0) continue;
        missing_ += track.missing.messages;
        Gap gap{track.missing, std::string(track.topic->name) + ": lost on the bus"};
        (void)writer_.push({track.last_log_time, std::move(gap)}, sizeof(Waiting), recording::Weight::Vital);
        track.missing = {};
    }
}

}  // namespace plab::recorder
