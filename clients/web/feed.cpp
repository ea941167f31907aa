#include "web/feed.h"

#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "web/connection.h"

namespace plab::web
{
namespace
{

constexpr link::Seconds kLook(0.5);
constexpr std::chrono::milliseconds kPause(100);

}  // namespace

Feed::Feed(link::SessionOptions options, Audience& pages, FeedHooks hooks)
    : options_(std::move(options)), pages_(pages), hooks_(std::move(hooks)), thread_([this] { run(); })
{
}

void Feed::run()
{
    while (!hooks_.stop())
    {
        follow();
        wait_for_server();
        if (!hooks_.stop()) std::this_thread::sleep_for(kPause);
    }
    hooks_.wake();
}

void Feed::follow()
{
    auto session = link::Session::join(options_);
    if (!session)
    {
        why_not_ = session.error().text();
        return;
    }
    const auto stop = [this]
    {
        wait_for_server();
        return hooks_.stop();
    };
    while (true)
    {
        if (hooks_.stop() || keep_server()) return;
        auto found = session->find_server(options_, kLook, stop);
        if (found) break;
        why_not_ = "There is no server to show: " + found.error().text() + ". Waiting for it.";
        wait_for_server();
    }
    auto connection = Connection::open(*session, options_, pages_, hooks_.jobs, hooks_.stop);
    if (!connection)
    {
        why_not_ = "The server does not answer: " + connection.error().text() + ". Trying again.";
        return;
    }
    last_server_ = session->server();
    hooks_.wake();
    while (!hooks_.stop() && !(*connection)->is_over())
        if ((*connection)->step()) hooks_.wake();
    why_not_ = "The server has gone. Waiting for it to come back.";
    (*connection)->close();
    hooks_.wake();
}

bool Feed::keep_server()
{
    if (!options_.server.empty() || last_server_.empty() || !hooks_.has_servers()) return false;
    options_.server = last_server_;
    return true;
}

void Feed::wait_for_server()
{
    const auto whole = [this] { return message_of({{"type", "gone"}, {"reason", why_not_}}); };
    bool has_news = !pages_.begin(whole).empty();
    for (const Arrived& arrived : pages_.arrived())
    {
        if (arrived.has_left) continue;
        const auto said = parse_said(arrived.text);
        if (const JobAsk* const job = said ? std::get_if<JobAsk>(&*said) : nullptr) hooks_.jobs(arrived.page, *job, "");
        const Ask* const ask = said ? std::get_if<Ask>(&*said) : nullptr;
        if (ask == nullptr) continue;
        pages_.push_to(arrived.page, message_of(refusal_message(ask->id, "there is no server now")));
        has_news = true;
    }
    if (has_news) hooks_.wake();
}

}  // namespace plab::web
