#include "foxglove/connection.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "foxglove/services.h"
#include "idl/samples.h"

namespace plab::foxglove
{
namespace
{

constexpr link::Seconds kNap(0.005), kIdleNap(0.05);
constexpr link::Parts kParts =
    link::Part::Server | link::Part::Scene | link::Part::Objects | link::Part::Shapes | link::Part::Interactions | link::Part::Metrics;

MessagePtr content_of(const std::string& cdr) { return std::make_shared<Message>(Message::binary(std::string_view(cdr))); }

std::string reasons_of(const link::Reply& reply)
{
    std::string out = reply.outcome;
    for (const std::string& why : reply.reasons) out += (&why == &reply.reasons.front() ? ": " : "; ") + why;
    return out;
}

DrawnScene drawn(const link::CatalogueContents& now) { return {now.objects, now.shapes}; }

}  // namespace

Result<std::unique_ptr<Connection>> Connection::open(const link::Session& session, Clients& clients, Audience& audience, Playback* playback,
                                                     const link::Stop& stop)
{
    constexpr link::Seconds kLongest(5);
    auto caller = link::Caller::make(session, kLongest, stop);
    if (!caller) return caller.errors();
    std::unique_ptr<Connection> out(new Connection(session, clients, audience, playback, caller.take()));
    auto catalogue = link::Catalogue::open(session, kParts);
    if (!catalogue) return catalogue.errors();
    out->catalogue_ = catalogue.take();
    if (auto fetched = out->catalogue_->fetch(kLongest, stop); !fetched) return fetched.errors();
    const link::CatalogueContents& now = out->catalogue_->now();
    if (now.server) out->started_ns_ = now.server->started_ns, out->note_time(now.server->time);
    out->version_ = out->catalogue_->version();
    out->sent_ = drawn(now);
    out->frame_writer_.use(now.objects), out->contact_arrows_.use(out->sent_);
    audience.begin_anew();
    return out;
}

bool Connection::step()
{
    has_news_ = false;
    subscribe();
    if (frames_)
        (void)session_.wait(*frames_, kNap);
    else
        (void)catalogue_->wait(readers_.empty() ? kIdleNap : kNap);
    take_catalogue();
    take_topics();
    take_frames();
    take_contacts();
    requests_.update();
    send_scene();
    send_kept();
    audience_.report_losses();
    return has_news_;
}

void Connection::close() { requests_.give_up("the server has gone; whether it did this is unknown"); }

void Connection::say(ClientId client, const Json& json)
{
    clients_.say(client, text_message(json));
    has_news_ = true;
}

void Connection::put(const Channel& channel, std::uint64_t instance, const Stamped& message)
{
    clients_.put(channel, instance, message);
    has_news_ = true;
}

/// ns. Of a recording the place on its time line, which goes on when a run begins anew.
std::uint64_t Connection::stamp_of(std::optional<double> time) const
{
    if (playback_ != nullptr) return playback_->time();
    const double seconds = time.value_or(time_);
    constexpr double kLongest = 9e9;
    return std::isfinite(seconds) && seconds > 0 ? static_cast<std::uint64_t>(std::llround(std::min(seconds, kLongest) * 1e9)) : 0;
}

void Connection::note_time(double time)
{
    time_ = time;
    clients_.tell_time(stamp_of(time));
    has_news_ = true;
}

/// Nobody looks: then nothing is read, and the server need not write it.
void Connection::subscribe()
{
    for (const Channel& channel : channels())
    {
        if (channel.source == nullptr) continue;
        const bool wanted = audience_.wants(channel);
        if (!wanted)
            readers_.erase(channel.id);
        else if (!readers_.contains(channel.id))
            if (auto reader = TopicReader::open(session_, *channel.source)) readers_.emplace(channel.id, reader.take());
    }
    const bool wants_contacts = audience_.wants(channel_of(kContactsTopic));
    if (wants_contacts && !contacts_)
        if (auto contacts = session_.reader<plab_v2_ContactForces>()) contacts_ = contacts.take();
    if (!wants_contacts) contacts_.reset();
    const bool wanted = audience_.wants(channel_of(kFramesTopic));
    if (wanted == frames_.has_value()) return;
    frames_.reset(), transforms_.reset();
    if (!wanted) return;
    if (auto frames = link::FrameReader::open(session_)) frames_ = frames.take();
    send_resting_frames();
}

/// A run that has just begun may be paused, and its only frame may have come before its objects: where they are is in the catalogue.
void Connection::send_resting_frames()
{
    const std::uint64_t stamp = stamp_of({});
    transforms_ = Stamped{content_of(frame_writer_.transforms(catalogue_->now().objects, stamp)), stamp};
    put(channel_of(kFramesTopic), 0, *transforms_);
    frames_run_ = run_;
}

void Connection::take_catalogue()
{
    (void)catalogue_->update();
    const link::CatalogueContents& now = catalogue_->now();
    is_over_ = catalogue_->server_is_gone() || (now.server && now.server->started_ns != started_ns_);
    if (is_over_ || !now.server) return;
    run_ = now.server->run;
    const double time = now.metrics && now.metrics->run == run_ ? std::max(now.server->time, now.metrics->time) : now.server->time;
    if ((!frames_ || now.server->paused) && time != time_) note_time(time);
    constexpr std::chrono::milliseconds kBetween(50);
    const auto moment = std::chrono::steady_clock::now();
    if (catalogue_->version() == version_ || moment - compared_at_ < kBetween) return;
    compared_at_ = moment;
    version_ = catalogue_->version();
    DrawnScene drawn_now = drawn(now);
    const std::uint64_t stamp = stamp_of({});
    for (const std::string& update : scene_changes(sent_, drawn_now, stamp)) put(channel_of(kSceneTopic), 0, {content_of(update), stamp});
    sent_ = std::move(drawn_now);
    frame_writer_.use(now.objects), contact_arrows_.use(sent_);
    audience_.send_parameters(now);
    if (frames_ && now.server->paused && frames_run_ != run_) send_resting_frames();
    has_news_ = true;
}

void Connection::take_topics()
{
    for (auto& [id, reader] : readers_) take_topic(*find_channel(id), reader);
}

void Connection::take_topic(const Channel& channel, TopicReader& reader)
{
    reader.take(
        [&](const TopicReader::Sample& sample)
        {
            const std::uint64_t stamp = stamp_of(sample.time);
            reader.keep(sample, stamp);
            if (sample.content != nullptr)
                put(channel, sample.instance, {sample.content, stamp});
            else if (channel.keep == Keep::Newest && !sample.gone.empty())
                tell_gone(channel, sample.gone);
        });
}

/// A topic of the bus says by itself that an instance is gone; to clients of Foxglove plab/gone says so, as in recordings.
void Connection::tell_gone(const Channel& channel, const std::string& key)
{
    static const Channel& gone = channel_of(wire::topic_of<plab_v2_Gone>().name);
    if (!audience_.wants(gone)) return;
    plab_v2_Gone sample{};
    sample.run = run_, sample.topic_name = wire::text(channel.topic), sample.component_id = wire::text(key);
    if (const auto bytes = encoder_.encode(sample)) put(gone, 0, {content_of(std::string(bytes->begin(), bytes->end())), stamp_of({})});
}

void Connection::take_frames()
{
    if (!frames_) return;
    std::string newest;
    double time = 0;
    (void)frames_->take(
        [&](const plab_v2_Frame& frame)
        {
            time = frame.time, frames_run_ = frame.run;
            newest = frame_writer_.transforms(frame, stamp_of(frame.time));
        });
    if (newest.empty()) return;
    transforms_ = Stamped{content_of(newest), stamp_of(time)};
    put(channel_of(kFramesTopic), 0, *transforms_);
    note_time(time);
}

void Connection::take_contacts()
{
    if (!contacts_) return;
    std::optional<wire::ContactForces> newest;
    (void)contacts_->take(
        [&](const plab_v2_ContactForces& sample, const dds_sample_info_t& info)
        {
            if (info.valid_data) newest = wire::value_of<wire::ContactForces>(sample);
        });
    if (!newest) return;
    const std::uint64_t stamp = stamp_of(newest->time);
    put(channel_of(kContactsTopic), 0, {content_of(contact_arrows_.update(*newest, sent_, stamp)), stamp});
}

/// To those who have just subscribed.
void Connection::send_kept()
{
    for (const Audience::Subscription& subscription : audience_.new_ones())
        clients_.with(subscription.client,
                      [&](Outbox& outbox)
                      {
                          has_news_ = true;
                          if (subscription.channel->topic == kFramesTopic && transforms_) outbox.put_to(subscription.id, 0, *transforms_);
                          const auto reader = readers_.find(subscription.channel->id);
                          if (reader == readers_.end()) return;
                          for (const auto& [instance, message] : reader->second.kept()) outbox.put_to(subscription.id, instance, message);
                      });
}

void Connection::send_scene()
{
    const auto wanting = audience_.wanting_whole();
    if (wanting.empty()) return;
    const std::uint64_t stamp = stamp_of({});
    std::vector<Stamped> whole;
    for (const std::string& update : whole_scene(sent_, stamp)) whole.push_back({content_of(update), stamp});
    for (const Audience::Subscription& s : wanting) clients_.with(s.client, [&](Outbox& outbox) { outbox.begin(s.id, whole); });
    has_news_ = true;
}

void Connection::get_parameters(ClientId client, const GetParameters& said)
{
    const link::CatalogueContents& now = catalogue_->now();
    std::vector<std::string> names = said.names.empty() ? parameter_names(now) : said.names;
    if (said.names.empty() && names.size() > kMostListed)
    {
        names.pop_back();
        say(client, status(Level::Warning,
                           "The list of parameters ends after " + std::to_string(kMostListed) +
                               "; others are there as well, and can be asked for by name.",
                           "parameters"));
    }
    say(client, parameter_values(parameters_json(now, names), said.id));
}

void Connection::set_parameters(ClientId client, const SetParameters& said)
{
    auto operations = set_operations(said.values);
    if (!operations) return say(client, status(Level::Error, "The parameters were not set: " + operations.error().text()));
    std::vector<std::string> names;
    for (const auto& [name, value] : said.values) names.push_back(name);
    requests_.send({operations.take(), {}, {}},
                   [this, client, names = std::move(names), id = said.id](const Result<link::Reply>& reply)
                   {
                       if (!reply || !reply->done())
                           say(client,
                               status(Level::Error, "The parameters were not set: " + (reply ? reasons_of(*reply) : reply.error().text())));
                       // What the request changed in the catalogue was written before its reply.
                       take_catalogue();
                       if (!id.empty()) say(client, parameter_values(parameters_json(catalogue_->now(), names), id));
                   });
}

void Connection::call(ClientId client, const ServiceCall& said)
{
    const auto fail = [this, client, service = said.service, call = said.call](const std::string& sentence)
    { say(client, service_failure(service, call, sentence)); };
    if (said.encoding != "json") return fail("arguments must be JSON, not '" + said.encoding + "'");
    auto request = request_of(said.service, said.data);
    if (!request) return fail(request.error().text());
    requests_.send(request.take(),
                   [this, client, fail, service = said.service, call = said.call](const Result<link::Reply>& reply)
                   {
                       if (!reply) return fail(reply.error().text());
                       if (!reply->done()) return fail(reasons_of(*reply));
                       clients_.say(client, service_response(service, call, wire::json_of(*reply)));
                       has_news_ = true;
                   });
}

}  // namespace plab::foxglove
