/// What waits for one client. Everything is bounded: of states only the newest wait, of logs the newest few thousand.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "foxglove/channels.h"
#include "websocket/message.h"

namespace plab::foxglove
{

using websocket::Message, websocket::MessagePtr, websocket::Outgoing;

/// A message of a channel: the same content for all who subscribe.
struct Stamped
{
    MessagePtr content;
    std::uint64_t time = 0;  ///< ns, simulated
};

class Outbox
{
public:
    static constexpr std::size_t kMostSaid = 1024;
    static constexpr std::size_t kMostSaidBytes = 16u << 20;
    static constexpr std::size_t kMostLogged = 4096;           ///< of one subscription
    static constexpr std::size_t kMostLoggedBytes = 8u << 20;  ///< a larger one waits if nothing else does

    /// Whatever is not a message of a channel: it must arrive. If too much of it waits, the client is not worth_keeping().
    void say(MessagePtr message);
    bool worth_keeping() const { return is_worth_keeping_; }
    /// The newest replaces the one that waits.
    void tell_time(std::uint64_t time) { time_ = time; }

    void subscribe(SubscriptionId id, const Channel& channel);
    void unsubscribe(SubscriptionId id) { subscriptions_.erase(id); }
    /// To all subscriptions of the channel. `instance`: of Keep::Newest, the newest of the same one replaces that which waits.
    void put(ChannelId channel, std::uint64_t instance, const Stamped& message);
    /// To one subscription: what was sent before it began.
    void put_to(SubscriptionId id, std::uint64_t instance, const Stamped& message);
    /// Of Keep::Whole: the whole thing, instead of what waits.
    void begin(SubscriptionId id, const std::vector<Stamped>& whole);
    /// It must get the whole thing, and nothing waits.
    bool wants_whole(SubscriptionId id) const;

    /// The next message; none: nothing waits. A null message: the client must be dropped.
    std::optional<Outgoing> take();
    bool has_any() const;
    /// Messages of logs that were dropped, of all subscriptions.
    std::uint64_t dropped() const { return dropped_; }

private:
    struct Subscription
    {
        ChannelId channel = 0;
        Keep keep = Keep::Newest;
        std::deque<std::uint64_t> order;          ///< instances, of Keep::Newest
        std::map<std::uint64_t, Stamped> newest;  ///< by instance
        std::deque<Stamped> queue;                ///< of the others
        std::size_t queue_bytes = 0;
        bool is_current = true;  ///< of Keep::Whole: it has got the whole thing, and every change since

        bool has_any() const { return !order.empty() || !queue.empty(); }
        Stamped take();
        /// Returns how many messages it dropped.
        std::uint64_t put(std::uint64_t instance, const Stamped& message);
        std::uint64_t put_log(const Stamped& message);
        void put_change(const Stamped& message);
    };

    std::deque<MessagePtr> said_;
    std::size_t said_bytes_ = 0;
    std::optional<std::uint64_t> time_;
    std::map<SubscriptionId, Subscription> subscriptions_;
    SubscriptionId last_taken_ = 0;  ///< the next one has its turn
    std::uint64_t dropped_ = 0;
    bool is_worth_keeping_ = true;
};

}  // namespace plab::foxglove
