#include "web/feed.h"

#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "link/json.h"
#include "web/connection.h"

namespace plab::web
{
namespace
{

constexpr link::Seconds kLook(0.5);
constexpr std::chrono::milliseconds kPause(100);

}  // namespace

Feed::Feed(link::SessionOptions options, Pages& pages, std::function<void()> wake, link::Stop stop)
    : options_(std::move(options)), pages_(pages), wake_(std::move(wake)), stop_(std::move(stop)), thread_([this] { run(); })
{
}

void Feed::run()
{
    while (!stop_())
    {
        follow();
        wait_for_server();
        if (!stop_()) std::this_thread::sleep_for(kPause);
    }
    wake_();
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
        return stop_();
    };
    while (true)
    {
        if (stop_()) return;
        auto found = session->find_server(options_, kLook, stop);
        if (found) break;
        why_not_ = "There is no server to show: " + found.error().text() + ". Waiting for it.";
        wait_for_server();
    }
    auto connection = Connection::open(*session, options_, pages_, stop_);
    if (!connection)
    {
        why_not_ = "The server does not answer: " + connection.error().text() + ". Trying again.";
        return;
    }
    wake_();
    while (!stop_() && !(*connection)->is_over())
        if ((*connection)->step()) wake_();
    why_not_ = "The server has gone. Waiting for it to come back.";
    (*connection)->close();
    wake_();
}

void Feed::wait_for_server()
{
    const auto whole = [this] { return std::make_shared<Message>(link::line_of({{"type", "gone"}, {"reason", why_not_}})); };
    bool has_news = !pages_.begin(whole).empty();
    for (const Arrived& arrived : pages_.arrived())
    {
        if (arrived.has_left) continue;
        const auto said = parse_said(arrived.text);
        const Ask* const ask = said ? std::get_if<Ask>(&*said) : nullptr;
        if (ask == nullptr) continue;
        pages_.push_to(arrived.page, std::make_shared<Message>(link::line_of(refusal_message(ask->id, "there is no server now"))));
        has_news = true;
    }
    if (has_news) wake_();
}

}  // namespace plab::web
