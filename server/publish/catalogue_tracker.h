/// Tracks the catalogue of a running scene: what it consists of, and which part of that has changed.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "model/type_summary.h"
#include "publish/records.h"
#include "publish/roster.h"
#include "simulation/simulation.h"

namespace plab::publish
{

class CatalogueTracker
{
public:
    explicit CatalogueTracker(const std::vector<model::TypeSummary>& types);

    /// Records what happened. `boundary`: the step before which requests took effect.
    void follow(const simulation::Simulation& simulation, const simulation::Changes& changes, Tick boundary);
    /// Fields that scripts set no longer count as changes: scripts may set them at each step, which is more often than any
    /// client reads them.
    void release_scripted(const simulation::Simulation& simulation);

    /// Whether there is anything to send.
    bool news() const { return everything_ || scene_changed_ || types_changed_ || !touched_.empty() || !gone_.empty(); }
    /// Whether that is the whole scene.
    bool all_new() const { return everything_; }
    CatalogueChange everything(const simulation::Simulation& simulation) const;
    CatalogueChange changes(const simulation::Simulation& simulation) const;
    /// Everything was sent.
    void clear();

    const Roster& roster() const { return roster_; }

private:
    void compare(const simulation::Simulation& simulation, Tick boundary);
    void spread(const simulation::Simulation& simulation);
    bool mark_dependent(const world::World& world, const model::ComponentSpec& spec);
    void mark_loaded_types(const world::World& world);

    Roster roster_;
    std::vector<wire::Type> types_;
    std::uint64_t run_ = 0, revision_ = 0;
    double dt_ = 0;
    std::size_t tables_ = 0;  ///< tables of the world when the types were last checked
    bool everything_ = false, scene_changed_ = false, types_changed_ = false;
    bool came_or_went_ = false;
    std::set<std::string> touched_, gone_;
    std::set<std::uint32_t> scripted_;  ///< directory indices
};

}  // namespace plab::publish
