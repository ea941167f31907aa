/// The parts of plabd that concern recordings: the module that writes and reads them, the metadata about the origin of a
/// recording, and files of snapshots.
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

/// record.so, loaded; objects that it made must be destroyed before it.
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

/// Topics that a replay needs and this choice leaves out; "" if none.
std::string missing_for_replay(const RecordChoice& choice);

simulation::HistoryOptions history_of(const DaemonOptions& options);

/// A snapshot's file: replaced as a whole or not at all (a new file is renamed over the old one).
Result<void> write_snapshot(const simulation::Snapshot& snapshot, std::span<const std::string> waiting, const std::string& file);
Result<simulation::SnapshotFile> read_snapshot(const std::string& file, model::TypeSource& types);

}  // namespace plab::daemon
