/// Talks to the server on a thread of its own: reads it once for all pages, carries their requests, and waits for it to come back when it
/// has gone.
#pragma once

#include <functional>
#include <thread>

#include "link/session.h"
#include "web/job_ask.h"
#include "web/pages.h"

namespace plab::web
{

struct FeedHooks
{
    std::function<void()> wake;  ///< called after something was put into the pages
    link::Stop stop;             ///< asked several times a second; true ends the thread
    JobHandler jobs;
    /// True: plab-web has started servers of its own, so "the only one" is that of before.
    std::function<bool()> has_servers;
};

class Feed
{
public:
    Feed(link::SessionOptions options, Audience& pages, FeedHooks hooks);
    ~Feed() = default;
    Feed(const Feed&) = delete;
    Feed& operator=(const Feed&) = delete;

private:
    void run();
    /// One server, from when it is found until it has gone.
    void follow();
    /// True: from now on only the server of before is looked for, by joining anew.
    bool keep_server();
    /// Answers pages while there is no server.
    void wait_for_server();

    link::SessionOptions options_;
    Audience& pages_;
    FeedHooks hooks_;
    std::string last_server_;
    std::string why_not_ = "No server is found yet. Waiting for one.";
    std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace plab::web
