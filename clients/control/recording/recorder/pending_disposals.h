/// Disposals of the server that are not confirmed yet. A server that ends disposes of everything, which is not part of what
/// happened in the scene. So each disposal waits a moment before it counts.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace plab::recorder
{

struct Disposal
{
    std::string topic, key;
    std::uint64_t run = 0;
    std::uint64_t log_time = 0;  ///< when it was received
    std::uint64_t publish_time = 0;
};

class PendingDisposals
{
public:
    using Clock = std::chrono::steady_clock;
    /// All disposals at a server's end arrive within 200 ms (server/docs/bus.md).
    static constexpr std::chrono::milliseconds kDoubt{300};

    void add(Disposal disposal, Clock::time_point now) { waiting_.push_back({std::move(disposal), now + kDoubt}); }
    /// The disposals that count at `now`, in their order.
    std::vector<Disposal> take(Clock::time_point now);
    /// The instance exists again: it was disposed, and all disposals received before it count as well.
    std::vector<Disposal> take_before_return(const std::string& topic, const std::string& key);
    /// The server itself has gone.
    void forget() { waiting_.clear(); }

private:
    struct Waiting
    {
        Disposal disposal;
        Clock::time_point due;
    };
    std::vector<Disposal> take_first(std::size_t count);

    std::vector<Waiting> waiting_;  ///< in order of arrival
};

}  // namespace plab::recorder
