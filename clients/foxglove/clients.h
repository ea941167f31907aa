/// The clients that are connected: their outboxes, and what they said. Between the thread of the sockets and the thread that talks to the
/// server; neither waits for the other longer than a copy of pointers takes.
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "foxglove/outbox.h"
#include "websocket/server.h"

namespace plab::foxglove
{

using ClientId = websocket::ConnectionId;

struct Arrived
{
    ClientId client = 0;
    std::string bytes;
    bool is_binary = false, has_left = false;
};

class Clients final : public websocket::Service
{
public:
    static constexpr std::size_t kMostClients = 32;
    static constexpr std::size_t kMostWaiting = 1024;  ///< messages of all clients together

    /// What each client is told first. Set before the first one joins.
    void set_greeting(std::vector<MessagePtr> greeting) { greeting_ = std::move(greeting); }

    // For the thread of the sockets.
    websocket::HttpAnswer get(const std::string& path) override;
    std::optional<ClientId> join() override;
    void leave(ClientId client) override;
    std::optional<std::string> receive(ClientId client, const std::string& bytes, bool is_binary) override;
    std::optional<Outgoing> take(ClientId client) override;
    bool has_any(ClientId client) const override;

    // For the thread that talks to the server.
    std::vector<Arrived> arrived();
    void say(ClientId client, MessagePtr message);
    void say_to_all(const MessagePtr& message);
    /// Says it to all, and to those who join later; null: nothing more.
    void set_trouble(MessagePtr message);
    void tell_time(std::uint64_t time);
    void put(const Channel& channel, std::uint64_t instance, const Stamped& message);
    /// Uses the outbox of one client, if it is still there.
    void with(ClientId client, const std::function<void(Outbox&)>& use);

private:
    std::vector<MessagePtr> greeting_;
    mutable std::mutex mutex_;
    MessagePtr trouble_;  ///< null: none
    std::map<ClientId, Outbox> outboxes_;
    std::vector<Arrived> arrived_;
    ClientId last_ = 0;
};

}  // namespace plab::foxglove
