#include "foxglove/outbox.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "foxglove/protocol.h"

namespace plab::foxglove
{

void Outbox::say(MessagePtr message)
{
    if (!is_worth_keeping_) return;
    said_bytes_ += message->size();
    said_.push_back(std::move(message));
    if (said_.size() <= kMostSaid && said_bytes_ <= kMostSaidBytes) return;
    is_worth_keeping_ = false;
    said_.clear(), subscriptions_.clear(), time_.reset();
}

void Outbox::subscribe(SubscriptionId id, const Channel& channel)
{
    Subscription made;
    made.channel = channel.id, made.keep = channel.keep;
    made.is_current = channel.keep != Keep::Whole;
    subscriptions_.insert_or_assign(id, std::move(made));
}

Stamped Outbox::Subscription::take()
{
    if (!order.empty())
    {
        const auto at = newest.find(order.front());
        order.pop_front();
        Stamped out = std::move(at->second);
        newest.erase(at);
        return out;
    }
    Stamped out = std::move(queue.front());
    queue.pop_front();
    queue_bytes -= out.content->size();
    return out;
}

std::uint64_t Outbox::Subscription::put(std::uint64_t instance, const Stamped& message)
{
    if (keep == Keep::Log) return put_log(message);
    if (keep == Keep::Whole)
    {
        put_change(message);
        return 0;
    }
    const auto [at, is_new] = newest.insert_or_assign(instance, message);
    if (is_new) order.push_back(instance);
    return 0;
}

std::uint64_t Outbox::Subscription::put_log(const Stamped& message)
{
    queue.push_back(message);
    queue_bytes += message.content->size();
    std::uint64_t dropped = 0;
    for (; queue.size() > 1 && (queue.size() > kMostLogged || queue_bytes > kMostLoggedBytes); ++dropped) (void)take();
    return dropped;
}

void Outbox::Subscription::put_change(const Stamped& message)
{
    if (!is_current) return;
    queue.push_back(message);
    queue_bytes += message.content->size();
    if (queue.size() == 1 || (queue.size() <= kMostLogged && queue_bytes <= kMostLoggedBytes)) return;
    queue.clear(), queue_bytes = 0;
    is_current = false;
}

void Outbox::put(ChannelId channel, std::uint64_t instance, const Stamped& message)
{
    for (auto& [id, subscription] : subscriptions_)
        if (subscription.channel == channel) dropped_ += subscription.put(instance, message);
}

void Outbox::put_to(SubscriptionId id, std::uint64_t instance, const Stamped& message)
{
    if (const auto at = subscriptions_.find(id); at != subscriptions_.end()) dropped_ += at->second.put(instance, message);
}

void Outbox::begin(SubscriptionId id, const std::vector<Stamped>& whole)
{
    const auto at = subscriptions_.find(id);
    if (at == subscriptions_.end()) return;
    Subscription& subscription = at->second;
    subscription.queue.assign(whole.begin(), whole.end());
    subscription.queue_bytes = 0;
    for (const Stamped& message : whole) subscription.queue_bytes += message.content->size();
    subscription.is_current = true;
}

bool Outbox::wants_whole(SubscriptionId id) const
{
    const auto at = subscriptions_.find(id);
    return at != subscriptions_.end() && !at->second.is_current && !at->second.has_any();
}

bool Outbox::has_any() const
{
    return !is_worth_keeping_ || !said_.empty() || time_ ||
           std::any_of(subscriptions_.begin(), subscriptions_.end(), [](const auto& s) { return s.second.has_any(); });
}

std::optional<Outgoing> Outbox::take()
{
    if (!is_worth_keeping_) return Outgoing{};
    if (!said_.empty())
    {
        Outgoing out{std::move(said_.front()), {}, 0};
        said_.pop_front();
        said_bytes_ -= out.message->size();
        return out;
    }
    if (time_) return Outgoing{time_message(*std::exchange(time_, std::nullopt)), {}, 0};
    // Each subscription in its turn, so that a fast one leaves room for the others.
    auto at = subscriptions_.upper_bound(last_taken_);
    for (std::size_t i = 0; i < subscriptions_.size(); ++i, ++at)
    {
        if (at == subscriptions_.end()) at = subscriptions_.begin();
        if (!at->second.has_any()) continue;
        last_taken_ = at->first;
        Stamped message = at->second.take();
        Outgoing out{std::move(message.content), {}, 0};
        write_message_head(at->first, message.time, out);
        return out;
    }
    return {};
}

}  // namespace plab::foxglove
