#include "control/recording/player/player.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "idl/recording/format.h"

namespace plab::player
{
namespace
{

constexpr std::chrono::seconds kHeartbeat(1);
constexpr std::chrono::milliseconds kGoodbye(200);
constexpr int kBurst = 256;  ///< messages that are sent before requests and keys get their turn

Span span_of(const recording::FileIndex& index)
{
    if (index.chunks.empty()) return {};
    return {index.chunks.front().start_time, index.latest_before.back()};
}

Result<std::uint64_t> time_of(double seconds, const char* option)
{
    constexpr double kLast = 9e9;  // s; in ns it still fits 64 bits
    if (!(seconds >= 0) || seconds > kLast) return reason(std::string(option) + " must be from 0 to 9e9 s");
    return static_cast<std::uint64_t>(std::llround(seconds * 1e9));
}

std::string seconds_text(std::uint64_t time)
{
    std::string out = std::to_string(static_cast<double>(time) * 1e-9);
    return out + " s";
}

/// When there is something to see; the start of the recording if there never is.
std::uint64_t first_state(const recording::McapReader& reader, std::uint64_t start)
{
    recording::Cursor states = reader.messages({{wire::topic_of<plab_v2_Frame>().name}});
    const auto first = states.next();
    return first && *first ? (*first)->message.log_time : start;
}

/// The requested part of the recording.
Result<Span> choose_span(const recording::McapReader& reader, const PlaybackOptions& options)
{
    const Span all = span_of(reader.index());
    Span out = all;
    if (options.from_first_state && !options.from) out.from = all.within(first_state(reader, all.from));
    for (const auto& [seconds, option, end] : {std::tuple(&options.from, "--from", &out.from), std::tuple(&options.to, "--to", &out.to)})
    {
        if (!*seconds) continue;
        const auto time = time_of(**seconds, option);
        if (!time) return time.errors();
        *end = *time;
    }
    if (out.from > all.to || out.to < all.from || out.from > out.to)
        return reason(reader.name() + ": has no messages from " + seconds_text(out.from) + " to " + seconds_text(out.to) + ": it covers " +
                      seconds_text(all.from) + " to " + seconds_text(all.to));
    return Span{all.within(out.from), all.within(out.to)};
}

Result<std::string> choose_name(const recording::McapReader& reader, const std::string& asked)
{
    if (!asked.empty()) return asked;
    const auto about = reader.metadata(recording::kAbout);
    if (about && about->values.contains("server")) return about->values.at("server");
    return reason(reader.name() + ": does not contain the name of its server: give the playback a name (--name)");
}

}  // namespace

Result<std::unique_ptr<Player>> Player::open(const PlaybackOptions& options)
{
    auto reader = recording::open_recording(options.file);
    if (!reader) return reader.errors();
    const auto span = choose_span(*reader, options);
    if (!span) return span.errors();
    const auto name = choose_name(*reader, options.name);
    if (!name) return name.errors();
    auto front = ServerFacade::open(options.domain.id, *name, options.version, options.file);
    if (!front) return front.errors();
    const Pace pace(*span, options.rate, options.paused, Clock::now());
    std::unique_ptr<Player> out(new Player(reader.take(), front.take(), pace, options));
    if (auto joined = out->join(options); !joined) return joined.errors();
    return out;
}

Player::Player(recording::McapReader reader, ServerFacade front, const Pace& pace, const PlaybackOptions& options)
    : reader_(std::move(reader)),
      facade_(std::move(front)),
      pace_(pace),
      loop_(options.loop),
      frames_(recording::make_peek(wire::topic_of<plab_v2_Frame>())),
      statuses_(recording::make_peek(wire::topic_of<plab_v2_Server>())),
      wanted_readers_(options.readers)
{
    changes_.server = facade_.name();
    if (const auto about = reader_.metadata(recording::kAbout); about && about->values.contains("states"))
        moved_only_ = about->values.at("states") == "moved";
}

Result<void> Player::join(const PlaybackOptions& options)
{
    auto participant = wire::join(options.domain);
    if (!participant) return participant.errors();
    participant_ = participant.take();
    auto publisher = wire::make_publisher(participant_, facade_.name());
    if (!publisher) return publisher.errors();
    auto subscriber = wire::make_subscriber(participant_, facade_.name());
    if (!subscriber) return subscriber.errors();
    publisher_ = publisher.take(), subscriber_ = subscriber.take();
    if (auto made = make_tracks(); !made) return made;
    if (auto joined = facade_.join(participant_, publisher_, subscriber_); !joined) return joined;
    waitset_ = wire::Entity(dds_create_waitset(participant_.get()));
    const dds_entity_t condition = dds_create_readcondition(facade_.requests().get(), DDS_ANY_STATE);
    if (const auto code = dds_waitset_attach(waitset_.get(), condition, 0); code < 0) return wire::failed("cannot wait for requests", code);
    return {};
}

Result<void> Player::make_tracks()
{
    for (const auto& [id, channel] : reader_.channels())
    {
        const recording::Schema* const schema = reader_.schema_of(channel);
        const auto all = wire::topics();
        const auto topic =
            std::find_if(all.begin(), all.end(), [&, &channel = channel](const wire::Topic& t) { return channel.topic == t.name; });
        const bool is_ours =
            topic != all.end() && channel.message_encoding == "cdr" && (schema == nullptr || schema->name == topic->type->m_typename);
        if (!is_ours)
        {
            foreign_.push_back(channel.topic);
            continue;
        }
        topics_.push_back(channel.topic);
        if (!is_played(*topic) || tracks_.contains(channel.topic)) continue;
        auto track = make_track(*topic, participant_, publisher_, moved_only_);
        if (!track) return track.errors();
        tracks_.emplace(channel.topic, track.take());
    }
    if (tracks_.empty()) return reason(reader_.name() + ": has no pLab topic");
    return {};
}

Player::~Player()
{
    const Clock::time_point end = Clock::now() + kGoodbye;
    const auto left = [&] { return std::max<dds_duration_t>(0, std::chrono::nanoseconds(end - Clock::now()).count()); };
    std::set<InstanceKey> all;
    for (const auto& [place, bytes] : retained_.entries()) all.insert(place);
    dispose(all);
    // Data that has not arrived by then is lost: a hanging reader must not delay the end.
    for (const auto& [topic, track] : tracks_) track->flush(left());
    facade_.leave(left());
}

std::uint32_t Player::readers() const
{
    const auto states = tracks_.find(wire::topic_of<plab_v2_Frame>().name);
    return states == tracks_.end() ? 0 : states->second->readers().now;
}

/// Many clients read the catalogue before they read states.
void Player::show_scene()
{
    if (!retained_.entries().empty()) return;
    put_status(pace_.span().from);
    put_catalogue(retained_at(reader_, pace_.span().from));
}

void Player::begin(Clock::time_point now)
{
    has_begun_ = true;
    pace_.seek(pace_.span().from, now);
    jump(pace_.span().from);
}

Result<void> Player::step(Clock::time_point now)
{
    if (const auto why = facade_.find_rival()) return reason(*why);
    facade_.answer(state_);
    if (!has_begun_ && readers() < wanted_readers_)
    {
        show_scene();
        report_status(now, false);
        return {};
    }
    if (!has_begun_) begin(now);
    send_due(now);
    serve_new_readers();
    report_status(now, false);
    return {};
}

void Player::send_due(Clock::time_point now)
{
    const std::uint64_t position = pace_.position(now);
    for (int i = 0; i < kBurst; ++i)
    {
        if (!fetch()) return end_or_loop(now);
        if (next_->message.log_time > position) break;
        send_next();
    }
    if (next_ && next_->message.log_time > position_) dispose(std::exchange(doomed_, {}));
}

void Player::end_or_loop(Clock::time_point now)
{
    dispose(std::exchange(doomed_, {}));
    if (pace_.is_paused() || !pace_.at_end(now)) return;
    if (loop_ && pace_.span().to > pace_.span().from)
        jump_back(pace_.span().from, now);
    else
        is_over_ = true;
}

void Player::wait(Clock::time_point latest)
{
    std::optional<Clock::time_point> due;
    if (has_begun_) due = pace_.when(fetch() ? next_->message.log_time : pace_.span().to);
    const Clock::time_point until = std::min({latest, due.value_or(latest), published_at_ + kHeartbeat});
    const std::chrono::nanoseconds left = until - Clock::now();
    if (left.count() > 0) (void)dds_waitset_wait(waitset_.get(), nullptr, 0, left.count());
}

void Player::pause(bool paused, Clock::time_point now)
{
    pace_.pause(paused, now);
    report_status(now, true);
}

void Player::set_rate(double rate, Clock::time_point now)
{
    pace_.set_rate(rate, now);
    report_status(now, true);
}

void Player::seek(std::uint64_t time, Clock::time_point now)
{
    const std::uint64_t target = pace_.span().within(time);
    if (!has_begun_) return;
    if (target < position_) return jump_back(target, now);
    pace_.seek(target, now);
    jump(target);
    report_status(now, true);
}

void Player::jump_back(std::uint64_t time, Clock::time_point now)
{
    pace_.seek(time, now);
    // Run numbers continue to increase: clients have not seen a run of this number.
    changes_.run_shift = highest_run_ + 1 - std::min(run_at(time), highest_run_ + 1);
    jump(time);
    report_status(now, true);
}

std::uint64_t Player::run_at(std::uint64_t time) const
{
    const auto run = [](recording::Peek& peek, const Result<std::optional<recording::Kept>>& kept) -> std::uint64_t
    {
        if (!kept || !*kept) return 0;
        const auto header = peek.at((*kept)->data);
        return header ? header->run : 0;
    };
    const std::uint64_t of_status = run(*statuses_, reader_.last_at(wire::topic_of<plab_v2_Server>().name, time));
    const std::uint64_t of_frame = run(*frames_, reader_.last_at(wire::topic_of<plab_v2_Frame>().name, time));
    return std::max(of_status, of_frame);
}

void Player::report_status(Clock::time_point now, bool at_once)
{
    if (!at_once && now - published_at_ < kHeartbeat) return;
    const double gone = link::Seconds(now - published_at_).count();
    const std::uint64_t position = pace_.position(now);
    const double advance = static_cast<double>(position) - static_cast<double>(published_position_);
    if (!at_once) state_.rate_reached = std::max(0.0, advance * 1e-9 / gone);
    published_at_ = now, published_position_ = position;
    state_.is_paused = pace_.is_paused(), state_.rate_asked = pace_.rate();
    const auto shift = [&](const char* topic)
    {
        const Track* const track = track_of(topic);
        return track == nullptr ? 0 : track->number_shift();
    };
    state_.run_shift = changes_.run_shift;
    state_.event_shift = shift(wire::topic_of<plab_v2_Events>().name);
    state_.collision_shift = shift(wire::topic_of<plab_v2_Collisions>().name);
    facade_.send(state_);
}

Track* Player::track_of(const std::string& topic)
{
    const auto found = tracks_.find(topic);
    return found == tracks_.end() ? nullptr : found->second.get();
}

}  // namespace plab::player
