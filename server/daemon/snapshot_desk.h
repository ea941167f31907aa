/// Snapshots on their way to whoever reads them: written down by a thread of its own, since of a large scene that takes longer
/// than a step.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "model/type_registry.h"
#include "publish/records.h"
#include "simulation/snapshot/snapshot.h"

namespace plab::daemon
{

/// Makes snapshots into records: bytes, and the blueprint of the scene as it is, in the order in which they came. But for
/// finish(), nobody waits here; the thread is there from the first snapshot on. All calls are the step thread's.
class SnapshotDesk
{
public:
    /// `made`: called on the desk's thread when a record can be taken.
    explicit SnapshotDesk(model::TypeSource& types, std::function<void()> made = {}) : types_(&types), say_made_(std::move(made)) {}
    ~SnapshotDesk();
    SnapshotDesk(const SnapshotDesk&) = delete;
    SnapshotDesk& operator=(const SnapshotDesk&) = delete;

    /// `waiting`: the words of the snapshot's waiting requests, one for each. False: too many are waiting to be written
    /// down, this one is left out (and counted). One that comes now and then finds less room than one that is asked for.
    bool begin(const simulation::Snapshot& snapshot, std::vector<std::string> waiting, std::string name, const char* cause);
    /// The next record, if one is made.
    std::optional<Result<publish::SnapshotRecord>> take();
    /// Waits until all are made.
    void finish();
    std::uint64_t left_out() const { return left_out_; }

private:
    static constexpr std::size_t kMostPeriodic = 8, kMost = 64;

    struct Task
    {
        simulation::Snapshot snapshot;
        std::vector<std::string> waiting;
        publish::SnapshotRecord record;
    };
    void work();

    model::TypeSource* types_;
    std::function<void()> say_made_;
    std::shared_ptr<const model::SceneSpec> scene_;  ///< that blueprint_ is of
    std::string blueprint_;
    std::uint64_t left_out_ = 0;

    std::atomic<std::size_t> ready_{0};  ///< records in made_: asked at each step
    std::mutex mutex_;                   ///< of what follows
    std::condition_variable changed_;
    std::deque<Task> tasks_;  ///< the first one is being written down
    std::deque<Result<publish::SnapshotRecord>> made_;
    bool is_over_ = false;
    std::thread worker_;
};

}  // namespace plab::daemon
