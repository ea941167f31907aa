#include "web/feed.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "link/follow.h"
#include "link/json.h"
#include "web/connection.h"

namespace plab::web
{
Feed::Feed(link::SessionOptions options, Pages& pages, NewestFigures& figures, std::function<void()> wake, link::Stop stop)
    : options_(std::move(options)),
      pages_(pages),
      figures_(figures),
      wake_(std::move(wake)),
      stop_(std::move(stop)),
      thread_([this] { run(); })
{
}

void Feed::run()
{
    link::follow_servers(
        options_, stop_,
        {[this](const std::string& why) { wait_for_server(why); }, [this](const link::Session& session) { return serve(session); }});
    wake_();
}

Result<void> Feed::serve(const link::Session& session)
{
    auto connection = Connection::open(session, options_, pages_, figures_, stop_);
    if (!connection) return connection.errors();
    wake_();
    while (!stop_() && !(*connection)->is_over())
        if ((*connection)->step()) wake_();
    (*connection)->close();
    wake_();
    return {};
}

void Feed::wait_for_server(const std::string& why)
{
    const auto whole = [&] { return std::make_shared<Message>(link::line_of({{"type", "gone"}, {"reason", why}})); };
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
