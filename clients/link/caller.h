/// Requests and their replies. A request is repeated until its reply arrives: the server carries it out only once.
#pragma once

#include <functional>
#include <optional>

#include "link/session.h"

namespace plab::link
{

/// What a client asks for; the caller adds the client and a number.
struct Request
{
    std::vector<Operation> operations;
    std::optional<std::int64_t> at;  ///< step
    std::optional<std::uint64_t> revision;
};

/// State of a server that did not reply.
enum class Presence : std::uint8_t
{
    There,
    Silent,  ///< known, but silent: stopped, or its host is unreachable
    Gone,    ///< ended, or silent for so long that it counts as ended
};

/// Not thread-safe.
class Caller
{
public:
    /// Waits until the server's endpoints are matched in both directions, so that a reply cannot be missed.
    static Result<Caller> make(const Session& session, Seconds timeout, const Stop& stop = {});
    /// Waits for the reply until `timeout`, or until the server has gone; an error means that there was no reply (it is unknown
    /// whether the request was carried out).
    Result<Reply> call(const Request& request, Seconds timeout, const Stop& stop = {});

    /// call() in pieces, for callers that look up in between: sends the request, in place of one that still waits for its reply.
    Result<void> begin(const Request& request);
    /// Waits for its reply for `slice` at most, and sends it again when that is due. Nothing: not yet. An error means that the server
    /// has gone without a reply. Only after begin().
    Result<std::optional<Reply>> wait(Seconds slice);

    /// The name of the last request, for `cancel`: "3f..00:7". "" before the first.
    std::string last_request() const;
    /// Whether the server is still there; takes a moment if it is silent.
    Presence presence() const;

    /// For callers that do the waiting themselves: sends, and returns the request's number.
    Result<std::uint64_t> send(const Request& request);
    /// Sends the same request, with the same number, once more.
    Result<void> send_again(const Request& request, std::uint64_t number);
    /// Replies that have arrived, each with the number of its request.
    void take(const std::function<void(std::uint64_t number, Reply)>& handle);

private:
    struct State;  ///< the client's id, which the reply reader's filter points to
    struct StateDeleter
    {
        void operator()(State* state) const;
    };
    std::unique_ptr<State, StateDeleter> state_;
};

}  // namespace plab::link
