#include "foxglove/clients.h"

#include <utility>

namespace plab::foxglove
{

websocket::HttpAnswer Clients::get(const std::string&)
{
    return websocket::Refusal{
        426,
        "This is a web socket for Foxglove and Lichtblick: open this address there, with ws: before it, by a connection of the kind "
        "\"Foxglove WebSocket\"."};
}

std::optional<ClientId> Clients::join()
{
    const std::lock_guard lock(mutex_);
    if (outboxes_.size() >= kMostClients) return {};
    Outbox& outbox = outboxes_[++last_];
    for (const MessagePtr& message : greeting_) outbox.say(message);
    if (trouble_ != nullptr) outbox.say(trouble_);
    return last_;
}

void Clients::leave(ClientId client)
{
    const std::lock_guard lock(mutex_);
    if (outboxes_.erase(client) > 0) arrived_.push_back({client, {}, false, true});
}

std::optional<std::string> Clients::receive(ClientId client, const std::string& bytes, bool is_binary)
{
    const std::lock_guard lock(mutex_);
    if (arrived_.size() >= kMostWaiting) return "too many messages wait";
    arrived_.push_back({client, bytes, is_binary, false});
    return {};
}

std::optional<Outgoing> Clients::take(ClientId client)
{
    const std::lock_guard lock(mutex_);
    const auto at = outboxes_.find(client);
    return at == outboxes_.end() ? std::nullopt : at->second.take();
}

bool Clients::has_any(ClientId client) const
{
    const std::lock_guard lock(mutex_);
    const auto at = outboxes_.find(client);
    return at != outboxes_.end() && at->second.has_any();
}

std::vector<Arrived> Clients::arrived()
{
    const std::lock_guard lock(mutex_);
    return std::exchange(arrived_, {});
}

void Clients::say(ClientId client, MessagePtr message)
{
    with(client, [&](Outbox& outbox) { outbox.say(std::move(message)); });
}

void Clients::say_to_all(const MessagePtr& message)
{
    const std::lock_guard lock(mutex_);
    for (auto& [id, outbox] : outboxes_) outbox.say(message);
}

void Clients::set_trouble(MessagePtr message)
{
    const std::lock_guard lock(mutex_);
    trouble_ = std::move(message);
    if (trouble_ == nullptr) return;
    for (auto& [id, outbox] : outboxes_) outbox.say(trouble_);
}

void Clients::tell_time(std::uint64_t time)
{
    const std::lock_guard lock(mutex_);
    for (auto& [id, outbox] : outboxes_) outbox.tell_time(time);
}

void Clients::put(const Channel& channel, std::uint64_t instance, const Stamped& message)
{
    const std::lock_guard lock(mutex_);
    for (auto& [id, outbox] : outboxes_) outbox.put(channel.id, instance, message);
}

void Clients::with(ClientId client, const std::function<void(Outbox&)>& use)
{
    const std::lock_guard lock(mutex_);
    if (const auto at = outboxes_.find(client); at != outboxes_.end()) use(at->second);
}

}  // namespace plab::foxglove
