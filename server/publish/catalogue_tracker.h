/// The catalogue of a running scene: what it is made of, and what of that has changed.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "publish/records.h"
#include "publish/roster.h"
#include "simulation/simulation.h"

namespace plab::publish
{

class CatalogueTracker
{
public:
    explicit CatalogueTracker(std::vector<model::TypeSummary> types) : types_(std::move(types)) {}

    /// Takes note of what happened. `boundary`: the step before which requests took effect.
    void follow(const simulation::Simulation& simulation, const simulation::Changes& changes, Tick boundary);
    /// What scripts set is news from now on: they may set it at each step, which is more often than anybody reads it.
    void release_scripted(const simulation::Simulation& simulation);

    /// Whether there is anything to tell.
    bool news() const { return everything_ || scene_changed_ || types_changed_ || !touched_.empty() || !gone_.empty(); }
    /// Whether that is the whole scene.
    bool all_new() const { return everything_; }
    CatalogueChange everything(const simulation::Simulation& simulation) const;
    CatalogueChange changes(const simulation::Simulation& simulation) const;
    /// Everything was told.
    void clear();

    const Roster& roster() const { return roster_; }

private:
    void compare(const simulation::Simulation& simulation, Tick boundary);
    void spread(const simulation::Simulation& simulation);
    bool touch_what_follows(const world::World& world, const model::ComponentSpec& spec);
    void mark_loaded_types(const world::World& world);

    Roster roster_;
    std::vector<model::TypeSummary> types_;
    std::uint64_t run_ = 0, revision_ = 0;
    double dt_ = 0;
    std::size_t tables_ = 0;  ///< of the world, when types were last looked at
    bool everything_ = false, scene_changed_ = false, types_changed_ = false;
    bool came_or_went_ = false;
    std::set<std::string> touched_, gone_;
    std::set<std::uint32_t> scripted_;  ///< directory indices
};

}  // namespace plab::publish
