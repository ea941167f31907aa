#include "web/desk.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "link/json.h"
#include "link/text.h"
#include "web/translate.h"

namespace plab::web
{
namespace
{

constexpr std::chrono::milliseconds kJobNap(50), kNoJobNap(200);  ///< how late news of the processes may be seen
constexpr std::chrono::milliseconds kBetweenStates(250), kBetweenLists(2000);
constexpr double kSlowest = 1e-3, kFastest = 1e3;  ///< of a playback
/// A playback that nobody looks at ends after this time: the page was closed.
constexpr std::chrono::seconds kUnwatched(10);

Json reply_of(std::uint64_t id, const Result<Json>& made)
{
    Json out{{"type", "reply"}, {"id", id}, {"outcome", made ? "done" : "refused"}};
    if (made)
        out.update(made.value());
    else
        out["reasons"] = {made.error().text()};
    return out;
}

Json recording_list(const std::vector<Recording>& recordings)
{
    Json out = Json::array();
    for (const Recording& r : recordings)
        out.push_back({{"name", r.name},
                       {"bytes", r.bytes},
                       {"date", r.changed_ms},
                       {"seconds", r.seconds ? Json(*r.seconds) : Json()},
                       {"is_closed", r.is_closed}});
    return out;
}

}  // namespace

Desk::Show::Show(Desk& desk, const std::string& server)
    : audience(desk.pages_, server),
      feed(server.empty() ? desk.link_ : link::SessionOptions{server, desk.link_.domain}, audience,
           {desk.wake_, [this, &desk] { return is_over || desk.stop_(); },
            [&desk](PageId page, const JobAsk& ask, const std::string& of) { desk.put(page, ask, of); },
            [&desk] { return desk.has_servers_.load(); }, server.empty() ? &desk.figures_ : nullptr})
{
}

Desk::Desk(link::SessionOptions link, std::optional<Recordings> recordings, Pages& pages, NewestFigures& figures,
           std::function<void()> wake, link::Stop stop)
    : link_(std::move(link)),
      recordings_(std::move(recordings)),
      pages_(pages),
      figures_(figures),
      wake_(std::move(wake)),
      stop_(std::move(stop)),
      thread_([this] { run(); })
{
}

void Desk::run()
{
    // Children end with the thread that started them.
    jobs_.emplace(link_.domain, recordings_ ? &*recordings_ : nullptr);
    shows_.try_emplace("", *this, "");
    while (!stop_())
    {
        for (const Asked& asked : take(jobs_->is_idle() ? kNoJobNap : kJobNap)) handle(asked);
        jobs_->update();
        has_servers_ = jobs_->state()["servers"].size() > 0;
        update_shows();
        send_news();
    }
    shows_.clear();
    jobs_.reset();
    wake_();
}

void Desk::put(PageId page, const JobAsk& ask, const std::string& server)
{
    {
        const std::lock_guard lock(mutex_);
        if (waiting_.size() < kMostWaiting)
        {
            waiting_.push_back({page, ask, server});
            arrived_.notify_one();
            return;
        }
    }
    pages_.push_to(page, message_of(reply_of(ask.id, reason("too many requests wait; try again"))));
}

std::deque<Desk::Asked> Desk::take(std::chrono::milliseconds longest)
{
    std::unique_lock lock(mutex_);
    arrived_.wait_for(lock, longest, [&] { return !waiting_.empty(); });
    return std::exchange(waiting_, {});
}

void Desk::handle(const Asked& asked)
{
    const JobAsk& ask = asked.ask;
    const auto answer = [this, page = asked.page, id = ask.id](const Result<Json>& made)
    {
        pages_.push_to(page, message_of(reply_of(id, made)));
        wake_();
    };
    if (ask.verb == "list") return send_state(&asked);
    if (ask.verb == "look") return look(asked);
    if (ask.verb == "record") return jobs_->record(asked.server, ask.name, answer);
    if (ask.verb == "stop") return jobs_->stop_recording(answer);
    if (ask.verb == "play") return jobs_->play(ask.name, answer);
    if (ask.verb == "branch") return jobs_->branch(asked.server, ask.name, ask.value != 0, answer);
    if (ask.verb == "end") return jobs_->end(ask.name, answer);
    if (ask.verb == "delete") return jobs_->remove(ask.name, answer);
    handle_playback(ask, answer);
}

void Desk::handle_playback(const JobAsk& ask, const Jobs::Answer& answer)
{
    if (ask.verb == "pause" || ask.verb == "resume") return jobs_->control(ask.name, ask.verb, answer);
    const bool is_seek = ask.verb == "seek", is_rate = ask.verb == "rate";
    if (is_seek && ask.value < 0) return answer(reason("a time of a recording is 0 s or more"));
    if (is_rate && !(ask.value >= kSlowest && ask.value <= kFastest)) return answer(reason("a rate of a playback is from 0.001 to 1000"));
    if (is_seek || is_rate) return jobs_->control(ask.name, ask.verb + " " + link::number_text(ask.value), answer);
    answer(reason("'" + ask.verb.substr(0, 80) + "' is nothing that plab-web can do"));
}

/// The page gets nothing of what it looked at before behind this answer.
void Desk::look(const Asked& asked)
{
    const std::string& name = asked.ask.name;
    if (!name.empty() && !jobs_->has_server(name))
        pages_.push_to(asked.page,
                       message_of(reply_of(asked.ask.id, reason("there is no server '" + name.substr(0, 80) + "' to look at"))));
    else
        pages_.look(asked.page, name, message_of({{"type", "looking"}, {"id", asked.ask.id}, {"server", name}}));
    wake_();
}

void Desk::update_shows()
{
    const auto looked_at = pages_.looked_at();
    const auto now = Clock::now();
    for (const auto& [server, count] : looked_at) shows_.try_emplace(server, *this, server);
    std::erase_if(shows_, [&](const auto& show) { return !show.first.empty() && !looked_at.contains(show.first); });
    for (const std::string& playback : jobs_->playbacks())
    {
        const auto [at, is_new] = unwatched_.try_emplace(playback, now);
        if (looked_at.contains(playback)) at->second = now;
        if (now - at->second > kUnwatched) jobs_->end(playback, [](const Result<Json>&) {});
    }
    std::erase_if(unwatched_, [&](const auto& one) { return !jobs_->has_server(one.first); });
}

void Desk::send_news()
{
    for (const std::string& text : jobs_->take_notices()) push({{"type", "notice"}, {"text", text}});
    for (auto& [server, show] : shows_)
        if (const std::string said = jobs_->take_position(server); !said.empty())
        {
            Json position = Json::parse(said);
            position["type"] = "position";
            show.audience.push(message_of(position));
            wake_();
        }
    if (pages_.looked_at().empty()) return;
    const auto now = Clock::now();
    if (recordings_ && now - listed_at_ >= kBetweenLists) recordings_->update(), listed_at_ = now;
    if (now - sent_at_ >= kBetweenStates) send_state(nullptr), sent_at_ = now;
}

/// To one page, or to all where it has changed.
void Desk::send_state(const Asked* to)
{
    Json jobs = jobs_->state(), list{{"type", "recordings"}};
    jobs["type"] = "jobs";
    list["is_on"] = recordings_.has_value();
    if (recordings_)
        list["folder"] = recordings_->folder(), list["bytes"] = recordings_->bytes(), list["limit"] = recordings_->most_bytes(),
        list["list"] = recording_list(recordings_->list());
    for (auto& [message, sent] : {std::pair(&jobs, &sent_jobs_), std::pair(&list, &sent_recordings_)})
    {
        std::string text = link::line_of(*message);
        if (to == nullptr && text == *sent) continue;
        const auto out = std::make_shared<Message>(text);
        if (to != nullptr)
            pages_.push_to(to->page, out);
        else
            pages_.push_to_all(out), *sent = std::move(text);
        wake_();
    }
}

void Desk::push(const Json& message)
{
    pages_.push_to_all(message_of(message));
    wake_();
}

}  // namespace plab::web
