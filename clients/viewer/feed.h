/// Delivers moments one after the other, or the reason why there are no more.
#pragma once

#include "viewer/options.h"
#include "viewer/source.h"

namespace plab::view
{

class Feed
{
public:
    Feed(Source& source, const ViewerOptions& options, link::Stop stop) : source_(source), stop_(std::move(stop)), timeout_(options.timeout)
    {
    }

    /// Waits for the next moment. Empty: end() gives the reason.
    std::optional<Moment> next();
    /// The state in the catalogue, for a paused server that has sent no state yet; `stale`: objects may have moved
    /// since. Empty: it is not paused, or has sent states.
    std::optional<Moment> standing_still(bool& stale) const;

    const Outcome& end() const { return end_; }
    /// The server has ended: states that it will never send cannot be waited for.
    bool server_has_gone() const { return gone_; }

private:
    Outcome timed_out() const;

    Source& source_;
    link::Stop stop_;
    link::Seconds timeout_;
    Outcome end_;
    bool any_ = false, gone_ = false;
};

}  // namespace plab::view
