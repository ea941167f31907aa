/// What a transaction may change, saved so that a refused request leaves no trace.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "simulation/run/run.h"

namespace plab::simulation
{

/// A log of changes instead of a copy of the world: exchanging, setting and pushing change only components that the request names, and
/// those are noted before they change (world/undo_log.h). In addition there is what the rebuild of a stepper changes: the materials, the
/// roots of shafts, and contacts, which are copied only if the request changes bodies, shapes or detections. Additions and removals
/// change the structure: from the first one on, a full backup takes over.
class SavedState
{
public:
    void begin(Run& run, bool with_contacts);
    /// To be called before components are added or removed.
    void add_backup();
    /// The changes stay.
    void end();
    /// Restores everything, and rebuilds the stepper. `prepared`: components whose opaque parts were rebuilt in the meantime.
    void restore(const std::set<std::uint32_t>& prepared);
    /// The same where the stepper has not been rebuilt since begin(), and nothing was added or removed.
    void restore_world(const std::set<std::uint32_t>& prepared);

private:
    void restore_derived() const;

    Run* run_ = nullptr;
    world::UndoLog log_;
    std::optional<world::Backup> backup_;  ///< of the time of the first addition or removal
    std::optional<ContactCache> contacts_;
    Materials materials_;
    CollisionFilter filter_;
    Shafts shafts_;  ///< only the columns that a stepper derives (kDerivedShaftColumns)
    std::vector<double> work_;
    std::vector<ContactEnergy> contact_energy_;
    double departed_work_ = 0, requests_work_ = 0;
    Reported reported_;
};

/// Whether contacts follow from this component: a body, a shape, a detection, or a part of one (its response, manager, resolution).
bool concerns_contacts(const world::World& world, std::uint32_t component);

}  // namespace plab::simulation
