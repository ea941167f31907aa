/// Recording as the daemon sees it. The daemon loads build/lib/plab/record.so when a run is to be recorded or replayed; without
/// it, no compressor and no file format is mapped.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "publish/observer.h"
#include "record/run_log.h"

namespace plab::record
{

struct RecordOptions
{
    std::string file;
    bool overwrite = false;
    std::string compression = "zstd";            ///< "none", "lz4", "zstd"
    std::vector<std::string> topics;             ///< none: all but images and contacts
    double state_interval = 0;                   ///< s, simulated, between frames; 0: each step
    bool moved_only = false;                     ///< frames contain only what moved since the last one; a full one each second
    double metrics_interval = 0.25;              ///< s, simulated
    double snapshot_interval = 5;                ///< s, simulated
    std::size_t most_waiting_bytes = 64u << 20;  ///< between the step thread and the writer

    // What the file states about its origin.
    std::string server, version, scene_file;
    std::string build;      ///< another build may give other digits
    std::string blueprint;  ///< long form of the loaded scene
    double dt = 0;          ///< s
    std::uint32_t threads = 1;

    /// Logs a line about trouble with the disk. Called on the writer's thread. Null: standard error.
    void (*log)(void*, const char* line) = nullptr;
    void* log_argument = nullptr;
};

/// Writes what it observes. The step thread hands records over and never waits; records that find no room are counted.
class Recording : public publish::Observer
{
public:
    virtual wire::RecordingInfo progress() const = 0;
    /// Writes what waits and completes the file. Nothing may be handed over afterwards.
    virtual Result<void> close() = 0;
};

/// What record.so exports under these names. On failure it returns nothing, and the reason.
using OpenRecording = std::unique_ptr<Recording> (*)(const RecordOptions& options, Error& error);
inline constexpr const char* kRecordingEntry = "plab_record_open";
using OpenRunLog = std::unique_ptr<RunLog> (*)(const std::string& file, Error& error);
inline constexpr const char* kRunLogEntry = "plab_record_read";

}  // namespace plab::record
