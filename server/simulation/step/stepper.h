/// Makes one step of a world: runs the nodes of step_tree.h, including rewinds to events inside the step.
///
/// The stepper owns the modules of the step and calls them in order:
///   motion          advances groups by their solvers, and rewinds them
///   contacts        known contacts, and the solution of persistent ones
///   contact_forces  force contacts (springs)
///   advance         combines the above over a part of a step
///   events          impacts inside a step
#pragma once

#include <optional>

#include "simulation/contacts/body_touches.h"
#include "simulation/contacts/sleeping_contacts.h"
#include "simulation/costs/cost_book.h"
#include "simulation/events/event_locator.h"
#include "simulation/shafts/coupling_watch.h"
#include "simulation/step/render_scene.h"
#include "world/command_call.h"

namespace plab::simulation
{

class Stepper
{
public:
    Stepper(world::World& world, int threads);

    /// From the next rebuild on only these components take part; null: all. Must outlive this object.
    void restrict_to(const Selection* part) { part_ = part, built_from_.reset(); }
    /// For a part of a scene: takes over from the stepper of the whole scene what does not depend on the part. To be called before the
    /// first rebuild.
    void take_over(const Stepper& whole) { book_.take_sizes(whole.book_); }
    /// The state of the world was replaced, and not only its structure changed. To be called before rebuild().
    void forget_state() { built_from_.reset(), book_.forget_found(); }
    /// To be called after any structural change and after changes of parameters: derives schedule, groups, constraint graph and materials
    /// as far as they may have changed (world::Revisions). The result is the same, bit for bit, as if all of it were derived. On error (a
    /// contradictory graph) the world must be put back and rebuilt.
    Result<void> rebuild();
    /// `interruption` may abort a step, `progress` receives how far a step has got; null: none. Both must outlive this object.
    void set_interruption(const Interruption* interruption, Progress* progress) { interruption_ = interruption, progress_ = progress; }
    /// Steps from tick to tick + 1 by running the nodes of the step tree (step_tree.cpp). Times in s.
    void step(Tick tick, double start_time, double dt);

    /// The last step was aborted: the world is in an intermediate state and has to be restored.
    bool gave_up() const { return interruption_ && interruption_->has_interrupted(); }

    // The last step ---------------------------------------------------------------------------------------------------
    const std::vector<Event>& events() const { return step_.events; }
    void emit(Event event) { step_.emit(std::move(event)); }
    const StepReport& report() const { return step_.report; }
    const CostMeter& meter() const { return step_.meter; }
    /// Its time and length: a swap at the boundary after it needs them to convert impulses to forces.
    const StepFrame& frame() const { return step_.frame; }
    void continue_after(Tick tick, double start_time, double step)
    {
        step_.frame.tick = tick, step_.frame.start_time = start_time, step_.frame.step = step;
    }
    /// For a part of a scene: lets the resolutions that adapt choose as they would at present in a step of the whole scene. To be called
    /// before the rest of the scene is fixed; they write their outputs.
    void search_as(const Stepper& whole, Tick tick, double start_time, double step);
    bool adapts() const { return book_.adapts(); }
    /// Whether all detectors have looked at all bodies where these are now.
    bool has_looked_at_all() const { return hard_.has_looked_at_all(); }
    /// Whether all of them look at the bodies of a step once, where these are at its start.
    bool looks_once() const { return hard_.looks_once(); }
    /// For a part of a scene whose other bodies stay where they are, if all detectors have looked at all bodies there: from now on they
    /// look only for pairs with one of these bodies. Null: for all. Must outlive this object.
    void look_among(const IndexSet* bodies) { book_.look_among(bodies); }
    /// The bodies are back where they were: the detectors look at them there. False if look_among() was not called.
    bool look_again();
    std::uint64_t state_hash() const;

    // What was derived from the world's structure ---------------------------------------------------------------------
    /// Those that take part, in id order.
    std::span<const std::uint32_t> components() const { return part_ ? part_->components : step_.world.in_id_order(); }
    const Schedule& schedule() const { return step_.schedule; }
    const Groups& groups() const { return step_.groups; }
    const ConstraintGraph& graph() const { return step_.graph; }
    const std::vector<Detector>& detectors() const { return book_.detectors(); }
    std::span<const double> radius_of_body() const { return book_.radius_of_body(); }

    // Contacts --------------------------------------------------------------------------------------------------------
    ContactCache& contacts() { return book_.cache(); }
    const ContactCache& contacts() const { return book_.cache(); }
    const ContactForces& forces() const { return forces_; }
    const std::vector<FoundContact>& touching() const { return book_.found(); }
    /// Whether the steps from the next one on are to note what contacts do in them, and the notes of the last step.
    void log_contacts(bool on) { book_.log().keep(on); }
    const ContactLog& contact_log() const { return book_.log(); }

    // Ledger ----------------------------------------------------------------------------------------------------------
    std::vector<ContactEnergy>& contact_energy() { return step_.contact_energy; }
    const std::vector<ContactEnergy>& contact_energy() const { return step_.contact_energy; }
    std::vector<double>& work() { return step_.work; }  ///< J by component, since the run began
    const std::vector<double>& work() const { return step_.work; }
    /// To be called before a component is removed: its work stays in the ledger, and the next component with its index starts with none.
    void retire(std::uint32_t component);
    /// J, work of components that have been removed.
    double& departed_work() { return departed_work_; }
    double departed_work() const { return departed_work_; }
    /// J, work of requests: energy that a set, push or swap changed at once.
    double& requests_work() { return requests_work_; }
    double requests_work() const { return requests_work_; }
    /// Adds to the cost that the coming step has for a component: ns of what it did before the step (Phase::Decide).
    void charge(std::uint32_t component, std::int64_t ns) { step_.meter.of_component(component) += ns; }
    CostBook& cost() { return cost_; }
    const CostBook& cost() const { return cost_; }

    // State that a snapshot keeps in addition to the world ------------------------------------------------------------
    /// See BatchedAdvance::split().
    const std::vector<std::uint32_t>& split() const { return advance_.batches().split(); }
    void continue_split(const std::vector<std::uint32_t>& split) { advance_.batches().continue_split(split); }
    Reported& reported() { return step_.reported; }
    const Reported& reported() const { return step_.reported; }

    /// Receives the parameter changes of scripts at the end of the drive phase.
    using ApplyChanges = void (*)(void* owner, std::vector<ParameterChange>& changes);
    void on_changes(ApplyChanges apply, void* owner) { apply_changes_ = apply, changes_owner_ = owner; }
    /// Receives the pictures of the scene's cameras; null: the cameras do not draw.
    void draw_for(ImageSink* images) { images_ = images; }

    // The nodes of the step tree ---------------------------------------------------------------------------------------
    void save_start();
    void drive();
    void couple_speeds();
    void advance_all();
    void locate_events();
    void finish_contacts();
    void finish();
    void draw();

    bool anything_moves() const { return !step_.groups.all.empty(); }
    bool anything_drives() const { return !step_.schedule.of(Phase::Drive).empty(); }
    bool anything_couples() const { return !step_.schedule.of(Phase::Couple).empty() || !step_.graph.trees().empty(); }
    bool anything_collides() const { return !book_.detectors().empty(); }
    bool anything_finishes() const { return !step_.schedule.of(Phase::Finish).empty(); }
    bool anything_draws() const { return images_ && !step_.schedule.of(Phase::Draw).empty(); }

private:
    // stepper_build.cpp
    Errors derive_structure(bool comparable, GroupsChange& change);
    void choose_solvers();
    void choose_answers(GroupsChange& change);
    void set_up_motion();
    std::vector<std::uint32_t> coupled_groups() const;
    void connect_materials(Errors& errors);
    void connect_graph(Errors& errors);
    Errors run_connect(const Block& block, world::CommandCall& call);
    void rebuild_costs();

    // stepper.cpp
    void collect_cost();
    void save_driven();
    void run_blocks(Phase phase, world::CommandCall& call);

    StepState step_;
    GroupMotion motion_{step_};
    ContactBook book_{step_};
    HardContacts hard_{step_, motion_, book_};
    ContactForces forces_{step_, motion_, book_, hard_};
    BodyTouches touches_{step_, book_};
    SleepingContacts sleeping_contacts_{step_, book_};
    Advance advance_;
    std::optional<EventLocator> locator_;  ///< made when it is needed first; reset when the structure changes
    ShaftSystem speed_system_;
    CouplingWatch coupling_watch_;
    RenderSceneBuilder render_scene_;
    CostBook cost_;
    double departed_work_ = 0, requests_work_ = 0;
    std::shared_ptr<const char> saved_mark_;  ///< RestState::mark when the start of a step was saved last

    const Selection* part_ = nullptr;
    Groups groups_before_;                        ///< those of the last rebuild but one, for their memory
    std::optional<world::Revisions> built_from_;  ///< of the world at the last rebuild; empty: everything has to be derived
    const Interruption* interruption_ = nullptr;
    Progress* progress_ = nullptr;
    ImageSink* images_ = nullptr;
    std::vector<ParameterChange> changes_;
    ApplyChanges apply_changes_ = nullptr;
    void* changes_owner_ = nullptr;
};

}  // namespace plab::simulation
