/// Which requests are under way and what was answered: the reason why a request is carried out once, however often it
/// is sent. Plain bookkeeping without time or DDS. How clients see it: server/docs/requests.md.
#pragma once

#include <deque>
#include <list>
#include <map>
#include <optional>
#include <set>

#include "publish/records.h"

namespace plab::bus
{

struct BookLimits
{
    std::size_t waiting = 1024;            ///< requests under way, all clients together
    std::size_t answers = 64;              ///< kept of each client
    std::size_t clients = 1024;            ///< remembered
    std::size_t answer_bytes = 64u << 20;  ///< of all answers that are kept, about
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
    /// A request came. `wrong`: why it cannot be carried out whatever it asks for (then it is New for nobody, and its
    /// refusal is what is answered to it from now on).
    Decision open(const publish::ClientId& client, std::uint64_t number, const std::optional<Error>& wrong);
    /// The answer to a request that open() called New. False if there is none such.
    bool close(const publish::Answer& answer);

    std::size_t waiting() const { return waiting_; }
    std::size_t clients() const { return by_id_.size(); }
    std::size_t answer_bytes() const { return answer_bytes_; }

private:
    struct Client
    {
        publish::ClientId id{};
        std::uint64_t highest = 0;    ///< number seen
        std::uint64_t forgotten = 0;  ///< highest number whose answer is not kept any more
        std::set<std::uint64_t> waiting;
        std::deque<publish::Answer> answers;  ///< the latest is the last
    };
    using Clients = std::list<Client>;

    Client& client_of(const publish::ClientId& id);
    std::optional<Decision> known(const Client& client, std::uint64_t number) const;
    void keep(Client& client, const publish::Answer& answer);
    void forget_oldest_answer(Client& client);
    void forget_silent_clients(const Client& except);

    BookLimits limits_;
    Clients clients_;  ///< the one that was silent for longest is the first
    std::map<publish::ClientId, Clients::iterator> by_id_;
    std::size_t waiting_ = 0;
    std::size_t answer_bytes_ = 0;
};

}  // namespace plab::bus
