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
    Feed(link::SessionOptions options, Pages& pages, NewestFigures& figures, std::function<void()> wake, link::Stop stop);
    ~Feed() = default;
    Feed(const Feed&) = delete;
    Feed& operator=(const Feed&) = delete;

private:
    void run();
    /// One server until it has gone.
    Result<void> serve(const link::Session& session);
    /// Answers pages while there is no server.
    void wait_for_server(const std::string& why);

    link::SessionOptions options_;
    Pages& pages_;
    NewestFigures& figures_;
    std::function<void()> wake_;
    link::Stop stop_;
    std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace plab::web
