/// What each client has asked to get: subscriptions and parameters that it watches. It outlives the server.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "foxglove/clients.h"
#include "foxglove/parameters.h"

namespace plab::foxglove
{

class Audience
{
public:
    static constexpr std::size_t kMostSubscriptions = 64;  ///< of one client

    struct Subscription
    {
        ClientId client = 0;
        SubscriptionId id = 0;
        const Channel* channel = nullptr;
    };

    explicit Audience(Clients& clients) : clients_(clients) {}

    /// The client is told what was wrong.
    void subscribe(ClientId client, const Subscribe& said);
    void unsubscribe(ClientId client, const Unsubscribe& said);
    void watch(ClientId client, const WatchParameters& said) { members_[client].watch.change(said); }
    void leave(ClientId client) { members_.erase(client); }

    bool wants(const Channel& channel) const;
    /// Those that have come since the last call, and have to get what is kept.
    std::vector<Subscription> new_ones() { return std::exchange(new_, {}); }
    /// All have to get it anew: another server is there.
    void begin_anew();
    /// Of channels that keep a whole: who has to get it.
    std::vector<Subscription> wanting_whole() const;
    void send_parameters(const link::CatalogueContents& now);
    /// Clients that have lost messages of logs since the last call are told, and how many.
    void report_losses();

private:
    struct Member
    {
        std::map<SubscriptionId, const Channel*> subscriptions;
        ParameterWatch watch;
        std::uint64_t reported_losses = 0;
    };

    Clients& clients_;
    std::map<ClientId, Member> members_;
    std::vector<Subscription> new_;
};

}  // namespace plab::foxglove
