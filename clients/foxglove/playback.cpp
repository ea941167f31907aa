#include "foxglove/playback.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace plab::foxglove
{

using Clock = player::Player::Clock;

Result<std::unique_ptr<Playback>> Playback::open(const std::string& file, const std::string& name, const wire::DomainOptions& domain,
                                                 link::Stop stop)
{
    player::PlaybackOptions options;
    options.file = file, options.name = name, options.version = PLAB_VERSION;
    options.paused = true, options.domain = domain;
    auto player = player::Player::open(options);
    if (!player) return player.errors();
    return std::unique_ptr<Playback>(new Playback(player.take(), std::move(stop)));
}

Playback::Playback(std::unique_ptr<player::Player> player, link::Stop stop)
    : player_(std::move(player)), stop_(std::move(stop)), span_(player_->pace().span()), time_(span_.from), thread_([this] { run(); })
{
}

void Playback::control(PlaybackControl control)
{
    const std::lock_guard lock(mutex_);
    controls_.push_back(std::move(control));
}

std::vector<PlaybackState> Playback::news()
{
    const std::lock_guard lock(mutex_);
    return std::exchange(news_, {});
}

PlaybackState Playback::state(Clock::time_point now) const
{
    const player::Pace& pace = player_->pace();
    PlaybackState out;
    out.time = pace.position(now), out.speed = static_cast<float>(pace.rate());
    out.status = pace.is_paused() ? PlaybackStatus::Paused : pace.at_end(now) ? PlaybackStatus::Ended : PlaybackStatus::Playing;
    return out;
}

void Playback::obey(const PlaybackControl& control, Clock::time_point now)
{
    const bool begins_anew = control.plays && !control.seek && player_->pace().at_end(now);
    player_->set_rate(std::clamp(static_cast<double>(control.speed), player::Pace::kSlowest, player::Pace::kFastest), now);
    if (control.seek || begins_anew) player_->seek(control.seek.value_or(span_.from), now);
    player_->pause(!control.plays, now);
    has_ended_ = false;
    PlaybackState answer = state(now);
    answer.did_seek = control.seek || begins_anew;
    answer.request = control.request;
    const std::lock_guard lock(mutex_);
    news_.push_back(std::move(answer));
}

void Playback::run()
{
    constexpr std::chrono::milliseconds kSlice(10);  // how long a control waits
    while (!stop_())
    {
        const auto now = Clock::now();
        std::vector<PlaybackControl> controls;
        {
            const std::lock_guard lock(mutex_);
            controls = std::exchange(controls_, {});
        }
        for (const PlaybackControl& control : controls) obey(control, now);
        const PlaybackState at = state(now);
        time_ = at.time;  // before what is due then is sent
        if (const auto stepped = player_->step(now); !stepped)
        {
            std::fprintf(stderr, "plab-foxglove: %s\n", stepped.error().text().c_str());
            return;
        }
        if (at.status == PlaybackStatus::Ended && !std::exchange(has_ended_, true))
        {
            const std::lock_guard lock(mutex_);
            news_.push_back(at);
        }
        player_->wait(now + kSlice);
    }
}

}  // namespace plab::foxglove
