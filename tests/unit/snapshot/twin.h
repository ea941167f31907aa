/// Two runs compared with each other: one that never stopped, and one that continues from its snapshot.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "conformance/subjects.h"
#include "simulation/snapshot/compare.h"

namespace plab::test
{

/// The scenes of scenes/ (except listings that are fragments) and of tests/golden, as paths in the sources.
std::vector<std::string> scene_files();
/// Of <plab> with this body; one that does not compile fails the test.
model::SceneSpec scene_of(const std::string& body, const std::string& settings = "dt='1/60'");
/// Carries a request out at the present boundary; one that is refused fails the test.
void ask(simulation::Simulation& simulation, std::vector<simulation::Operation> operations);
/// The blueprint fragment as an operation.
simulation::AddBlueprintOperation added(const std::string& body);

/// The observable result of a step: the hash of the state and every event, as text with all digits.
struct Footprint
{
    std::uint64_t hash = 0;
    std::vector<std::string> events;
    friend bool operator==(const Footprint&, const Footprint&) = default;
};
Footprint footprint(const simulation::Simulation& simulation);

/// A trajectory of steps with snapshots in between.
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
    int threads = 1, threads_after = 1;  ///< if they differ, the ledger differs in its last digits
    /// The snapshot is written to bytes and read back.
    bool as_file = false;
    /// Changes made to the run, and to all that continued from its snapshots, before the step of this number (from 0).
    std::function<void(simulation::Simulation&, int)> meddle = [](simulation::Simulation&, int) {};
};

Trajectory run(simulation::Simulation& simulation, const Plan& plan);
/// Continues from each snapshot in a fresh Simulation. Returns why the first one differs from the trajectory; empty if none does.
std::string follow(const Trajectory& trajectory, const Plan& plan);
/// Both, for a scene.
std::string follow(const model::SceneSpec& scene, const Plan& plan);

/// The first difference of two snapshots as text, including outputs (except the content of a Lua state); empty if there is none.
std::string difference_of(const simulation::Snapshot& first, const simulation::Snapshot& second, bool ledger = true);

}  // namespace plab::test
