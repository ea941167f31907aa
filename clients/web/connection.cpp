#include "web/connection.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "link/json.h"

namespace plab::web
{
namespace
{

constexpr link::Seconds kNap(0.005), kIdleNap(0.05);
/// Entries of one message; more of one batch are counted and left out.
constexpr std::size_t kMostEntries = 200;

constexpr link::Parts kParts = link::kEverything;

/// Entries of a batch of samples, and how many of them were left out.
struct Batch
{
    Json entries = Json::array();
    std::size_t left_out = 0;

    template <class Sample>
    void add(const Sample& sample)
    {
        for (std::uint32_t i = 0; i < sample.entries._length; ++i)
        {
            if (entries.size() >= kMostEntries)
                ++left_out;
            else
                entries.push_back(link::json_of(sample, i));
        }
    }
};

}  // namespace

Result<std::unique_ptr<Connection>> Connection::open(const link::Session& session, const link::SessionOptions& options, Audience& pages,
                                                     const FeedHooks& hooks)
{
    constexpr link::Seconds kLongest(5);
    auto caller = link::Caller::make(session, kLongest, hooks.stop);
    if (!caller) return caller.errors();
    std::unique_ptr<Connection> out(new Connection(session, pages, hooks, caller.take()));
    out->options_ = options, out->options_.server = session.server();
    auto catalogue = link::Catalogue::open(session, kParts);
    if (!catalogue) return catalogue.errors();
    out->catalogue_ = catalogue.take();
    if (auto fetched = out->catalogue_->fetch(kLongest, hooks.stop); !fetched) return fetched.errors();
    auto events = session.reader<plab_v2_Events>();
    if (!events) return events.errors();
    out->events_ = events.take();
    out->sent_ = out->catalogue_->now();
    out->version_ = out->catalogue_->version();
    out->started_ns_ = out->sent_.server ? out->sent_.server->started_ns : 0;
    pages.forget_poses();
    // Pages of the server before have another scene.
    out->push({{"type", "found"}});
    out->whole_ = message_of(scene_message(out->sent_));
    out->pages_.push(out->whole_);
    return out;
}

bool Connection::step()
{
    has_news_ = false;
    subscribe();
    if (frames_)
        (void)session_.wait(*frames_, kNap);
    else
        (void)catalogue_->wait(kIdleNap);
    take_pages();
    take_catalogue();
    take_frames();
    take_metrics();
    note_figures();
    take_events();
    contacts_.update(watched(), [this](PageId page, const Json& message) { push_to(page, message); });
    requests_.update();
    preview_.update();
    begin_pages();
    send_details();
    return has_news_;
}

void Connection::close()
{
    if (hooks_.figures != nullptr) hooks_.figures->set(nullptr);
    requests_.give_up("the server has gone; whether it did this is unknown");
    push({{"type", "gone"}, {"reason", "The server has gone. Waiting for it to come back."}});
}

void Connection::push(const Json& message)
{
    pages_.push(message_of(message));
    has_news_ = true;
}

void Connection::push_to(PageId page, const Json& message)
{
    pages_.push_to(page, message_of(message));
    has_news_ = true;
}

/// Nobody looks: then nothing is read, and the server need not write it.
void Connection::subscribe()
{
    const bool wanted = pages_.count() > 0;
    if (wanted == frames_.has_value()) return;
    if (!wanted)
    {
        frames_.reset(), collisions_.reset();
        return;
    }
    encoder_.forget();
    if (auto frames = link::FrameReader::open(session_)) frames_ = frames.take();
    if (auto collisions = session_.reader<plab_v2_Collisions>()) collisions_ = collisions.take();
}

void Connection::take_pages()
{
    for (const Arrived& arrived : pages_.arrived())
    {
        if (arrived.has_left)
            leave(arrived.page);
        else
            handle(arrived);
    }
}

void Connection::leave(PageId page)
{
    hands_.release(page);
    contacts_.leave(page);
    watched_.erase(page);
}

void Connection::handle(const Arrived& arrived)
{
    auto said = parse_said(arrived.text);
    if (!said) return push_to(arrived.page, {{"type", "error"}, {"reason", "The message was not understood: " + said.error().reason}});
    const PageId page = arrived.page;
    if (const auto* asked = std::get_if<Ask>(&*said))
        ask(page, *asked);
    else if (const auto* job = std::get_if<JobAsk>(&*said))
        hooks_.jobs(page, *job, options_.server);
    else if (auto* watch = std::get_if<Watch>(&*said))
    {
        watched_[page] = watch->components;
        details_.clear(), metrics_time_ = -1;  // everything once more
    }
    else if (std::holds_alternative<ContactsAsk>(*said))
        contacts_.ask(page);
    else if (const auto* grab = std::get_if<Grab>(&*said))
        hands_.grab(page, *grab, [this, page, id = grab->id](const Result<link::Reply>& reply) { answer(page, id, reply); });
    else if (const auto* preview = std::get_if<PreviewAsk>(&*said))
        preview_.start(options_, *preview,
                       [this, page, id = preview->id](const Result<Json>& made)
                       { push_to(page, made ? preview_message(id, *made) : refusal_message(id, made.error().text())); });
    else if (const auto* moved = std::get_if<MoveHand>(&*said))
        hands_.move(page, moved->position);
    else
        hands_.release(page);
}

void Connection::ask(PageId page, const Ask& ask)
{
    requests_.send(ask.request, [this, page, id = ask.id](const Result<link::Reply>& reply) { answer(page, id, reply); });
}

void Connection::answer(PageId page, std::uint64_t id, const Result<link::Reply>& reply)
{
    push_to(page, reply ? reply_message(id, *reply) : refusal_message(id, reply.error().text()));
}

void Connection::take_catalogue()
{
    (void)catalogue_->update();
    const link::CatalogueContents& now = catalogue_->now();
    is_over_ = catalogue_->server_is_gone() || (now.server && now.server->started_ns != started_ns_);
    if (is_over_) return;
    constexpr std::chrono::milliseconds kBetween(50);
    const auto moment = std::chrono::steady_clock::now();
    if (catalogue_->version() != version_ && moment - compared_at_ >= kBetween)
    {
        compared_at_ = moment;
        version_ = catalogue_->version();
        if (auto changes = changes_message(sent_, now)) push(*changes);
        sent_ = now, whole_ = nullptr;
    }
    if (now.server && now.server->step == server_step_ && sent_.server && *now.server == *sent_.server) return;
    if (!now.server) return;
    server_step_ = now.server->step;
    sent_.server = now.server, whole_ = nullptr;
    push(server_message(*now.server));
}

void Connection::take_frames()
{
    if (!frames_) return;
    std::set<std::uint32_t> exact;
    for (const std::string& id : watched())
        if (const auto at = sent_.objects.find(id); at != sent_.objects.end()) exact.insert(at->second.handle);
    std::optional<Poses> newest;
    (void)frames_->take([&](const plab_v2_Frame& frame) { newest = encoder_.encode(frame, exact); });
    if (!newest) return;
    pages_.put(*newest);
    has_news_ = true;
}

void Connection::take_metrics()
{
    const auto& metrics = catalogue_->now().metrics;
    if (!metrics || (metrics->time == metrics_time_ && metrics->run == metrics_run_)) return;
    metrics_time_ = metrics->time, metrics_run_ = metrics->run;
    history_.add_metrics(*metrics);
    if (pages_.count() > 0) push(metrics_message(*metrics, watched()));
}

/// Figures are read every few seconds: once a second is new enough.
void Connection::note_figures()
{
    constexpr std::chrono::seconds kBetween(1);
    const auto moment = std::chrono::steady_clock::now();
    if (moment - noted_at_ < kBetween || !catalogue_->now().server) return;
    noted_at_ = moment;
    if (hooks_.figures != nullptr) hooks_.figures->set(std::make_shared<const Figures>(figures_of(catalogue_->now())));
}

void Connection::take_events()
{
    Batch events, collisions;
    const auto add_to = [](Batch& batch)
    {
        return [&batch](const auto& sample, const dds_sample_info_t& info)
        {
            if (info.valid_data) batch.add(sample);
        };
    };
    (void)events_.take(add_to(events));
    if (collisions_) (void)collisions_->take(add_to(collisions));
    for (const Json& event : events.entries) history_.add_event(event);
    if (!events.entries.empty()) push({{"type", "events"}, {"entries", events.entries}, {"left_out", events.left_out}});
    if (!collisions.entries.empty()) push({{"type", "collisions"}, {"entries", collisions.entries}, {"left_out", collisions.left_out}});
}

std::set<std::string> Connection::watched() const
{
    constexpr std::size_t kMost = 64;
    std::set<std::string> out;
    for (const auto& [page, ids] : watched_)
        for (const std::string& id : ids)
            if (out.size() < kMost) out.insert(id);
    return out;
}

void Connection::send_details()
{
    for (const auto& [page, ids] : watched_)
        for (const std::string& id : ids)
        {
            std::string text = link::line_of(detail_message(sent_, id));
            std::string& last = details_[id + "\n" + std::to_string(page)];
            if (text == last) continue;
            pages_.push_to(page, std::make_shared<Message>(text));
            last = std::move(text), has_news_ = true;
        }
}

void Connection::begin_pages()
{
    const std::vector<PageId> begun = pages_.begin(
        [&]
        {
            if (whole_ == nullptr) whole_ = message_of(scene_message(sent_));
            return whole_;
        });
    if (begun.empty()) return;
    const MessagePtr past = message_of(history_.message());
    for (const PageId page : begun) pages_.push_to(page, past);
    details_.clear(), metrics_time_ = -1;
    has_news_ = true;
}

}  // namespace plab::web
