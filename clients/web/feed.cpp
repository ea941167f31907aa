#include "web/feed.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "link/follow.h"
#include "web/connection.h"

namespace plab::web
{

Feed::Feed(link::SessionOptions options, Audience& pages, FeedHooks hooks)
    : options_(std::move(options)), pages_(pages), hooks_(std::move(hooks)), thread_([this] { run(); })
{
}

void Feed::run()
{
    link::follow_servers(
        options_, hooks_.stop,
        {[this](const std::string& why) { wait_for_server(why); }, [this](const link::Session& session) { return serve(session); }});
    hooks_.wake();
}

Result<void> Feed::serve(const link::Session& session)
{
    auto connection = Connection::open(session, options_, pages_, hooks_);
    if (!connection) return connection.errors();
    last_server_ = session.server();
    hooks_.wake();
    while (!hooks_.stop() && !(*connection)->is_over())
        if ((*connection)->step()) hooks_.wake();
    (*connection)->close();
    hooks_.wake();
    return {};
}

void Feed::keep_server()
{
    if (options_.server.empty() && !last_server_.empty() && hooks_.has_servers()) options_.server = last_server_;
}

void Feed::wait_for_server(const std::string& why)
{
    keep_server();
    const auto whole = [&] { return message_of({{"type", "gone"}, {"reason", why}}); };
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
