/// What changes of single components have overwritten, so that they can be taken back without a copy of the world.
#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "model/scene.h"
#include "world/component.h"
#include "world/host_tables.h"

namespace plab::world
{

/// Everything in one row of a host table.
class HostRow
{
public:
    HostRow(const HostTables& tables, Facet facet, std::uint32_t index);
    void restore(HostTables& tables) const;

private:
    Facet facet_;
    std::uint32_t index_;
    Bodies body_;
    Shafts shaft_;
    std::vector<double> quantities_;
    Geometry geometry_;
    MassProperties solid_;
    std::string unmeasurable_;
};

/// The former state of each component that was changed since the log was begun (World::note_in), in the order of the first changes. Its
/// size is that of what was changed. It covers exchanges, values and host rows, but not additions and removals, for which a backup is made.
struct UndoLog
{
    struct Entry
    {
        std::uint32_t component;
        Component before;
        std::vector<std::uint8_t> cells;  ///< params, state and outputs
        HostRow host;
    };
    /// A component of the scene that was replaced.
    struct Respecified
    {
        std::size_t place;
        std::shared_ptr<const model::ComponentSpec> before;
    };
    std::vector<Entry> entries;
    std::vector<Respecified> specs;
    std::set<std::uint32_t> noted;  ///< components with an entry
    std::size_t parked = 0;         ///< rows that were parked when the log was begun
};

}  // namespace plab::world
