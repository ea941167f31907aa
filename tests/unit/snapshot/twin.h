/// Two runs beside each other: one that never stopped, and one that goes on from its snapshot.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "conformance/subjects.h"
#include "simulation/snapshot/compare.h"

namespace plab::test
{

/// The scenes of scenes/ (but listings that are fragments) and of tests/golden, as paths in the sources.
std::vector<std::string> scene_files();
/// Of <plab> with this body; one that does not compile fails the test.
model::SceneSpec scene_of(const std::string& body, const std::string& settings = "dt='1/60'");
/// Carries a request out at the present boundary; one that is refused fails the test.
void ask(simulation::Simulation& simulation, std::vector<simulation::Operation> operations);
/// The blueprint fragment as an operation.
simulation::AddBlueprintOperation added(const std::string& body);

/// What a step left to see: the hash of the state and every event, as text with all digits.
struct Footprint
{
    std::uint64_t hash = 0;
    std::vector<std::string> events;
    friend bool operator==(const Footprint&, const Footprint&) = default;
};
Footprint footprint(const simulation::Simulation& simulation);

/// A trajectory of steps with snapshots on the way.
struct Trajectory
{
    std::vector<Footprint> steps;  ///< after step 1, 2, ...
    std::vector<simulation::Snapshot> snapshots;
    simulation::Snapshot end;
};

struct Plan
{
    int steps = 300;                     ///< in all
    int every = 100;                     ///< steps between snapshots
    int follow = 200;                    ///< steps to compare after each
    int threads = 1, threads_after = 1;  ///< where they differ, the ledger does in its last digits
    /// The snapshot goes by way of its bytes.
    bool as_file = false;
    /// What is done to the run, and to all that went on from its snapshots, before the step of this number (from 0).
    std::function<void(simulation::Simulation&, int)> meddle = [](simulation::Simulation&, int) {};
};

Trajectory run(simulation::Simulation& simulation, const Plan& plan);
/// Goes on from each snapshot in a fresh Simulation. Why the first one differs from the trajectory; empty if none does.
std::string follow(const Trajectory& trajectory, const Plan& plan);
/// Both, for a scene.
std::string follow(const model::SceneSpec& scene, const Plan& plan);

/// The first difference of two snapshots, in words, outputs too (but what a Lua state holds); empty if there is none.
std::string difference_of(const simulation::Snapshot& first, const simulation::Snapshot& second, bool ledger = true);

}  // namespace plab::test
