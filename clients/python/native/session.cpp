#include <nlohmann/json.hpp>

#include "link/json.h"
#include "python/native/guard.h"
#include "python/native/handles.h"

namespace
{

using namespace plab;
using python::guarded;

Result<PlabSession*> join(const char* server, int domain, const char* network_interface)
{
    auto options = link::options_from_environment();
    if (!options) return options.errors();
    if (server != nullptr) options->server = server;
    if (domain >= 0) options->domain.id = static_cast<std::uint32_t>(domain);
    if (network_interface != nullptr) options->domain.network_interface = network_interface;
    auto session = link::Session::join(*options);
    if (!session) return session.errors();
    return new PlabSession{options.take(), session.take(), {}, {}};
}

/// An error before the slice is over is one that waiting does not change.
Result<int> find(PlabSession& session, double slice)
{
    const auto end = link::moment_after(link::Seconds(slice));
    bool is_over = false;
    const link::Stop stop = [&] { return is_over = std::chrono::steady_clock::now() >= end; };
    const auto found = session.session.find_server(session.options, link::kLongestWait, stop);
    if (found) return 1;
    if (!is_over) return found.errors();
    python::set_error(found.errors());
    return 0;
}

Result<int> connect(PlabSession& session, double slice)
{
    if (session.caller) return 1;
    auto caller = link::Caller::make(session.session, link::Seconds(slice));
    if (caller) session.caller = caller.take();
    if (!session.caller) python::set_error(caller.errors());
    return session.caller ? 1 : 0;
}

Result<const char*> servers(PlabSession& session, double seconds)
{
    link::Json out = link::Json::array();
    for (const link::ServerInfo& server : session.session.all_servers(link::Seconds(seconds))) out.push_back(link::json_of(server));
    session.text = link::line_of(out);
    return session.text.c_str();
}

link::Operation operation_of(const PlabOperation& from)
{
    link::Operation out{from.verb, from.target, from.argument, from.blueprint, {}};
    for (std::size_t i = 0; i < from.value_count; ++i) out.values.push_back({from.values[i].name, from.values[i].text});
    return out;
}

Result<int> request(PlabSession& session, const PlabOperation* operations, std::size_t count, std::int64_t at, std::int64_t revision)
{
    link::Request out;
    for (std::size_t i = 0; i < count; ++i) out.operations.push_back(operation_of(operations[i]));
    if (at >= 0) out.at = at;
    if (revision >= 0) out.revision = static_cast<std::uint64_t>(revision);
    if (auto begun = session.caller->begin(out); !begun) return begun.errors();
    return 1;
}

Result<const char*> reply(PlabSession& session, double slice)
{
    auto reply = session.caller->wait(link::Seconds(slice));
    if (!reply) return reply.errors();
    session.text = *reply ? link::line_of(link::json_of(**reply)) : std::string();
    return session.text.c_str();
}

}  // namespace

const char* plab_version() { return PLAB_VERSION; }

const char* plab_error() { return python::last_error().c_str(); }

PlabSession* plab_join(const char* server, int domain, const char* network_interface)
{
    return guarded([&] { return join(server, domain, network_interface); });
}

int plab_find(PlabSession* session, double slice)
{
    return guarded([&] { return find(*session, slice); });
}

int plab_connect(PlabSession* session, double slice)
{
    return guarded([&] { return connect(*session, slice); });
}

const char* plab_server(PlabSession* session) { return session->session.server().c_str(); }

const char* plab_servers(PlabSession* session, double seconds)
{
    return guarded([&] { return servers(*session, seconds); });
}

int plab_request(PlabSession* session, const PlabOperation* operations, std::size_t count, std::int64_t at, std::int64_t revision)
{
    return guarded([&] { return request(*session, operations, count, at, revision); });
}

const char* plab_reply(PlabSession* session, double slice)
{
    return guarded([&] { return reply(*session, slice); });
}

const char* plab_last_request(PlabSession* session)
{
    session->text = session->caller ? session->caller->last_request() : std::string();
    return session->text.c_str();
}

void plab_leave(PlabSession* session) { delete session; }
