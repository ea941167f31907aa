#include "foxglove/feed.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "foxglove/services.h"
#include "link/follow.h"

namespace plab::foxglove
{
namespace
{

constexpr const char* kServerStatus = "server";
constexpr const char* kNoServer = "there is no server now";
constexpr const char* kReadOnly = "nothing can be changed here";

}  // namespace

Feed::Feed(FeedOptions options, Clients& clients, Playback* playback, std::function<void()> wake, link::Stop stop)
    : options_(std::move(options)),
      clients_(clients),
      playback_(playback),
      wake_(std::move(wake)),
      stop_(std::move(stop)),
      audience_(clients),
      thread_([this] { run(); })
{
}

void Feed::run()
{
    link::follow_servers(
        options_.link, stop_,
        {[this](const std::string& why) { wait_for_server(why); }, [this](const link::Session& session) { return serve(session); }});
    wake_();
}

Result<void> Feed::serve(const link::Session& session)
{
    auto connection = Connection::open(session, clients_, audience_, playback_, stop_);
    if (!connection) return connection.errors();
    clients_.set_trouble(nullptr);
    if (!std::exchange(trouble_, {}).empty()) clients_.say_to_all(text_message(remove_status(kServerStatus)));
    wake_();
    while (!stop_() && !(*connection)->is_over())
    {
        bool has_news = take_clients(connection->get());
        has_news = (*connection)->step() || has_news;
        if (tell_playback() || has_news) wake_();
    }
    (*connection)->close();
    wake_();
    return {};
}

void Feed::wait_for_server(const std::string& why)
{
    bool has_news = take_clients(nullptr);
    if (std::exchange(trouble_, why) != why)
    {
        clients_.set_trouble(text_message(status(Level::Warning, why, kServerStatus)));
        has_news = true;
    }
    if (tell_playback() || has_news) wake_();
}

bool Feed::tell_playback()
{
    if (playback_ == nullptr) return false;
    const auto news = playback_->news();
    for (const PlaybackState& state : news) clients_.say_to_all(playback_state(state));
    return !news.empty();
}

bool Feed::take_clients(Connection* connection)
{
    const std::vector<Arrived> all = clients_.arrived();
    for (const Arrived& arrived : all)
    {
        if (arrived.has_left)
            audience_.leave(arrived.client);
        else
            handle(arrived, connection);
    }
    return !all.empty();
}

void Feed::handle(const Arrived& arrived, Connection* connection)
{
    const ClientId client = arrived.client;
    const auto refuse = [&](const std::string& sentence) { clients_.say(client, text_message(status(Level::Error, sentence))); };
    const auto said = parse_said(arrived.bytes, arrived.is_binary);
    if (!said) return refuse("The message was not understood: " + said.error().text() + ".");
    if (const auto* subscribe = std::get_if<Subscribe>(&*said)) return audience_.subscribe(client, *subscribe);
    if (const auto* unsubscribe = std::get_if<Unsubscribe>(&*said)) return audience_.unsubscribe(client, *unsubscribe);
    if (const auto* watch = std::get_if<WatchParameters>(&*said)) return audience_.watch(client, *watch);
    if (const auto* control = std::get_if<PlaybackControl>(&*said))
    {
        if (playback_ == nullptr) return refuse("This is a running server and no recording: it cannot be played.");
        return playback_->control(*control);
    }
    const char* const why_not = !options_.writes && !std::get_if<GetParameters>(&*said) ? kReadOnly
                                : connection == nullptr                                 ? kNoServer
                                                                                        : nullptr;
    if (const auto* call = std::get_if<ServiceCall>(&*said))
    {
        if (why_not != nullptr) return clients_.say(client, text_message(service_failure(call->service, call->call, why_not)));
        return connection->call(client, *call);
    }
    if (why_not != nullptr) return refuse(std::string("Parameters: ") + why_not + ".");
    if (const auto* set = std::get_if<SetParameters>(&*said)) return connection->set_parameters(client, *set);
    connection->get_parameters(client, std::get<GetParameters>(*said));
}

}  // namespace plab::foxglove
