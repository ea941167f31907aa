/// A client's place on the bus: participant, partition of one server, typed readers.
///
///   auto session = link::Session::join(options);
///   auto frames = session->reader<plab_v2_Frame>();
///   while (session->wait(*frames, 1s)) frames->take([](const plab_v2_Frame& f, const dds_sample_info_t& info) { ... });
#pragma once

#include <dds/dds.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "idl/domain.h"
#include "link/values.h"

namespace plab::link
{

/// Waiting times, as users give them.
using Seconds = std::chrono::duration<double>;

/// Three years, longer than any sensible wait; beyond 292 years a count of nanoseconds would overflow.
inline constexpr Seconds kLongestWait(1e8);

/// Clamps to 0 .. kLongestWait; NaN becomes no wait.
inline Seconds bounded(Seconds s) { return s > Seconds(0) ? std::min(s, kLongestWait) : Seconds(0); }

/// For functions of DDS.
inline dds_duration_t duration_of(Seconds s) { return std::chrono::duration_cast<std::chrono::nanoseconds>(bounded(s)).count(); }

/// The time point that is this long after `from`.
inline std::chrono::steady_clock::time_point moment_after(Seconds s,
                                                          std::chrono::steady_clock::time_point from = std::chrono::steady_clock::now())
{
    return from + std::chrono::duration_cast<std::chrono::steady_clock::duration>(bounded(s));
}

/// Called several times per second while waiting: true ends the wait.
using Stop = std::function<bool()>;

struct SessionOptions
{
    std::string server;  ///< name; empty: the only server in the domain
    wire::DomainOptions domain;
};

/// From PLAB_SERVER, PLAB_DOMAIN and PLAB_INTERFACE, if set.
Result<SessionOptions> options_from_environment();

class Session
{
public:
    /// Joins the domain, independent of servers.
    static Result<Session> join(const SessionOptions& options);
    /// Joins, and looks for the server (by name, or the only one) until `timeout`. The error lists the existing servers.
    static Result<Session> find(const SessionOptions& options, Seconds timeout);
    /// The second half of find(), for a session that has joined.
    Result<void> find_server(const SessionOptions& options, Seconds timeout, const Stop& stop = {});

    /// Servers that have appeared until `timeout`, by name: this session's, or all if it has none. Returns early once there are
    /// `enough`.
    std::vector<ServerInfo> servers(Seconds timeout, std::size_t enough = static_cast<std::size_t>(-1)) const
    {
        return servers_in(server_.empty() ? "*" : server_, timeout, enough);
    }
    /// The servers of the domain, whichever one this session uses.
    std::vector<ServerInfo> all_servers(Seconds timeout) const { return servers_in("*", timeout, static_cast<std::size_t>(-1)); }

    template <class T>
    Result<wire::DataReader<T>> reader(dds_topic_filter_arg_fn filter = nullptr, void* argument = nullptr) const
    {
        return wire::DataReader<T>::make(participant_, subscriber_, filter, argument);
    }
    template <class T>
    Result<wire::DataWriter<T>> writer() const
    {
        return wire::DataWriter<T>::make(participant_, publisher_);
    }
    /// Waits until the reader has samples (true) or the time is over (false).
    template <class Reader>
    bool wait(const Reader& reader, Seconds timeout) const
    {
        return wait_for(reader.entity(), DDS_DATA_AVAILABLE_STATUS, timeout);
    }
    const std::string& server() const { return server_; }
    const wire::Entity& participant() const { return participant_; }

private:
    bool wait_for(const wire::Entity& entity, std::uint32_t status, Seconds timeout) const;
    Result<void> enter(const std::string& server);
    std::vector<ServerInfo> servers_in(const std::string& partition, Seconds timeout, std::size_t enough) const;

    std::string server_;
    wire::Participant participant_;
    wire::Entity publisher_, subscriber_;
};

}  // namespace plab::link
