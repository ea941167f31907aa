/// Serves files and one kind of web socket over HTTP. The only folder of the clients that knows libwebsockets, and this its only file.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "plab/result.h"
#include "websocket/access.h"
#include "websocket/message.h"

namespace plab::websocket
{

struct File
{
    std::string type;  ///< "text/javascript; charset=utf-8"
    std::string bytes;
};
using HttpAnswer = std::variant<Refusal, std::shared_ptr<const File>>;

using ConnectionId = std::uint64_t;

/// What a program does with its connections. All of it is called on the thread of Server::step(), and must not wait.
class Service
{
public:
    virtual ~Service() = default;

    /// A GET that was allowed. `path` is what follows the token, "" or "page.js".
    virtual HttpAnswer get(const std::string& path) = 0;
    /// A socket is open. Nothing: there are too many, and it is closed.
    virtual std::optional<ConnectionId> join() = 0;
    virtual void leave(ConnectionId connection) = 0;
    /// A message has arrived. A sentence: the socket is closed for this reason.
    virtual std::optional<std::string> receive(ConnectionId connection, const std::string& bytes, bool is_binary) = 0;
    /// The next message to send; without one the socket waits until Server::wake(). A null message closes the socket.
    virtual std::optional<Outgoing> take(ConnectionId connection) = 0;
    virtual bool has_any(ConnectionId connection) const = 0;
};

struct ServerOptions
{
    std::string address = "127.0.0.1";       ///< on which it listens
    int port = 0;                            ///< 0: any that is free
    AccessRules access;                      ///< the address is added to its hosts and, of loopback, localhost
    std::string socket_path;                 ///< below the token: "socket"
    std::vector<std::string> protocols;      ///< subprotocols of the socket; a client must ask for one of them
    std::size_t most_received = 256u << 10;  ///< bytes of a message; a socket that gets more is closed
};

/// Whether an address is reached from this machine only.
bool is_loopback(const std::string& address);

class Server
{
public:
    /// The service must outlive it.
    static Result<std::unique_ptr<Server>> listen(ServerOptions options, Service& service);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// "http://127.0.0.1:40123/3f../"; without a token "http://127.0.0.1:40123/".
    std::string url(const std::string& scheme) const;
    /// Serves until something happened; call it again and again.
    void step();
    /// Ends the current step(), which looks for new messages; from any thread and from signal handlers.
    void wake();

    struct State;  ///< known to the callbacks of libwebsockets

private:
    explicit Server(std::unique_ptr<State> state);

    std::unique_ptr<State> state_;
};

}  // namespace plab::websocket
