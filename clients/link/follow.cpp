#include "link/follow.h"

#include <thread>

namespace plab::link
{
namespace
{

constexpr Seconds kLook(0.5);
constexpr std::chrono::milliseconds kPause(100);

/// One server, from when it is found until it has gone; returns why there is none any more.
std::string follow_one(const SessionOptions& options, const Stop& stop, const FollowHandler& handler, std::string why)
{
    const std::string name = options.server;
    auto session = Session::join(options);
    if (!session) return session.error().text();
    const auto stop_or_wait = [&]
    {
        handler.wait(why);
        return stop();
    };
    while (true)
    {
        if (stop() || options.server != name) return why;
        const auto found = session->find_server(options, kLook, stop_or_wait);
        if (found) break;
        why = "There is no server to show: " + found.error().text() + ". Waiting for it.";
        handler.wait(why);
    }
    const auto served = handler.serve(*session);
    return served ? "The server has gone. Waiting for it to come back."
                  : "The server does not answer: " + served.error().text() + ". Trying again.";
}

}  // namespace

void follow_servers(const SessionOptions& options, const Stop& stop, const FollowHandler& handler)
{
    std::string why = "No server is found yet. Waiting for one.";
    while (!stop())
    {
        why = follow_one(options, stop, handler, why);
        handler.wait(why);
        if (!stop()) std::this_thread::sleep_for(kPause);
    }
}

}  // namespace plab::link
