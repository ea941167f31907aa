/// Talks to the server on a thread of its own: reads it once for all clients, carries their requests, and waits for it to come back when it
/// has gone.
#pragma once

#include <functional>
#include <thread>

#include "foxglove/connection.h"

namespace plab::foxglove
{

struct FeedOptions
{
    link::SessionOptions link;
    bool writes = true;  ///< clients may call services and set parameters
};

class Feed
{
public:
    /// `wake`: called after something was put into `clients`. `stop`: asked several times a second; ends the thread. `playback`: null, or
    /// what the server plays.
    Feed(FeedOptions options, Clients& clients, Playback* playback, std::function<void()> wake, link::Stop stop);
    ~Feed() = default;
    Feed(const Feed&) = delete;
    Feed& operator=(const Feed&) = delete;

private:
    void run();
    Result<void> serve(const link::Session& session);
    void wait_for_server(const std::string& why);
    /// `connection` null: there is no server now.
    bool take_clients(Connection* connection);
    void handle(const Arrived& arrived, Connection* connection);
    bool tell_playback();

    FeedOptions options_;
    Clients& clients_;
    Playback* playback_;
    std::function<void()> wake_;
    link::Stop stop_;
    Audience audience_;
    std::string trouble_;  ///< what clients know of the server that is not there
    std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace plab::foxglove
