/// What a trial step can change in the host tables, so that it can be undone without copying the rest of the scene.
#pragma once

#include <vector>

#include "simulation/transaction/trial_scope.h"
#include "world/undo_log.h"

namespace plab::simulation
{

/// A trial moves the objects in its scope. It fixes the other participants of the components in it, whose motion, inverse mass and
/// inverse inertia are enough; its stepper derives materials and the roots of shafts. Scripts may also change parameters of components:
/// these are noted one by one (world/undo_log.h).
class TrialMemento
{
public:
    void save(const world::HostTables& host, const TrialScope& scope);
    /// Makes everything outside the scope immovable that a component in it may see.
    void fix_others(world::HostTables& host) const;
    /// The log for what scripts change within the step.
    world::UndoLog& changes() { return changes_; }

    /// Until restore(), what the stepper of the trial derived counts, in place of what was saved: the structure is a new one.
    void take_derived(const world::HostTables& host);
    /// Restores what a step has moved. The others stay fixed.
    void restore_moved(world::HostTables& host) const;
    /// Restores what a stepper derives from the structure.
    void restore_derived(world::HostTables& host) const;
    /// Restores everything as it was when it was saved, except what changes() holds.
    void restore(world::HostTables& host) const;

private:
    std::vector<std::uint32_t> moved_bodies_, moved_shafts_, moved_quantities_;  ///< in the scope, ascending
    std::vector<std::uint32_t> fixed_bodies_, fixed_shafts_;                     ///< outside it, ascending
    Bodies bodies_;                                                              ///< of moved_bodies_, without shapes
    std::vector<std::vector<double>> quantities_;                                ///< of moved_quantities_
    Shafts shafts_;                                                              ///< all, without axles and shapes
    Materials materials_;
    CollisionFilter filter_;
    bool derived_anew_ = false;
    Shafts own_shafts_;  ///< all, only what is derived, if it was taken; as the next one
    Materials own_materials_;
    CollisionFilter own_filter_;
    std::vector<Motion> motion_;  ///< of fixed_bodies_, as the next two
    std::vector<double> inverse_mass_;
    std::vector<Mat3> inverse_inertia_B_;
    world::UndoLog changes_;
};

}  // namespace plab::simulation
