/// What is known of bodies at rest, and which of them sleep. It is state: saved, restored and hashed with the contacts (contacts.h), and
/// written by SleepingIslands (sleeping_islands.h) alone.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "plab/vector.h"
#include "world/world.h"

namespace plab::simulation
{

struct SleepingIsland;

struct BodyRest
{
    std::uint32_t quiet = 0;  ///< steps in a row, up to the last one, in which the body was quiet
    bool asleep = false;
    std::uint64_t cause = 0;  ///< hash of what the rest of a sleeping body depends on; 0: awake
    // Sums of velocities over the steps of the present half of the window, and over those of the half before.
    Vec3 moved, moved_before;    ///< m/s
    Vec3 turned, turned_before;  ///< rad/s

    friend bool operator==(const BodyRest&, const BodyRest&) = default;
};

/// The start of a step for a body in an island that a manager advances.
struct RestSample
{
    std::uint64_t step = 0;   ///< StepState::serial when this was noted last
    double acceleration = 0;  ///< m/s^2, by forces alone
    Vec3 velocity, spin;      ///< m/s, rad/s
};

struct RestState
{
    std::vector<BodyRest> bodies;   ///< by host row; empty: nothing has been counted
    std::uint64_t scene_cause = 0;  ///< hash of what the rest of all sleeping bodies depends on; 0: nothing sleeps
    /// The islands that sleep, with their pairs; the cache's list has them no more. Empty although bodies sleep: their pairs are in that
    /// list, and the next step puts them away again. Shared with copies.
    std::vector<std::shared_ptr<const SleepingIsland>> islands;

    // Not hashed, as it follows from the rest.
    /// As long as this is the same object, nothing has changed about bodies that sleep: neither which, nor where they are.
    std::shared_ptr<const char> mark;
    std::vector<std::uint32_t> awake;  ///< rows of all bodies that may move, by rank; valid if `lists_awake`
    bool lists_awake = false;

    bool asleep(std::uint32_t body) const { return body < bodies.size() && bodies[body].asleep; }
    /// To be called when something may have changed about bodies that sleep.
    void note_change() { mark = std::make_shared<const char>(), lists_awake = false; }
    /// The bodies to which a change can be limited, for whoever went through all of them at the time of `since`; null: all.
    const std::vector<std::uint32_t>* changing_since(const std::shared_ptr<const char>& since) const
    {
        return since == mark ? moving() : nullptr;
    }
    /// All others sleep or never move; null: nothing is known.
    const std::vector<std::uint32_t>* moving() const { return lists_awake && !islands.empty() ? &awake : nullptr; }
    /// Copies `from`, and keeps this object's memory.
    void copy(const RestState& from);
    /// Mixed into `h`; `h` itself if there is nothing. By rank, not by row.
    std::uint64_t hash(const world::World& world, std::uint64_t h) const;
};

}  // namespace plab::simulation
