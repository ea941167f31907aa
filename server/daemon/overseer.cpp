#include "daemon/overseer.h"

#include <chrono>
#include <utility>

namespace plab::daemon
{

Overseer::Overseer(const simulation::Progress& progress, std::function<void(const publish::Busy&)> show)
    : progress_(progress), show_(std::move(show)), thread_([this] { work(); })
{
}

Overseer::~Overseer()
{
    {
        const std::lock_guard lock(mutex_);
        is_over_ = true;
    }
    ends_.notify_one();
    thread_.join();
}

void Overseer::work()
{
    constexpr std::chrono::milliseconds kEvery(250);
    std::unique_lock lock(mutex_);
    while (!ends_.wait_for(lock, kEvery, [this] { return is_over_; }))
        if (const publish::Busy busy = publish::busy_of(progress_); !busy.what.empty()) show_(busy);
}

}  // namespace plab::daemon
