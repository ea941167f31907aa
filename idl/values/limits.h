/// Limits of servers and clients, also for code that does not use DDS.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace plab::wire
{

/// A server's name is a partition: 1 to 64 letters, digits, '.', '_', '-'.
inline bool is_server_name(std::string_view name)
{
    const auto is_allowed = [](char c)
    { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-'; };
    return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), is_allowed);
}

// The limits of the server, in one place; documented in server/docs/bus.md.
inline constexpr std::size_t kMostRequestBytes = 4u << 20;  ///< text of one request, all operations together
inline constexpr std::size_t kMostOperations = 256;         ///< of one request
inline constexpr std::size_t kMostValues = 256;             ///< of one operation

// A request counts as waiting from its arrival until it is answered. A single `shutdown` is exempt from all of these limits, so
// that no client can prevent it.
inline constexpr std::size_t kMostRequestsWaiting = 1024;         ///< all clients together
inline constexpr std::size_t kMostRequestsWaitingPerClient = 64;  ///< one client cannot keep out the others
inline constexpr std::size_t kRequestsKeptForNextStep = 128;      ///< of them; a request that names a step may wait without limit
inline constexpr std::size_t kMostWaitingBytes = 64u << 20;       ///< text of all of them, plus 32 bytes per text
inline constexpr std::size_t kBytesKeptForNextStep = 8u << 20;    ///< of them, for the same reason
inline constexpr std::size_t kMostShutdownsWaiting = 64;          ///< in addition to the others; one is enough

inline constexpr std::size_t kAnswersKeptPerClient = 64;  ///< for requests that are repeated
inline constexpr std::size_t kClientsRemembered = 1024;   ///< the one that was silent for longest is forgotten

}  // namespace plab::wire
