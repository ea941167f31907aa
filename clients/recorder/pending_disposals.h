/// Things that the server says are gone. When it ends it says so of all it had: that is its goodbye, and no part of what
/// happened in the scene. So each waits a moment before it is believed.
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
    std::uint64_t log_time = 0;  ///< when it was heard of
    std::uint64_t publish_time = 0;
};

class PendingDisposals
{
public:
    using Clock = std::chrono::steady_clock;
    /// A goodbye has reached everybody after 200 ms (server/docs/bus.md).
    static constexpr std::chrono::milliseconds kDoubt{300};

    void add(Disposal disposal, Clock::time_point now) { waiting_.push_back({std::move(disposal), now + kDoubt}); }
    /// Those that are believed at `now`, in their order.
    std::vector<Disposal> take(Clock::time_point now);
    /// The thing is there again: it was gone, and everything that was heard before it is true as well.
    std::vector<Disposal> take_before_return(const std::string& topic, const std::string& key);
    /// The server has gone itself.
    void forget() { waiting_.clear(); }

private:
    struct Waiting
    {
        Disposal disposal;
        Clock::time_point due;
    };
    std::vector<Disposal> take_first(std::size_t count);

    std::vector<Waiting> waiting_;  ///< in the order of their coming
};

}  // namespace plab::recorder
