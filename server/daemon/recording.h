/// What of plabd concerns recordings: the module that writes and reads them, what a recording says of its origin, and files of
/// snapshots.
#pragma once

#include <memory>
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

record::RecordOptions record_options(const DaemonOptions& options, const simulation::Simulation& simulation, model::TypeSource& types);

/// Topics without which a recording cannot be replayed, and which this choice leaves out; "" if none.
std::string missing_for_replay(const RecordChoice& choice);

simulation::HistoryOptions history_of(const DaemonOptions& options);

/// A snapshot's file: written whole or not at all (a new file takes the old one's place).
Result<void> write_snapshot(const simulation::Snapshot& snapshot, std::span<const std::string> waiting, const std::string& file);
Result<simulation::SnapshotFile> read_snapshot(const std::string& file, model::TypeSource& types);

}  // namespace plab::daemon
