/// What of plabd concerns recordings: the module that writes and reads them, snapshots for whoever wants them, and what a
/// recording says of its origin.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/options.h"
#include "model/type_registry.h"
#include "plugins/library.h"
#include "publish/collector.h"
#include "record/record.h"
#include "simulation/simulation.h"
#include "simulation/snapshot/format.h"
#include "simulation/snapshot/history.h"

namespace plab::daemon
{

/// record.so, loaded; whatever it made must go before it.
class RecordModule
{
public:
    static Result<RecordModule> load_for_writing() { return load(record::kRecordingEntry); }
    static Result<RecordModule> load_for_reading() { return load(record::kRunLogEntry); }

    Result<std::unique_ptr<record::Recording>> record(const record::RecordOptions& options) const;
    Result<std::unique_ptr<record::RunLog>> read(const std::string& file) const;

private:
    explicit RecordModule(plugins::Module module) : module_(std::move(module)) {}
    static Result<RecordModule> load(const char* entry);
    plugins::Module module_;
};

record::RecordOptions record_options(const Options& options, const simulation::Simulation& simulation, model::TypeSource& types);

simulation::HistoryOptions history_of(const Options& options);

/// Makes snapshots into records: bytes, and the blueprint of the scene as it is. The bytes are made on a thread of their
/// own, one snapshot at a time: of a large scene that takes longer than a step.
class SnapshotDesk
{
public:
    explicit SnapshotDesk(model::TypeSource& types) : types_(&types) {}
    /// Waits for one that is under way. `waiting`: the words of the snapshot's waiting requests, one for each.
    void begin(const simulation::Snapshot& snapshot, std::vector<std::string> waiting, std::string name, const char* cause);
    bool is_busy() const { return work_.valid(); }
    /// The record, once it is made; at once if `wait`. Nothing: none is under way, or it is not ready.
    std::optional<Result<publish::SnapshotRecord>> take(bool wait);

private:
    model::TypeSource* types_;
    std::shared_ptr<const model::SceneSpec> scene_;  ///< that blueprint_ is of
    std::string blueprint_;
    std::future<Result<publish::SnapshotRecord>> work_;
};

/// A snapshot's file: written whole or not at all (a new file takes the old one's place).
Result<void> write_snapshot(const simulation::Snapshot& snapshot, std::span<const std::string> waiting, const std::string& file);
Result<simulation::SnapshotFile> read_snapshot(const std::string& file, model::TypeSource& types);

}  // namespace plab::daemon
