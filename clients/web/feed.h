/// Talks to the server on a thread of its own: reads it once for all pages, carries their requests, and waits for it to come back when it
/// has gone.
#pragma once

#include <functional>
#include <thread>

#include "link/session.h"
#include "web/pages.h"

namespace plab::web
{

class Feed
{
public:
    /// `wake`: called after something was put into `pages`. `stop`: asked several times a second; ends the thread.
    Feed(link::SessionOptions options, Pages& pages, std::function<void()> wake, link::Stop stop);
    ~Feed() = default;
    Feed(const Feed&) = delete;
    Feed& operator=(const Feed&) = delete;

private:
    void run();
    /// One server, from when it is found until it has gone.
    void follow();
    /// Answers pages while there is no server.
    void wait_for_server();

    link::SessionOptions options_;
    Pages& pages_;
    std::function<void()> wake_;
    link::Stop stop_;
    std::string why_not_ = "No server is found yet. Waiting for one.";
    std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace plab::web
