/// Which requests are under way and what was answered: the reason why a request is carried out once, however often it
/// is sent. Plain bookkeeping without time or DDS. How clients see it: server/docs/requests.md.
#pragma once

#include <deque>
#include <list>
#include <map>
#include <optional>

#include "idl/limits.h"
#include "publish/records.h"

namespace plab::bus
{

struct BookLimits
{
    std::size_t waiting = wire::kMostRequestsWaiting;  ///< requests under way, all clients together
    std::size_t waiting_per_client = wire::kMostRequestsWaitingPerClient;
    std::size_t kept_for_next_step = wire::kRequestsKeptForNextStep;     ///< of `waiting`
    std::size_t waiting_bytes = wire::kMostWaitingBytes;                 ///< of all requests under way
    std::size_t bytes_kept_for_next_step = wire::kBytesKeptForNextStep;  ///< of `waiting_bytes`
    std::size_t shutdowns = wire::kMostShutdownsWaiting;                 ///< beyond `waiting`
    std::size_t answers = wire::kAnswersKeptPerClient;                   ///< kept of each client
    std::size_t clients = wire::kClientsRemembered;                      ///< remembered
    std::size_t answer_bytes = 64u << 20;                                ///< of all answers that are kept, about
};

class RequestBook
{
public:
    explicit RequestBook(const BookLimits& limits) : limits_(limits) {}

    enum class Verdict : std::uint8_t
    {
        New,       ///< to be carried out; counts as waiting until close()
        Waiting,   ///< the same one is under way: its answer will come
        Answered,  ///< `answer` is what was answered before
        Refused,   ///< `answer` says why
    };
    struct Decision
    {
        Verdict verdict = Verdict::New;
        publish::Answer answer;
    };
    /// What a request takes while it waits.
    struct Load
    {
        bool names_step = false;  ///< it may wait for ever; others are answered at the next boundary
        bool shutdown = false;    ///< a single operation
        std::size_t bytes = 0;
    };
    /// A request came. `wrong`: why it cannot be carried out whatever it asks for (then it is New for nobody, and its
    /// refusal is what is answered to it from now on).
    Decision open(const publish::ClientId& client, std::uint64_t number, const Load& load, const std::optional<Error>& wrong);
    /// The answer to a request that open() called New. False if there is none such.
    bool close(const publish::Answer& answer);

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
        publish::ClientId id{};
        std::uint64_t highest = 0;    ///< number seen
        std::uint64_t forgotten = 0;  ///< highest number whose answer is not kept any more
        std::map<std::uint64_t, Load> waiting;
        std::size_t counted = 0;              ///< of `waiting`: all but shutdowns that need no room
        std::deque<publish::Answer> answers;  ///< the latest is the last
    };
    using Clients = std::list<Client>;

    Client& client_of(const publish::ClientId& id);
    std::optional<Decision> known(const Client& client, std::uint64_t number) const;
    std::optional<Error> no_room(const Client& client, const Load& load) const;
    std::optional<Error> no_bytes(const Load& load) const;
    void count(Client& client, const Load& load);
    void discount(Client& client, const Load& load);
    void keep(Client& client, const publish::Answer& answer);
    void forget_oldest_answer(Client& client);
    void forget_silent_clients(const Client& except);

    BookLimits limits_;
    Clients clients_;  ///< the one that was silent for longest is the first
    std::map<publish::ClientId, Clients::iterator> by_id_;
    Count all_;        ///< under way, without those of shutdowns_
    Count with_step_;  ///< of them, those that name a step
    Count shutdowns_;  ///< beyond the others
    std::size_t answer_bytes_ = 0;
};

}  // namespace plab::bus
