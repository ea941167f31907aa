/// A recording that is played, as a server of its own name on the bus, and can be controlled.
#pragma once

#include <atomic>
#include <mutex>
#include <thread>
#include <vector>

#include "control/recording/player/player.h"
#include "foxglove/protocol.h"

namespace plab::foxglove
{

class Playback
{
public:
    /// Paused, at its beginning. `name`: of the server that it appears as; `stop` ends it.
    static Result<std::unique_ptr<Playback>> open(const std::string& file, const std::string& name, const wire::DomainOptions& domain,
                                                  link::Stop stop);
    ~Playback() = default;
    Playback(const Playback&) = delete;
    Playback& operator=(const Playback&) = delete;

    TimeRange range() const { return {span_.from, span_.to}; }
    void control(PlaybackControl control);
    /// Where it is, ns.
    std::uint64_t time() const { return time_; }
    /// What clients must be told: answers to controls, and that the end was reached.
    std::vector<PlaybackState> news();

private:
    Playback(std::unique_ptr<player::Player> player, link::Stop stop);
    void run();
    void obey(const PlaybackControl& control, player::Player::Clock::time_point now);
    PlaybackState state(player::Player::Clock::time_point now) const;

    std::unique_ptr<player::Player> player_;
    link::Stop stop_;
    player::Span span_;
    std::atomic<std::uint64_t> time_{0};
    std::mutex mutex_;
    std::vector<PlaybackControl> controls_;
    std::vector<PlaybackState> news_;
    bool has_ended_ = false;
    std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace plab::foxglove
