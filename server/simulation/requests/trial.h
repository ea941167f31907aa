/// One step of a part of the scene, made and taken back: what a swap is measured by.
#pragma once

#include <set>
#include <string>

#include "simulation/requests/requests.h"
#include "simulation/requests/trial_scope.h"

namespace plab::simulation
{

/// A step at a boundary, as Simulation would make it next.
struct TrialStep
{
    Tick tick = 0;
    double start = 0, h = 0;  ///< s
};

struct TrialResult
{
    bool given_up = false;
    std::string failure;         ///< "" or the first event of severity Failure
    double before = 0;           ///< J, kinetic and stored energy of those in the scope, where the step begins
    double moving = 0;           ///< J, kinetic energy there, of those that move as told too
    double kinetic_after = 0;    ///< J, where it ends
    double least = 0;            ///< J: what moves slower than shows in a step has no more
    StepOutcome outcome;         ///< of those in the scope; without error and cost
    Spread cost;                 ///< ns, of the step made again; no samples: not measured
    std::vector<double> errors;  ///< of the components that were asked for
};

/// A stepper of its own for those in the scope, at the present state of the world. Everybody else stands still as if fixed, and nothing of
/// what the scene's own stepper keeps is touched: so a trial costs what its part of the scene costs, and cannot change a bit.
class Trial
{
public:
    Trial(world::World& world, const Stepper& stepper, const TrialStep& step);
    /// The scope grows by whoever is met in that step and was not in it; then the step is made again. `components`: whose errors are
    /// wanted. `until_ns`: the step is made again for its cost until then, but not often (0: it is not). Whatever comes of it, the world is
    /// as it was before.
    TrialResult run(TrialScope& scope, const std::vector<std::uint32_t>& components, const Interruption& deadline, Progress& progress,
                    std::uint64_t until_ns);

private:
    void fix_everybody_else(const TrialScope& scope);
    void set_up(Stepper& part, const TrialScope& scope) const;
    void keep_cells(const TrialScope& scope);
    void put_back();
    bool grow(TrialScope& scope, const Stepper& part) const;
    TrialResult once(Stepper& part, const std::vector<std::uint32_t>& components, const Interruption& deadline);
    Spread measure(Stepper& part, const TrialScope& scope, const Interruption& deadline, std::uint64_t until_ns);
    static void apply_changes(void* self, std::vector<ParameterChange>& changes);

    world::World& world_;
    const Stepper& stepper_;  ///< of the scene
    TrialStep step_;
    world::HostTables host_;
    std::vector<std::uint32_t> kept_;  ///< components
    ByteWriter cells_;                 ///< theirs
    std::set<std::uint32_t> prepared_;
    Stepper* part_ = nullptr;  ///< at work
};

}  // namespace plab::simulation
