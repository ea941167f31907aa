#include "link/session.h"

#include <algorithm>
#include <cstdlib>
#include <map>

namespace plab::link
{
namespace
{

using Clock = std::chrono::steady_clock;

Seconds left_until(Clock::time_point end) { return std::max(Seconds(0), Seconds(end - Clock::now())); }

ServerInfo info_of(const plab_v1_Server& s)
{
    return {s.name, s.version, s.host,       s.scene_file,   s.process, s.run,    s.revision,  s.step,
            s.time, s.dt,      s.rate_asked, s.rate_reached, s.slipped, s.paused, s.started_ns};
}

std::string names_of(const std::vector<ServerInfo>& servers)
{
    std::string out;
    for (const ServerInfo& s : servers) out += (out.empty() ? "" : ", ") + s.name;
    return out;
}

}  // namespace

Result<Options> options_from_environment()
{
    Options options;
    auto domain = wire::domain_from_environment();
    if (!domain) return domain.errors();
    options.domain = *domain;
    if (const char* name = std::getenv("PLAB_SERVER"); name != nullptr) options.server = name;
    return options;
}

Result<Session> Session::join(const Options& options)
{
    if (!options.server.empty() && !wire::is_server_name(options.server))
        return reason("'" + options.server + "' is no name of a server: 1 to 64 letters, digits, '.', '_' or '-'");
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

Result<Session> Session::find(const Options& options, Seconds timeout)
{
    auto session = join(options);
    if (!session) return session;
    const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(timeout);
    std::vector<ServerInfo> seen;
    while (true)
    {
        // Without a name a second server must have the time to show itself: taking the first would be a guess.
        const Seconds look = std::min(left_until(end), Seconds(options.server.empty() ? 0.3 : 0.1));
        seen = session->servers(look, options.server.empty() ? static_cast<std::size_t>(-1) : 1);
        const auto is_meant = [&](const ServerInfo& s) { return s.name == options.server; };
        if (!options.server.empty() && std::any_of(seen.begin(), seen.end(), is_meant)) return session;
        if (options.server.empty() && seen.size() == 1)
        {
            if (auto entered = session->enter(seen.front().name); !entered) return entered.errors();
            return session;
        }
        if (options.server.empty() && seen.size() > 1) return reason("several servers are there (" + names_of(seen) + "): name one");
        if (Clock::now() >= end) break;
    }
    const std::string where = " in domain " + std::to_string(options.domain.id);
    if (options.server.empty()) return reason("no server was found" + where);
    // Who else there is helps against a wrong name.
    Options all = options;
    all.server.clear();
    auto others = join(all);
    const std::vector<ServerInfo> names = others ? others->servers(Seconds(0.2)) : std::vector<ServerInfo>{};
    return reason("no server '" + options.server + "' was found" + where + (names.empty() ? "" : "; there are: " + names_of(names)));
}

std::vector<ServerInfo> Session::servers(Seconds timeout, std::size_t enough) const
{
    const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(timeout);
    std::map<std::string, ServerInfo> seen;
    auto subscriber = wire::make_subscriber(participant_, server_.empty() ? "*" : server_);
    if (!subscriber) return {};
    auto reader = wire::Reader<plab_v1_Server>::make(participant_, *subscriber);
    if (!reader) return {};
    do {
        if (!wait_for(reader->entity(), DDS_DATA_AVAILABLE_STATUS, left_until(end))) break;
        (void)reader->take(
            [&](const plab_v1_Server& s, const dds_sample_info_t& sample)
            {
                if (sample.valid_data && sample.instance_state == DDS_IST_ALIVE)
                    seen[s.name] = info_of(s);
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
    const bool triggered = dds_waitset_wait(waitset.get(), nullptr, 0, duration(timeout)) > 0;
    (void)dds_waitset_detach(waitset.get(), entity.get());
    return triggered;
}

}  // namespace plab::link
