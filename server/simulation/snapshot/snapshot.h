/// A snapshot: one run at a boundary between two steps, as a value that holds everything on which the future of the run depends.
/// Restoring it and continuing gives bit for bit the same results as if the run had never been interrupted. Snapshots are immutable and
/// shared: a copy costs one pointer, and any thread may read one.
///
/// Capture (capture.cpp) copies the world's image, the contact caches (warm-start impulses, springs of contacts, ids), the clock, the
/// energy ledger, the memory of the watches, the partition of solver groups, the waiting requests, and the hash of the state. Whatever
/// follows from these data (geometry, schedule, groups) or is declared opaque is left out and rebuilt.
///
/// Restore (restore.cpp) builds a new world from the snapshot's own scene, loads the values, rebuilds the stepper, and translates all
/// indices: components and host rows may have other numbers in the new world, so contacts and ledgers are mapped by id and sorted again.
/// Then the hash of the state is compared with the captured one (unless a type has gained state fields since the capture). Only if it
/// matches does the new run replace the present one; otherwise the first difference is reported (compare.h) and the present run continues
/// untouched.
///
/// Contents, exclusions and file format: server/docs/snapshots.md. The file format is in format.h, the way back to earlier steps in
/// history.h.
#pragma once

#include <memory>
#include <vector>

#include "simulation/run/run.h"
#include "world/image.h"

namespace plab::simulation
{

/// The cached contacts, without the unused entries of manifolds that are not full.
struct ContactsImage
{
    struct Pairs
    {
        std::vector<PairHead> heads;
        std::vector<KnownContact> points;  ///< head.count of each
    };
    struct ForcePairs
    {
        std::vector<ForcePairHead> heads;
        std::vector<ForceContact> points;
    };
    Pairs pairs, parked;
    ForcePairs force_pairs, parked_force_pairs;
    std::vector<BodyRest> rest;  ///< by body
    std::uint64_t rest_cause = 0;
    std::vector<double> crowded_until;  ///< s, by body: ContactCache::crowded_until()
    std::uint64_t next_id = 1;
};

struct ClockImage : RunClock
{
    // Of the previous step.
    Tick last_tick = 0;
    double last_start = 0, last_step = 0;  ///< s
};

struct LedgerImage
{
    std::vector<double> work;                   ///< J, by component
    std::vector<ContactEnergy> contact_energy;  ///< by component
    double departed = 0, requests = 0;
    double kinetic_at_start = 0;
};

/// Indices (components, host rows) are those of world.directory.
struct SnapshotContent
{
    world::Image world;
    std::shared_ptr<const model::SceneSpec> loaded;  ///< the scene to which a reset returns
    ContactsImage contacts;
    ClockImage clock;
    LedgerImage ledger;
    Reported reported;
    std::vector<std::uint32_t> split;  ///< Stepper::split(); clusters are in the order of ids
    DivergenceMemory watch;
    std::uint64_t run = 0,
                  revision = 0;  ///< at the time of the capture; a restored run continues the counts of the Simulation that restores it
    std::uint64_t state_hash = 0;
    /// Requests of this run that were waiting for their step.
    std::vector<std::shared_ptr<const Request>> waiting;
};

class Snapshot
{
public:
    Snapshot() = default;  ///< empty: restoring it is refused
    explicit Snapshot(std::shared_ptr<const SnapshotContent> content) : content_(std::move(content)) {}

    explicit operator bool() const { return content_ != nullptr; }
    const SnapshotContent& operator*() const { return *content_; }
    const SnapshotContent* operator->() const { return content_.get(); }

private:
    std::shared_ptr<const SnapshotContent> content_;
};

/// The run at the present boundary between two steps as a value; empty before the first scene is loaded. The cost is one copy of the state
/// plus its hash.
Snapshot capture(const Run& run);
/// A world and a stepper in the state of the snapshot. Types that are not loaded yet are loaded. Errors: a type is missing or has changed;
/// the state that results differs from the captured one.
Result<LiveScene> revive(const RunContext& context, const SnapshotContent& from);
/// Gives a run whose world was revived from the snapshot its clock and memory. Requests that were waiting at the capture wait again; all
/// others belong to a run that has ended.
void continue_from(Run& run, const SnapshotContent& from);

/// Conversion between an image and what a stepper holds in addition to its world.
ContactsImage image_of(const ContactCache& cache, const world::World& world);
/// Restores contacts into a stepper whose world was made from the image; they are sorted again by the ids of that world.
void restore_contacts(const ContactsImage& image, const world::Renumbering& now, const world::World& world, ContactCache& cache);

}  // namespace plab::simulation
