/// Observes the step thread from another thread, and shows its activity when a step takes long.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "publish/busy.h"

namespace plab::daemon
{

class Overseer
{
public:
    /// `show` is called on the overseer's thread, four times a second while something takes longer than half a second.
    Overseer(const simulation::Progress& progress, std::function<void(const publish::Busy&)> show);
    ~Overseer();
    Overseer(const Overseer&) = delete;
    Overseer& operator=(const Overseer&) = delete;

private:
    void work();

    const simulation::Progress& progress_;
    std::function<void(const publish::Busy&)> show_;
    std::mutex mutex_;
    std::condition_variable ends_;
    bool is_over_ = false;
    std::thread thread_;
};

}  // namespace plab::daemon
