/// Requests from plab-bus to the step thread, and answers back: checked on the way in, remembered, carried out once.
#pragma once

#include <optional>

#include "bus/channel/messages.h"
#include "bus/request_book.h"
#include "publish/ring.h"

namespace plab::bus
{

class RequestDesk
{
public:
    RequestDesk();

    // Step thread ------------------------------------------------------------------------------------------------------
    bool take(publish::ReceivedRequest& request);
    void answer(wire::Reply&& answer);

    // Bus thread -------------------------------------------------------------------------------------------------------
    struct Received
    {
        bool is_new = false;       ///< for the step thread
        bool is_shutdown = false;  ///< and it asks the server to shut down
    };
    /// Handles an incoming request: its form is checked here, whatever plab-bus reports about it. If it was answered before, or
    /// is refused, the answer goes to next_answer().
    Received receive(RequestMessage&& message, std::int64_t now_ns);
    /// Whether so many answers wait to be fetched that no further request may be received before.
    bool is_full() const { return at_once_.size() >= kMostAtOnce; }
    /// The next answer to send. `strays` counts answers of the step thread to requests that no client waits for.
    std::optional<wire::Reply> next_answer(std::uint64_t& strays);

private:
    RequestBook book_;
    // As large as the number of requests that may wait at a time: neither ring can overflow.
    publish::Ring<publish::ReceivedRequest> requests_;
    publish::Ring<wire::Reply> answers_;
    static constexpr std::size_t kMostAtOnce = 1024;
    std::deque<wire::Reply> at_once_;  ///< answers that are made here
};

}  // namespace plab::bus
