/// One request carried out: all of its operations, or none.
#pragma once

#include <tuple>
#include <vector>

#include "simulation/requests/trial.h"
#include "simulation/simulation.h"

namespace plab::simulation
{

/// Takes a full backup, applies operations one after the other, tries the first step with the result, and commits or
/// brings everything back bit for bit.
class Transaction
{
public:
    Transaction(Simulation& simulation, const Request& request);
    /// Applies, verifies and commits; on any error everything is as it was.
    Reply run();

private:
    /// Everything that a step can change.
    struct State
    {
        world::Backup world;
        ContactCache contacts;
        std::vector<double> work;
        std::vector<ContactEnergy> contact_energy;
        double departed_work, requests_work;
        Reported reported;
    };
    State capture() const;
    void restore(const State& state, bool structure_changed);

    Result<void> apply(const Operation& operation);
    template <class Op>
    Result<void> go_back(const Op& op);
    Result<void> apply_one(const AddOperation& op);
    Result<void> apply_one(const AddBlueprintOperation& op);
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
    void apply_all();
    void run_on_clock();
    void run_on_scene(bool swaps);
    /// Patterns in swaps become one swap for each component that they name.
    Result<void> expand_patterns();
    Result<void> expand(const SwapOperation& op, std::vector<Operation>& out) const;
    /// Whom the request can touch, as the structure is now.
    void mark_touched(TrialScope& scope) const;
    TrialStep next_step() const;
    double budget_ns() const;
    /// Until when steps may be made for their cost alone.
    std::uint64_t measure_until(double share) const;
    std::vector<std::uint32_t> swapped() const;
    /// One step with the old components: what a swap is measured against.
    void try_old(TrialScope& scope);
    /// One step with the new ones; an error if something fails that did not fail before, or makes energy out of nothing.
    Result<void> try_new(TrialScope& scope);
    void write_reports(const TrialResult& with_new);
    /// Why the first step makes more energy than is wanted; "" if it does not.
    std::string makes_energy(const TrialResult& with_new) const;
    Result<void> build_and_try(TrialScope& scope, bool swaps);
    /// Contact points that hold something and that the component has to do with: as detector, resolution, response, manager.
    std::size_t held_points(std::uint32_t component) const;
    /// What became of standing contacts, in the reports of the swaps that did it.
    void tell_contacts();

    Simulation* s_;
    const Request* request_;
    Reply reply_;
    std::set<std::uint32_t> prepared_;   ///< components whose opaque parts were rebuilt: again after a rollback
    std::vector<Operation> operations_;  ///< of the request, patterns resolved
    std::uint64_t trial_begin_ = 0;      ///< ns
    bool old_tried_ = false;
    TrialResult old_;
    std::vector<std::size_t> held_before_;           ///< contact points, by swap
    double energy_before_ = 0, energy_applied_ = 0;  ///< J, of the whole scene at the boundary
    bool structural_ = false;
    std::vector<std::string> touched_;  ///< ids that came, went or changed
};

/// The ids of `id` and of all that is inside it, innermost first.
std::vector<std::string> subtree_of(const model::SceneSpec& scene, const std::string& id);

}  // namespace plab::simulation
