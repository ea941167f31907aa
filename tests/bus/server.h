/// A real plabd on the loopback bus, for tests of what its clients see.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <thread>

#include "link/caller.h"
#include "link/catalogue.h"
#include "support/process.h"
#include "support/text.h"

namespace plab::test
{

using link::Seconds;

class Server
{
public:
    explicit Server(const std::string& scene, std::vector<std::string> options = {}, const std::vector<std::string>& environment = {})
        : name_(unique_name("test")), process_(command(scene, name_, std::move(options)), environment)
    {
        REQUIRE_MESSAGE(process_.wait_for("ready after", Milliseconds(10000)), process_.errors());
    }

    const std::string& name() const { return name_; }
    Process& process() { return process_; }

    /// SIGTERM; the exit code.
    int end()
    {
        process_.signal(15);
        return process_.wait(Milliseconds(5000));
    }
    link::Session session() const
    {
        link::SessionOptions options;
        options.server = name_;
        auto session = link::Session::find(options, Seconds(5));
        REQUIRE_MESSAGE(session.ok(), session.error().text());
        return session.take();
    }

private:
    static std::vector<std::string> command(const std::string& scene, const std::string& name, std::vector<std::string> options)
    {
        std::vector<std::string> out{program("plabd"), scene, "--name", name};
        out.insert(out.end(), options.begin(), options.end());
        return out;
    }

    std::string name_;
    Process process_;
};

/// Everything that the server keeps for late joiners.
inline link::Catalogue catalogue(const link::Session& session)
{
    auto out = link::Catalogue::open(session);
    REQUIRE_MESSAGE(out.ok(), out.error().text());
    const auto fetched = out->fetch(Seconds(5));
    REQUIRE_MESSAGE(fetched.ok(), fetched.error().text());
    return out.take();
}
/// Until the catalogue shows it; false after five seconds.
template <class Condition>
bool shows(link::Catalogue& catalogue, Condition condition)
{
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(15);
    while (!condition(catalogue.now()) && std::chrono::steady_clock::now() < end) (void)catalogue.wait(Seconds(0.1));
    return condition(catalogue.now());
}

/// The reply to one operation; the test fails if there is none.
inline link::Reply ask(link::Caller& caller, link::Request request)
{
    auto reply = caller.call(request, Seconds(10));
    REQUIRE_MESSAGE(reply.ok(), reply.error().text());
    return reply.take();
}
inline link::Reply ask(link::Caller& caller, link::Operation operation)
{
    return ask(caller, link::Request{{std::move(operation)}, {}, {}});
}

/// Sends a request that will wait for its step, and returns its number. It is sent several times: the server's reader may discover a new
/// writer slightly later than the writer discovers it, and keeps nothing that came before. The server carries it out once.
inline std::uint64_t send_waiting(link::Caller& caller, const link::Request& request)
{
    const auto number = caller.send(request);
    REQUIRE(number.ok());
    for (int i = 0; i < 10; ++i)
    {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        REQUIRE(caller.send_again(request, *number).ok());
    }
    return *number;
}

/// plabctl against that server.
inline Outcome control(const Server& server, std::vector<std::string> arguments)
{
    std::vector<std::string> command{program("plabctl"), "--server", server.name(), "--timeout", "5"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return run(command);
}

inline std::string reasons(const link::Reply& reply)
{
    std::string out;
    for (const std::string& r : reply.reasons) out += r + "\n";
    return out;
}

}  // namespace plab::test
