/// What the player sends: after a jump, the state at that time, then message by message.
#include "control/recording/player/player.h"
#include "idl/recording/whole_frame.h"

namespace plab::player
{
namespace
{

const std::string& states()
{
    static const std::string name = wire::topic_of<plab_v2_Frame>().name;
    return name;
}
const std::string& status()
{
    static const std::string name = wire::topic_of<plab_v2_Server>().name;
    return name;
}
const std::string& scene()
{
    static const std::string name = wire::topic_of<plab_v2_Scene>().name;
    return name;
}
const std::string& metrics()
{
    static const std::string name = wire::topic_of<plab_v2_Metrics>().name;
    return name;
}
const std::string& snapshots()
{
    static const std::string name = wire::topic_of<plab_v2_Snapshot>().name;
    return name;
}
const std::string& gone()
{
    static const std::string name = wire::topic_of<plab_v2_Gone>().name;
    return name;
}

}  // namespace

void Player::jump(std::uint64_t time)
{
    next_.reset();
    cursor_.emplace(reader_.messages({topics_, time, pace_.span().to}));
    for (const auto& [topic, track] : tracks_) track->jump();
    doomed_.clear();
    put_catalogue(retained_at(reader_, time));
    position_ = jumped_to_ = time;
    put_status(time);
    if (time == 0) return;
    // Messages of this very moment come next.
    put_latest(metrics(), time - 1);
    put_frame(time - 1);
}

/// Makes the bus show the wanted instances; unchanged ones are not sent again, unless a new run begins.
void Player::put_catalogue(RetainedSamples wanted)
{
    std::set<InstanceKey> leaving;
    for (const auto& [place, bytes] : retained_.entries())
        if (!wanted.has(place)) leaving.insert(place);
    dispose(leaving);
    const bool is_new_run = retained_shift_ != changes_.run_shift;
    // The scene comes after the objects that it counts.
    for (const bool wants_scene : {false, true})
        for (const auto& [place, bytes] : wanted.entries())
        {
            if ((place.first == scene()) != wants_scene) continue;
            const auto old = retained_.entries().find(place);
            if (is_new_run || old == retained_.entries().end() || old->second != bytes) send(place.first, bytes);
        }
    retained_ = std::move(wanted);
    retained_shift_ = changes_.run_shift;
}

void Player::put_status(std::uint64_t until)
{
    auto last = reader_.last_at(status(), until);
    if (last && !*last)
    {
        // Before its first sample: that sample is the best approximation.
        recording::Cursor cursor = reader_.messages({{status()}, until, pace_.span().to});
        const auto first = cursor.next();
        if (!first || !*first) return;
        if (!facade_.use((*first)->message.data)) ++broken_;
        return note_place(*statuses_, (*first)->message.data);
    }
    if (!last || !facade_.use((*last)->data))
        ++broken_;
    else
        note_place(*statuses_, (*last)->data);
}

void Player::put_latest(const std::string& topic, std::uint64_t until)
{
    if (track_of(topic) == nullptr) return;
    const auto last = reader_.last_at(topic, until);
    if (last && *last) send(topic, (*last)->data);
}

void Player::put_frame(std::uint64_t until)
{
    Track* const track = track_of(states());
    if (track == nullptr) return;
    const auto last = reader_.last_at(states(), until);
    if (!last || !*last) return;
    if (moved_only_)
    {
        // Back to the last full frame.
        constexpr auto kBack = static_cast<std::uint64_t>(1.5e9 * recording::kFullFrameEvery);
        const std::uint64_t end = (*last)->message.log_time;
        recording::Cursor before = reader_.messages({{states()}, end > kBack ? end - kBack : 0, end});
        for (auto found = before.next(); found && *found; found = before.next()) track->skip((*found)->message.data);
    }
    send(states(), (*last)->data);
    note_place(*frames_, (*last)->data);
}

bool Player::fetch()
{
    while (!next_)
    {
        auto found = cursor_->next();
        if (!found)
        {
            ++broken_;  // a damaged chunk: the cursor continues after it
            continue;
        }
        if (!*found) return false;
        next_ = **found;
    }
    return true;
}

void Player::send_next()
{
    const recording::Found found = *next_;
    const std::string& topic = found.channel->topic;
    const recording::ByteView bytes = found.message.data;
    const bool is_same_moment = found.message.log_time == position_;
    position_ = found.message.log_time;
    if (topic == gone())
        take_gone(bytes);
    else if (is_catalogue(topic))
        send_entry(found);
    else
    {
        if (!is_same_moment) dispose(std::exchange(doomed_, {}));
        if (topic == status())
        {
            if (!facade_.use(bytes)) ++broken_;
            note_place(*statuses_, bytes);
        }
        else if (track_of(topic) != nullptr)
            send(topic, bytes);
        if (topic == states()) note_place(*frames_, bytes);
    }
    next_.reset();
}

void Player::send_entry(const recording::Found& found)
{
    if (found.message.log_time == jumped_to_) return;  // the jump sent it already
    const std::string& topic = found.channel->topic;
    const auto place = retained_.put(topic, found.message.data);
    if (!place)
    {
        ++broken_;
        return;
    }
    doomed_.erase(*place);
    send(topic, found.message.data);
}

void Player::send(const std::string& topic, recording::ByteView bytes)
{
    Track* const track = track_of(topic);
    if (track == nullptr) return;
    if (track->send(bytes, changes_))
        ++sent_;
    else
        ++broken_;
}

void Player::take_gone(recording::ByteView bytes)
{
    if (position_ == jumped_to_) return;
    auto places = retained_.remove(bytes);
    if (places)
        doomed_.merge(*places);
    else
        ++broken_;
}

void Player::dispose(const std::set<InstanceKey>& places)
{
    for (const auto& [topic, key] : places)
        if (Track* const track = track_of(topic)) track->dispose(topic == scene() ? changes_.server : key);
}

void Player::note_place(recording::Peek& peek, recording::ByteView bytes)
{
    const auto header = peek.at(bytes);
    if (!header || !header->time) return;
    state_.run = header->run + changes_.run_shift;
    state_.step = header->step, state_.time = *header->time;
    highest_run_ = std::max(highest_run_, state_.run);
}

/// New readers get at once what a server would send them: of a paused playback its state, and a snapshot.
void Player::serve_new_readers()
{
    if (has_newcomers(states()) && pace_.is_paused())
    {
        track_of(states())->jump();
        put_frame(position_);
    }
    if (has_newcomers(snapshots())) put_latest(snapshots(), position_);
}

bool Player::has_newcomers(const std::string& topic)
{
    const Track* const track = track_of(topic);
    if (track == nullptr) return false;
    const wire::Matched readers = track->readers();
    const std::uint32_t before = std::exchange(seen_[topic], readers.ever);
    return readers.ever > before && readers.now > 0;
}

}  // namespace plab::player
