/// A recording as a replay reads it: its runs, where each can start, the requests of the run, and the hash of every step.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plab/context.h"
#include "plab/result.h"
#include "publish/records.h"

namespace plab::record
{

/// Position of a snapshot in a recording.
struct RecordedSnapshot
{
    std::uint64_t run = 0;
    Tick step = 0;
    double time = 0;  ///< s
    std::string name, cause;
    std::uint64_t place = 0;  ///< defined by the reader
};

class RunLog
{
public:
    virtual ~RunLog() = default;

    /// In the order of the recording. A run can be replayed from the first of its snapshots on.
    virtual const std::vector<RecordedSnapshot>& snapshots() const = 0;
    virtual Result<wire::Snapshot> read(const RecordedSnapshot& snapshot) = 0;
    /// Requests that took effect in a run, in their order.
    virtual Result<std::vector<wire::Journal>> journal(std::uint64_t run) = 0;
    /// The next hashes of the run that was requested last; empty at its end.
    virtual Result<void> begin_hashes(std::uint64_t run) = 0;
    virtual Result<std::optional<wire::Hashes>> next_hashes() = 0;
    /// The frame that was recorded after this step of the run, or the first one after a later step; empty if there is none.
    virtual Result<std::optional<wire::Frame>> frame(std::uint64_t run, Tick step) = 0;
    /// Ids by handle, as the catalogue named them in that run.
    virtual Result<std::vector<std::pair<std::uint32_t, std::string>>> objects(std::uint64_t run) = 0;
    /// Metadata "plab": version, scene file, ...; "" if the file lacks it.
    virtual std::string origin(const std::string& key) const = 0;
    /// What is wrong with the file although it can be read, for example that it is truncated. "" if nothing is.
    virtual std::string damage() const = 0;
};

}  // namespace plab::record
