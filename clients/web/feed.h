/// Talks to the server on a thread of its own: reads it once for all pages, carries their requests, and waits for it to come back when it
/// has gone.
#pragma once

#include <thread>

#include "link/session.h"
#include "web/feed_hooks.h"
#include "web/pages.h"

namespace plab::web
{

class Feed
{
public:
    Feed(link::SessionOptions options, Audience& pages, FeedHooks hooks);
    ~Feed() = default;
    Feed(const Feed&) = delete;
    Feed& operator=(const Feed&) = delete;

private:
    void run();
    /// One server until it has gone.
    Result<void> serve(const link::Session& session);
    /// From now on only the server of before is looked for, if there are others that plab-web has started.
    void keep_server();
    /// Answers pages while there is no server.
    void wait_for_server(const std::string& why);

    link::SessionOptions options_;
    Audience& pages_;
    FeedHooks hooks_;
    std::string last_server_;
    std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace plab::web
