/// Carries out one request: either all of its operations take effect, or none.
#pragma once

#include <tuple>
#include <vector>

#include "simulation/run/run.h"
#include "simulation/transaction/saved_state.h"
#include "simulation/transaction/trial.h"

namespace plab::simulation
{

/// Operations that replace the run as a whole, or need its history. Whoever owns the run carries them out.
class RunOperations
{
public:
    virtual ~RunOperations() = default;
    virtual Result<void> load(const model::SceneSpec& scene) = 0;
    /// Keeps the present state under a name; forgets it; continues from it.
    virtual Result<void> keep(const std::string& name) = 0;
    virtual Result<void> forget(const std::string& name) = 0;
    virtual Result<void> restore(const std::string& name) = 0;
    /// Returns to the step nearest to a time of this run, s.
    virtual Result<void> rewind(double time) = 0;
};

/// What the first step (or steps) with a request gave, for all objects that the request can affect.
struct FirstStep
{
    std::vector<std::vector<ObjectMotion>> course;  ///< after each step: bodies first, each in the order of host rows
    std::vector<double> energies;                   ///< J, kinetic and stored, after each step, if asked for
    double seconds = 0;                             ///< that one step takes, the median of some; 0: not measured
};

/// What a look at the first steps with a request shall tell.
struct FirstStepChoice
{
    int steps = 1;
    bool energies = false;
    const CourseEnd* end = nullptr;  ///< null: all steps are made
    std::uint64_t measure_ns = 0;    ///< time for which the first step may be repeated to measure what it costs; 0: it is not measured
};

/// A transaction: back up, apply, try, then commit or roll back.
///
/// First everything that the operations can change is saved (saved_state.h): for an exchange, the components that it names. If the request
/// swaps components, one trial step with the old components is made for comparison. Then the operations are applied one after the other,
/// each on the result of the one before, the stepper is rebuilt for the new structure, and one trial step is made with the result
/// (trial.h). Trial steps are always undone; they only yield measurements.
///
/// The request is refused if an operation or the rebuild fails, if the trial step fails although the step with the old components did
/// not, if a swap creates energy, or if the trial exceeds its budget and the request demands a trial. Then everything is rolled back:
/// world, contact caches, energy ledger, reported warnings and clock are bit for bit what they were, so a refused request leaves no trace
/// in the run. That includes what rebuilding may have changed although no operation named it: contacts, materials and shaft anchors.
/// Opaque parts, such as the compiled chunk of a script, cannot be copied; they are prepared again from the restored parameters.
/// Operations that concern only the clock need a copy of the clock only.
class Transaction
{
public:
    Transaction(Run& run, RunContext& context, RunOperations& operations, const Request& request);
    /// Applies, tries and commits the request. On any error everything is as it was before.
    Reply run();
    /// Makes the first step, or steps, with the request, and undoes all: they leave no trace.
    Result<FirstStep> first_step(const FirstStepChoice& choice);

private:
    Result<void> apply(const Operation& operation);
    template <class Op>
    Result<void> go_back(const Op& op);
    Result<void> apply_one(const AddOperation& op);
    Result<void> apply_one(const AddBlueprintOperation& op);
    /// For an addition: the components from the `first` one on are to be new.
    void note_added(const model::ComponentList& specs, std::size_t first);
    Result<void> apply_one(const RemoveOperation& op);
    Result<void> apply_one(const SwapOperation& op);
    Result<void> apply_one(const SetOperation& op);
    Result<void> apply_one(const PushOperation& op);

    Result<std::uint32_t> find_typed(const std::string& id) const;
    Result<model::ComponentSpec> spec_for_swap(std::uint32_t component, const SwapOperation& op, SwapReport& report);
    void fit_roles(model::ComponentSpec& spec, const Schema& schema, SwapReport& report) const;
    Result<void> make_missing(model::ComponentSpec& spec, const Schema& schema, SwapReport& report);
    Result<void> exchange(std::uint32_t component, const model::ComponentSpec& spec, const SwapReport& report);
    Result<Value> new_value(std::uint32_t component, const Field& field, const SetOperation& op) const;

    using Clock = std::tuple<bool, std::int64_t, double, model::StepLength, Tick, double>;
    Clock read_clock() const;
    void write_clock(const Clock& clock);
    /// Of the request, with patterns resolved.
    const std::vector<Operation>& operations() const { return operations_.empty() ? request_->operations : operations_; }
    bool changes_contacts() const;
    void apply_all();
    void run_on_clock();
    void run_on_scene(bool swaps);
    /// Replaces each swap whose id is a pattern by one swap for each component that matches.
    Result<void> expand_patterns();
    Result<void> expand(const SwapOperation& op, std::vector<Operation>& out) const;
    /// Marks the objects that the request can affect in the present structure.
    void mark_touched(TrialScope& scope) const;
    TrialStep next_step() const;
    double budget_ns() const;
    /// Objects on which a swap is tried at most; 0: no limit.
    std::size_t most_in_trial() const;
    /// The time (ns) until which trial steps may be repeated only to measure their cost.
    std::uint64_t measure_until(double share) const;
    std::vector<std::uint32_t> swapped() const;
    /// One step with the old components: the reference for a swap.
    void try_old(TrialScope& scope);
    /// One step with the new components. Returns an error if it fails although the old components did not, or if energy is created.
    Result<void> try_new(TrialScope& scope);
    void write_reports(const TrialResult& with_new);
    /// The reason why the first step creates more energy than is allowed; empty if it does not.
    std::string makes_energy(const TrialResult& with_new) const;
    Result<void> build_and_try(TrialScope& scope, bool swaps);
    /// The number of persistent contact points of which the component is detector, resolution, response or manager.
    std::size_t held_points(std::uint32_t component) const;
    /// Records in the reports of the swaps what happened to persistent contacts.
    void report_contacts();

    Run* run_;
    RunContext* context_;
    RunOperations* whole_;
    const Request* request_;
    Reply reply_;
    SavedState saved_;
    std::set<std::uint32_t> prepared_;      ///< components whose opaque parts were rebuilt, to be rebuilt again after a rollback
    std::vector<Operation> operations_;     ///< of the request, with patterns resolved
    std::vector<std::string> known_types_;  ///< names of types, once they are needed
    std::uint64_t trial_begin_ = 0;         ///< ns
    bool old_tried_ = false;
    TrialResult old_;
    std::vector<std::size_t> held_before_;                                ///< contact points, by swap
    double energy_before_ = 0, energy_applied_ = 0, kinetic_before_ = 0;  ///< J, of the whole scene at the boundary
    world::Revisions revisions_before_;                                   ///< of the world at the boundary
    bool looked_ = false;                                                 ///< see TrialStep::looked; at that time
    bool structural_ = false;
    std::vector<std::string> touched_;  ///< ids that were added, removed or changed
    std::vector<std::string> added_;    ///< by add operations
};

/// The ids of `id` and of everything inside it, innermost first.
std::vector<std::string> subtree_of(const model::SceneSpec& scene, const std::string& id);

}  // namespace plab::simulation
