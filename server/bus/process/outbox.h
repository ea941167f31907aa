/// Outgoing replies. A reply is written at once; if that fails, it is retried for a while.
#pragma once

#include <chrono>
#include <deque>
#include <functional>

#include "bus/process/trouble.h"
#include "publish/records.h"

namespace plab::bus
{

class Outbox
{
public:
    using Clock = std::chrono::steady_clock;
    using Write = std::function<dds_return_t(const wire::Reply& answer)>;
    static constexpr std::chrono::seconds kPatience{2};
    static constexpr std::size_t kMost = 1024;  ///< largest number of replies that are retried

    Outbox(Write write, Trouble& trouble) : write_(std::move(write)), trouble_(&trouble) {}

    void send(const wire::Reply& answer, Clock::time_point now);
    /// Retries the replies that failed, and drops those that have failed for too long. Their clients may ask again.
    void retry(Clock::time_point now);
    bool empty() const { return failed_.empty(); }

private:
    struct Failed
    {
        wire::Reply answer;
        Clock::time_point since;
    };
    Write write_;
    Trouble* trouble_;
    std::deque<Failed> failed_;
};

}  // namespace plab::bus
