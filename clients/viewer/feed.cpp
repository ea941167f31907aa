#include "viewer/feed.h"

#include <cstdio>

#include "viewer/scene_model.h"

namespace plab::view
{
namespace
{

using Clock = std::chrono::steady_clock;

constexpr link::Seconds kSlice{0.1};
/// A paused server sends no states by itself; a running one sends its first much sooner than that.
constexpr link::Seconds kStandingStill{0.5};

std::string seconds(const char* format, double value)
{
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

}  // namespace

Outcome Feed::timed_out() const
{
    std::string why = "no new state for " + seconds("%g s", timeout_.count());
    if (const auto server = source_.server())
        why += (server->paused ? ": the server is paused at t = " : ": the server is at t = ") + seconds("%.3f s", server->time);
    return {Exit::NoServer, why + " (--timeout waits longer)"};
}

std::optional<Moment> Feed::next()
{
    const auto start = Clock::now();
    while (true)
    {
        if (stop_())
        {
            end_ = {Exit::Interrupted, "interrupted"};
            return {};
        }
        if (auto moment = source_.pop(kSlice))
        {
            any_ = true;
            return moment;
        }
        if (const auto why = source_.closed())
        {
            gone_ = true, end_ = {Exit::Failed, *why};
            return {};
        }
        const link::Seconds waited = Clock::now() - start;
        bool stale = false;
        if (!any_ && waited >= kStandingStill)
            if (auto moment = standing_still(stale))
            {
                any_ = true;
                if (stale)
                    std::fputs("plab-view: the server is paused and sends no states: objects are drawn at their last listed positions\n",
                               stderr);
                return moment;
            }
        if (waited < timeout_) continue;
        end_ = timed_out();
        return {};
    }
}

std::optional<Moment> Feed::standing_still(bool& stale) const
{
    const auto server = source_.server();
    const auto scene = source_.scene();
    if (any_ || !server || !server->paused || !scene) return {};
    stale = server->step > 0;
    return Moment{state_of_catalogue(*scene, *server), scene};
}

}  // namespace plab::view
