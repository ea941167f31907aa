/// What the reading of one server calls, from its own thread.
#pragma once

#include <functional>

#include "link/session.h"
#include "web/job_ask.h"
#include "web/metrics_text.h"

namespace plab::web
{

struct FeedHooks
{
    std::function<void()> wake;  ///< called after something was put into the pages
    link::Stop stop;             ///< asked several times a second; true ends the thread
    JobHandler jobs;
    /// True: plab-web has started servers of its own, so "the only one" is that of before.
    std::function<bool()> has_servers;
    NewestFigures* figures = nullptr;  ///< for Prometheus; null: nobody asks for those of this server
};

}  // namespace plab::web
