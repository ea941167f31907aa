/// What server and clients keep to, for those too who see no DDS.
#pragma once

#include <cstddef>
#include <string>

namespace plab::wire
{

/// A server's name is a partition: 1 to 64 letters, digits, '.', '_', '-'.
bool is_server_name(const std::string& name);

// What the server keeps to, in one place; documented in server/docs/bus.md.
inline constexpr std::size_t kMostRequestBytes = 4u << 20;  ///< text of one request, all operations together
inline constexpr std::size_t kMostOperations = 256;         ///< of one request
inline constexpr std::size_t kMostValues = 256;             ///< of one operation

// Requests wait from when they are taken in until they are answered. A single `shutdown` is beyond
// all of these: nobody can keep others from it.
inline constexpr std::size_t kMostRequestsWaiting = 1024;         ///< all clients together
inline constexpr std::size_t kMostRequestsWaitingPerClient = 64;  ///< one cannot keep out the others
inline constexpr std::size_t kRequestsKeptForNextStep = 128;      ///< of them; who names a step may wait for ever
inline constexpr std::size_t kMostWaitingBytes = 64u << 20;       ///< text of them all, each text with 32 bytes besides
inline constexpr std::size_t kBytesKeptForNextStep = 8u << 20;    ///< of them, for the same reason
inline constexpr std::size_t kMostShutdownsWaiting = 64;          ///< beyond the others; one is enough

inline constexpr std::size_t kAnswersKeptPerClient = 64;  ///< for requests that are repeated
inline constexpr std::size_t kClientsRemembered = 1024;   ///< the one that was silent for longest is forgotten

}  // namespace plab::wire
