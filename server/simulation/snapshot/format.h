/// The file format of snapshots, version 1. server/docs/snapshots.md explains each section and column.
///
/// A file is a list of sections (sections.h), and each section is a table of named, typed columns. The scene is stored field by field as
/// it is in memory (format_scene.h), the fields of components by type (format_cells.h), everything else as records (records.h). Rows
/// refer to components by their row in the section "components", never by an index in memory. A missing column leaves its default; a
/// column that this build does not know is refused.
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

/// A text that accompanies a snapshot and has no meaning for the simulation: who took it, when, under which name.
struct SnapshotNote
{
    std::string name, text;
    friend bool operator==(const SnapshotNote&, const SnapshotNote&) = default;
};

struct SnapshotFile
{
    Snapshot snapshot;                 ///< its list of waiting requests is empty:
    std::vector<std::string> waiting;  ///< the requests that waited, as text in the form that the writer chose
    std::vector<SnapshotNote> notes;
    std::string build;  ///< that wrote the file: compiler and SDK; another build may read it
};

/// `waiting`: one text for each of the snapshot's waiting requests, in their order; this text is all that the file holds of them. Refused
/// if the numbers differ.
Result<std::vector<std::uint8_t>> encode(const Snapshot& snapshot, std::span<const std::string> waiting = {},
                                         std::span<const SnapshotNote> notes = {});

/// Accepts any bytes. Data that is truncated, damaged, of a newer format, or that does not fit the types that `types` provides is refused
/// with the reason. A decoded snapshot can be restored with the same types.
Result<SnapshotFile> decode(std::span<const std::uint8_t> bytes, model::TypeSource& types);

}  // namespace plab::simulation
