/// Snapshots as bytes: format 1. What each section and column means is in server/docs/snapshots.md.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "model/type_registry.h"
#include "simulation/snapshot/snapshot.h"

namespace plab::simulation
{

inline constexpr std::uint32_t kSnapshotFormat = 1;

/// A text that goes with a snapshot and means nothing to the simulation: who took it, when, under which name.
struct SnapshotNote
{
    std::string name, text;
    friend bool operator==(const SnapshotNote&, const SnapshotNote&) = default;
};

struct SnapshotFile
{
    Snapshot snapshot;                 ///< its `waiting` is empty:
    std::vector<std::string> waiting;  ///< requests that waited, in the words of whoever wrote them
    std::vector<SnapshotNote> notes;
    std::string build;  ///< that wrote it: compiler and SDK; another one may read it
};

/// `waiting`: a text for each of the snapshot's waiting requests, in their order; the file has nothing else of them. Refused
/// if there are more or fewer.
Result<std::vector<std::uint8_t>> encode(const Snapshot& snapshot, std::span<const std::string> waiting = {},
                                         std::span<const SnapshotNote> notes = {});

/// Any bytes. What is cut, damaged, of a newer format, or does not fit the types that `types` supplies is refused with the
/// reason; a snapshot that comes out can be restored with the same types.
Result<SnapshotFile> decode(std::span<const std::uint8_t> bytes, model::TypeSource& types);

}  // namespace plab::simulation
