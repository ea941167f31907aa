#include "daemon/snapshot_desk.h"

#include <string_view>

#include "blueprint/writer.h"
#include "simulation/snapshot/format.h"

namespace plab::daemon
{

SnapshotDesk::~SnapshotDesk()
{
    {
        const std::lock_guard lock(mutex_);
        is_over_ = true;
    }
    changed_.notify_all();
    if (worker_.joinable()) worker_.join();
}

bool SnapshotDesk::begin(const simulation::Snapshot& snapshot, std::vector<std::string> waiting, std::string name, const char* cause)
{
    {
        const std::lock_guard lock(mutex_);
        if (tasks_.size() >= (std::string_view(cause) == "periodic" ? kMostPeriodic : kMost)) return ++left_out_, false;
    }
    // Types are resolved here, on the step thread, because this may load a plugin.
    if (scene_ != snapshot->world.scene) scene_ = snapshot->world.scene, blueprint_ = blueprint::write_long_form(*scene_, *types_);
    Task task{snapshot, std::move(waiting), {}};
    wire::Snapshot& out = task.record;
    out.run = snapshot->run, out.revision = snapshot->revision, out.step = snapshot->clock.tick, out.time = snapshot->clock.time();
    out.name = std::move(name), out.cause = cause, out.state_hash = snapshot->state_hash;
    out.blueprint = blueprint_;
    {
        const std::lock_guard lock(mutex_);
        tasks_.push_back(std::move(task));
    }
    changed_.notify_all();
    if (!worker_.joinable()) worker_ = std::thread([this] { work(); });
    return true;
}

std::optional<Result<wire::Snapshot>> SnapshotDesk::take()
{
    if (ready_.load(std::memory_order_acquire) == 0) return {};
    const std::lock_guard lock(mutex_);
    std::optional<Result<wire::Snapshot>> out(std::move(made_.front()));
    made_.pop_front();
    ready_.fetch_sub(1, std::memory_order_relaxed);
    return out;
}

void SnapshotDesk::finish()
{
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return tasks_.empty(); });
}

void SnapshotDesk::work()
{
    std::unique_lock lock(mutex_);
    for (;;)
    {
        changed_.wait(lock, [this] { return is_over_ || !tasks_.empty(); });
        if (is_over_) return;
        Task& task = tasks_.front();  // keeps its address while others are added
        lock.unlock();
        auto bytes = simulation::encode(task.snapshot, task.waiting);
        if (bytes) task.record.data = bytes.take();
        lock.lock();
        made_.push_back(bytes ? Result<wire::Snapshot>(std::move(task.record)) : bytes.errors());
        tasks_.pop_front();
        ready_.fetch_add(1, std::memory_order_release);
        changed_.notify_all();
        if (say_made_) say_made_();
    }
}

}  // namespace plab::daemon
