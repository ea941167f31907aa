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
    bool take(publish::RequestText& request);
    void answer(publish::Answer&& answer);

    // Bus thread -------------------------------------------------------------------------------------------------------
    struct Received
    {
        bool is_new = false;       ///< for the step thread
        bool is_shutdown = false;  ///< and it is to end the server
    };
    /// A request came: whatever plab-bus says of it, its form is looked at here. One that has its answer already, or is
    /// refused, gives that to next_answer().
    Received receive(RequestMessage&& message, std::int64_t now_ns);
    /// So many answers wait to be fetched that nothing more is to be received before.
    bool is_full() const { return at_once_.size() >= kMostAtOnce; }
    /// The next answer that is to go out. `strays` counts those of the step thread that nobody waited for.
    std::optional<AnswerMessage> next_answer(std::uint64_t& strays);

private:
    RequestBook book_;
    // As many as may wait at a time: neither ring can overflow.
    publish::Ring<publish::RequestText> requests_;
    publish::Ring<publish::Answer> answers_;
    static constexpr std::size_t kMostAtOnce = 1024;
    std::deque<AnswerMessage> at_once_;  ///< made here
};

}  // namespace plab::bus
