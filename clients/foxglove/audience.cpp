#include "foxglove/audience.h"

#include <nlohmann/json.hpp>

namespace plab::foxglove
{

void Audience::subscribe(ClientId client, const Subscribe& said)
{
    Member& member = members_[client];
    const auto refuse = [&](const std::string& sentence) { clients_.say(client, text_message(status(Level::Error, sentence))); };
    for (const auto& [id, channel_id] : said.subscriptions)
    {
        const Channel* const channel = find_channel(channel_id);
        if (channel == nullptr)
            refuse("There is no channel " + std::to_string(channel_id) + ".");
        else if (member.subscriptions.contains(id))
            refuse("The subscription " + std::to_string(id) + " exists already.");
        else if (member.subscriptions.size() >= kMostSubscriptions)
            refuse("A client may have " + std::to_string(kMostSubscriptions) + " subscriptions; this is one more.");
        else
        {
            member.subscriptions[id] = channel;
            clients_.with(client, [subscription = id, channel](Outbox& outbox) { outbox.subscribe(subscription, *channel); });
            new_.push_back({client, id, channel});
        }
    }
}

void Audience::unsubscribe(ClientId client, const Unsubscribe& said)
{
    for (const SubscriptionId id : said.subscriptions)
    {
        members_[client].subscriptions.erase(id);
        clients_.with(client, [&](Outbox& outbox) { outbox.unsubscribe(id); });
    }
}

bool Audience::wants(const Channel& channel) const
{
    for (const auto& [client, member] : members_)
        for (const auto& [id, subscribed] : member.subscriptions)
            if (subscribed == &channel) return true;
    return false;
}

void Audience::begin_anew()
{
    new_.clear();
    for (const auto& [client, member] : members_)
        for (const auto& [id, channel] : member.subscriptions)
        {
            clients_.with(client, [&, id = id, channel = channel](Outbox& outbox) { outbox.subscribe(id, *channel); });
            new_.push_back({client, id, channel});
        }
}

std::vector<Audience::Subscription> Audience::wanting_whole() const
{
    std::vector<Subscription> out;
    for (const auto& [client, member] : members_)
        for (const auto& [id, channel] : member.subscriptions)
        {
            if (channel->keep != Keep::Whole) continue;
            bool wants = false;
            clients_.with(client, [&, id = id](const Outbox& outbox) { wants = outbox.wants_whole(id); });
            if (wants) out.push_back({client, id, channel});
        }
    return out;
}

void Audience::send_parameters(const link::CatalogueContents& now)
{
    for (auto& [client, member] : members_)
    {
        if (member.watch.is_empty()) continue;
        Json changes = member.watch.changes(now);
        if (!changes.empty()) clients_.say(client, text_message(parameter_values(std::move(changes))));
    }
}

void Audience::report_losses()
{
    for (auto& [client, member] : members_)
        clients_.with(client,
                      [&reported = member.reported_losses](Outbox& outbox)
                      {
                          const std::uint64_t lost = outbox.dropped() - std::exchange(reported, outbox.dropped());
                          if (lost == 0) return;
                          const std::string sentence = std::to_string(lost) + " messages were left out: this client takes too few of them.";
                          outbox.say(text_message(status(Level::Warning, sentence, "losses")));
                      });
}

}  // namespace plab::foxglove
