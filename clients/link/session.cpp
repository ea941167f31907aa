#include "link/session.h"

#include <algorithm>
#include <cstdlib>
#include <map>

#include "idl/samples.h"

namespace plab::link
{
namespace
{

using Clock = std::chrono::steady_clock;

Seconds left_until(Clock::time_point end) { return std::max(Seconds(0), Seconds(end - Clock::now())); }

std::string names_of(const std::vector<ServerInfo>& servers)
{
    std::string out;
    for (const ServerInfo& s : servers) out += (out.empty() ? "" : ", ") + s.name;
    return out;
}

}  // namespace

Result<SessionOptions> options_from_environment()
{
    SessionOptions options;
    auto domain = wire::domain_from_environment();
    if (!domain) return domain.errors();
    options.domain = *domain;
    if (const char* name = std::getenv("PLAB_SERVER"); name != nullptr) options.server = name;
    return options;
}

Result<Session> Session::join(const SessionOptions& options)
{
    if (!options.server.empty() && !wire::is_server_name(options.server))
        return reason("'" + options.server + "' is not a valid server name: use 1 to 64 letters, digits, '.', '_' or '-'");
    auto participant = wire::join(options.domain);
    if (!participant) return participant.errors();
    Session session;
    session.participant_ = participant.take();
    if (!options.server.empty())
        if (auto entered = session.enter(options.server); !entered) return entered.errors();
    return session;
}

Result<void> Session::enter(const std::string& server)
{
    auto publisher = wire::make_publisher(participant_, server);
    if (!publisher) return publisher.errors();
    auto subscriber = wire::make_subscriber(participant_, server);
    if (!subscriber) return subscriber.errors();
    server_ = server, publisher_ = publisher.take(), subscriber_ = subscriber.take();
    return {};
}

Result<Session> Session::find(const SessionOptions& options, Seconds timeout)
{
    auto session = join(options);
    if (!session) return session;
    if (auto found = session->find_server(options, timeout); !found) return found.errors();
    return session;
}

Result<void> Session::find_server(const SessionOptions& options, Seconds timeout, const Stop& stop)
{
    const auto end = moment_after(timeout);
    std::vector<ServerInfo> seen;
    while (true)
    {
        // Without a name, wait long enough for a second server to appear: taking the first one would be a guess.
        const Seconds look = std::min(left_until(end), Seconds(options.server.empty() ? 0.3 : 0.1));
        seen = servers(look, options.server.empty() ? static_cast<std::size_t>(-1) : 1);
        const auto is_meant = [&](const ServerInfo& s) { return s.name == options.server; };
        if (!options.server.empty() && std::any_of(seen.begin(), seen.end(), is_meant)) return {};
        if (options.server.empty() && seen.size() == 1) return enter(seen.front().name);
        if (options.server.empty() && seen.size() > 1)
            return reason("there are several servers (" + names_of(seen) + "): name one of them");
        if (Clock::now() >= end || (stop && stop())) break;
    }
    const std::string where = " in domain " + std::to_string(options.domain.id);
    if (options.server.empty()) return reason("no server was found" + where);
    // A list of the other servers helps to correct a wrong name.
    const std::vector<ServerInfo> names = all_servers(Seconds(0.2));
    return reason("no server '" + options.server + "' was found" + where + (names.empty() ? "" : "; there are: " + names_of(names)));
}

std::vector<ServerInfo> Session::servers_in(const std::string& partition, Seconds timeout, std::size_t enough) const
{
    const auto end = moment_after(timeout);
    std::map<std::string, ServerInfo> seen;
    auto subscriber = wire::make_subscriber(participant_, partition);
    if (!subscriber) return {};
    auto reader = wire::DataReader<plab_v2_Server>::make(participant_, *subscriber);
    if (!reader) return {};
    do {
        if (!wait_for(reader->entity(), DDS_DATA_AVAILABLE_STATUS, left_until(end))) break;
        (void)reader->take(
            [&](const plab_v2_Server& s, const dds_sample_info_t& sample)
            {
                if (sample.valid_data && sample.instance_state == DDS_IST_ALIVE)
                    wire::read_sample(s, seen[s.name]);
                else
                    seen.erase(s.name);
            });
    } while (seen.size() < enough && Clock::now() < end);
    std::vector<ServerInfo> out;
    for (auto& [name, info] : seen) out.push_back(std::move(info));
    return out;
}

bool Session::wait_for(const wire::Entity& entity, std::uint32_t status, Seconds timeout) const
{
    const wire::Entity waitset(dds_create_waitset(participant_.get()));
    if (!waitset.valid()) return false;
    (void)dds_set_status_mask(entity.get(), status);
    if (dds_waitset_attach(waitset.get(), entity.get(), 0) < 0) return false;
    const bool triggered = dds_waitset_wait(waitset.get(), nullptr, 0, duration_of(timeout)) > 0;
    (void)dds_waitset_detach(waitset.get(), entity.get());
    return triggered;
}

}  // namespace plab::link
