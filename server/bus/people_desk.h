/// The samples of users and viewers on their way from the bus to the step thread: of each client and component only the newest one is kept,
/// so what waits is bounded, however long a step takes.
#pragma once

#include <mutex>

#include "bus/channel/messages.h"
#include "publish/records.h"

namespace plab::bus
{

class PeopleDesk
{
public:
    static constexpr std::size_t kMost = 64;      ///< of users, and of viewers; the samples of others are dropped
    static constexpr std::size_t kLongest = 256;  ///< bytes of an id

    // Bus thread. Samples that cannot be right are dropped: numbers that are not finite, ids that are no text.
    void receive(UserMessage&& message, std::int64_t arrived_ns);
    void receive(ViewerMessage&& message, std::int64_t arrived_ns);

    /// Step thread: see Bus::take_people().
    void take(publish::ReceivedPeople& people);

private:
    std::mutex mutex_;  ///< held briefly
    publish::ReceivedPeople waiting_;
};

}  // namespace plab::bus
