/// Which requests are in progress and which were answered: this is why a request is carried out once, however often it is sent.
/// Plain bookkeeping without time or DDS. The clients' view is described in server/docs/requests.md.
#pragma once

#include <deque>
#include <list>
#include <map>
#include <optional>

#include "idl/values/limits.h"
#include "publish/records.h"

namespace plab::bus
{

struct BookLimits
{
    std::size_t waiting = wire::kMostRequestsWaiting;  ///< requests in progress, all clients together
    std::size_t waiting_per_client = wire::kMostRequestsWaitingPerClient;
    std::size_t kept_for_next_step = wire::kRequestsKeptForNextStep;     ///< of `waiting`
    std::size_t waiting_bytes = wire::kMostWaitingBytes;                 ///< text of all requests in progress
    std::size_t bytes_kept_for_next_step = wire::kBytesKeptForNextStep;  ///< of `waiting_bytes`
    std::size_t shutdowns = wire::kMostShutdownsWaiting;                 ///< beyond `waiting`
    std::size_t answers = wire::kAnswersKeptPerClient;                   ///< answers kept per client
    std::size_t clients = wire::kClientsRemembered;                      ///< clients remembered
    std::size_t answer_bytes = 64u << 20;                                ///< approximate memory of all kept answers
};

class RequestBook
{
public:
    explicit RequestBook(const BookLimits& limits) : limits_(limits) {}

    enum class Verdict : std::uint8_t
    {
        New,       ///< to be carried out; counts as waiting until close()
        Waiting,   ///< the same request is in progress: its answer will follow
        Answered,  ///< `answer` is the stored answer
        Refused,   ///< `answer` gives the reason
    };
    struct Decision
    {
        Verdict verdict = Verdict::New;
        wire::Reply answer;
    };
    /// Resources that a request uses while it waits.
    struct Load
    {
        bool names_step = false;  ///< it may wait without limit; others are answered at the next step boundary
        bool shutdown = false;    ///< the request is a single shutdown operation
        std::size_t bytes = 0;
    };
    /// Registers an incoming request. `wrong`: why it cannot be carried out in any case; then it is never New, and this refusal
    /// is its answer from now on.
    Decision open(const wire::ClientId& client, std::uint64_t number, const Load& load, const std::optional<Error>& wrong);
    /// Stores the answer to a request for which open() returned New. False if there is no such request.
    bool close(const wire::Reply& answer);

    std::size_t waiting() const { return all_.requests + shutdowns_.requests; }
    std::size_t waiting_bytes() const { return all_.bytes; }
    std::size_t clients() const { return by_id_.size(); }
    std::size_t answer_bytes() const { return answer_bytes_; }

private:
    struct Count
    {
        std::size_t requests = 0, bytes = 0;
    };
    struct Client
    {
        wire::ClientId id{};
        std::uint64_t highest = 0;    ///< highest number received
        std::uint64_t forgotten = 0;  ///< highest number whose answer is no longer kept
        std::map<std::uint64_t, Load> waiting;
        std::size_t counted = 0;          ///< of `waiting`: all except shutdowns that need no room
        std::deque<wire::Reply> answers;  ///< the last one is the latest
    };
    using Clients = std::list<Client>;

    Client& client_of(const wire::ClientId& id);
    std::optional<Decision> known(const Client& client, std::uint64_t number) const;
    std::optional<Error> no_room(const Client& client, const Load& load) const;
    std::optional<Error> no_bytes(const Load& load) const;
    void count(Client& client, const Load& load);
    void discount(Client& client, const Load& load);
    void keep(Client& client, const wire::Reply& answer);
    void forget_oldest_answer(Client& client);
    void forget_silent_clients(const Client& except);

    BookLimits limits_;
    Clients clients_;  ///< the first one has been silent for longest
    std::map<wire::ClientId, Clients::iterator> by_id_;
    Count all_;        ///< in progress, without those of shutdowns_
    Count with_step_;  ///< of them, those that name a step
    Count shutdowns_;  ///< beyond the others
    std::size_t answer_bytes_ = 0;
};

}  // namespace plab::bus
