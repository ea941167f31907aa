/// A run at one boundary between two steps, as a value: all that its future depends on. Restoring it and going on is the same,
/// bit for bit, as never having left. Immutable and shared: copies cost a pointer, and any thread may read one.
///
/// What is in it, what is not, and the file form: server/docs/snapshots.md.
#pragma once

#include <memory>
#include <vector>

#include "simulation/contacts/contacts.h"
#include "simulation/requests/requests.h"
#include "simulation/step/stepper.h"
#include "simulation/watch/divergence_watch.h"
#include "world/image.h"

namespace plab::simulation
{

/// Known contacts, without the empty places of manifolds that are not full.
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
    std::uint64_t next_id = 1;
};

struct ClockImage
{
    Tick tick = 0;
    model::StepLength dt;
    Tick base_tick = 0;
    double base_time = 0;  ///< s
    bool paused = false;
    std::int64_t steps_left = 0;
    double rate = 0;
    // Of the step before.
    Tick last_tick = 0;
    double last_start = 0, last_step = 0;  ///< s

    double time() const { return base_tick == 0 ? dt.at(tick) : base_time + dt.at(tick - base_tick); }  ///< s
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
    std::shared_ptr<const model::SceneSpec> loaded;  ///< what a reset goes back to
    ContactsImage contacts;
    ClockImage clock;
    LedgerImage ledger;
    Reported reported;
    std::vector<std::uint32_t> split;  ///< Stepper::split(); clusters stand in the order of ids
    DivergenceMemory watch;
    std::uint64_t run = 0, revision = 0;  ///< at the time; a restored run counts on from its own
    std::uint64_t state_hash = 0;
    /// Requests of this run that waited for their step.
    std::vector<std::shared_ptr<const Request>> waiting;
};

class Snapshot
{
public:
    Snapshot() = default;  ///< of nothing: restoring it is refused
    explicit Snapshot(std::shared_ptr<const SnapshotContent> content) : content_(std::move(content)) {}

    explicit operator bool() const { return content_ != nullptr; }
    const SnapshotContent& operator*() const { return *content_; }
    const SnapshotContent* operator->() const { return content_.get(); }

private:
    std::shared_ptr<const SnapshotContent> content_;
};

/// What a stepper holds beside its world, to and from an image.
ContactsImage image_of(const ContactCache& cache);
/// Into a stepper that was built for a world made from the image; sorted anew, by the ids there.
void restore_contacts(const ContactsImage& image, const world::Renumbering& now, const world::World& world, ContactCache& cache);

}  // namespace plab::simulation
