/// Snapshots on their way to their readers: serialized by a separate thread, because for a large scene this takes longer than a
/// step.
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

/// Converts snapshots to records: bytes, and the blueprint of the scene at that time, in order of arrival. Only finish() waits;
/// the thread exists from the first snapshot on. All calls are made by the step thread.
class SnapshotDesk
{
public:
    /// `made`: called on the desk's thread when a record can be taken.
    explicit SnapshotDesk(model::TypeSource& types, std::function<void()> made = {}) : types_(&types), say_made_(std::move(made)) {}
    ~SnapshotDesk();
    SnapshotDesk(const SnapshotDesk&) = delete;
    SnapshotDesk& operator=(const SnapshotDesk&) = delete;

    /// `waiting`: the snapshot's waiting requests as text, one entry each. False: too many snapshots wait to be serialized, and
    /// this one is skipped (and counted). Periodic snapshots are allowed less room than requested ones.
    bool begin(const simulation::Snapshot& snapshot, std::vector<std::string> waiting, std::string name, const char* cause);
    /// The next finished record, if there is one.
    std::optional<Result<wire::Snapshot>> take();
    /// Waits until all are made.
    void finish();
    std::uint64_t left_out() const { return left_out_; }

private:
    static constexpr std::size_t kMostPeriodic = 8, kMost = 64;

    struct Task
    {
        simulation::Snapshot snapshot;
        std::vector<std::string> waiting;
        wire::Snapshot record;
    };
    void work();

    model::TypeSource* types_;
    std::function<void()> say_made_;
    std::shared_ptr<const model::SceneSpec> scene_;  ///< the scene that blueprint_ describes
    std::string blueprint_;
    std::uint64_t left_out_ = 0;

    std::atomic<std::size_t> ready_{0};  ///< records in made_: asked at each step
    std::mutex mutex_;                   ///< protects what follows
    std::condition_variable changed_;
    std::deque<Task> tasks_;  ///< the first one is being serialized
    std::deque<Result<wire::Snapshot>> made_;
    bool is_over_ = false;
    std::thread worker_;
};

}  // namespace plab::daemon
