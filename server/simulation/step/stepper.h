/// One step of a world: the phases of step_tree.h, with rewinding to events inside the step.
#pragma once

#include <array>
#include <memory>

#include "simulation/contact_forces/contact_forces.h"
#include "simulation/contacts/contacts.h"
#include "simulation/contacts/kicked_bodies.h"
#include "simulation/contacts/midway_contacts.h"
#include "simulation/costs/cost_book.h"
#include "simulation/groups/system_pool.h"
#include "simulation/shafts/coupling_watch.h"
#include "simulation/shafts/shaft_reactions.h"
#include "simulation/sight.h"
#include "simulation/step/worker_pool.h"

namespace plab::simulation
{

/// What a step did, beside moving the world.
struct StepReport
{
    int events = 0;   ///< impacts located and answered
    int trials = 0;   ///< trial advances made to locate them
    int rewinds = 0;  ///< groups rewound
    int resting_pairs = 0;
    std::uint64_t swept_rows = 0;   ///< rows of contacts and joints times sweeps (or pivots) over them, trials included
    double further_pairs = 0;       ///< of shapes, beyond one for each pair of bodies, that looks for contacts went through
    std::uint64_t evaluations = 0;  ///< of forces, summed over the systems that solvers advanced, trials included
    double worst_residual = 0;      ///< m/s, left over by contact responses
    double deepest = 0;             ///< m, overlap left at the end of the step
    std::vector<Ref> frozen;        ///< objects whose state was not finite any more
};

/// Energy that contacts put in on their own account, by component (manager or response), J, since the run began.
struct ContactEnergy
{
    double made = 0;    ///< work of contacts that have none to do: no part of the ledger's work, so it stays unexplained there
    double lifted = 0;  ///< against the forces of the step, where overlap was parted
};

/// What events told of already and would tell again only when it ends and comes back.
struct Told
{
    bool stiff = false;                       ///< contact.stiff
    std::vector<std::uint8_t> contradictory;  ///< constraint.contradiction and coupling.*, by component
};

/// Events of one thread, until all threads are done.
class EventBuffer final : public EventSink
{
public:
    void emit(Event event) override { events.push_back(std::move(event)); }
    std::vector<Event> events;
};

/// What one thread advances: whole clusters of groups.
struct Batch
{
    struct Part
    {
        std::uint32_t solver = kNoIndex;
        std::vector<std::uint32_t> groups;
        std::unique_ptr<GroupSystem> system;
        bool fine = true;
    };
    /// Clusters of one solver share a part where that changes no bit (`together`).
    void add(std::span<const std::uint32_t> cluster, std::uint32_t solver, bool together);

    std::vector<Part> parts;
    std::size_t load = 0;
    bool split = false;  ///< a part was refused in this step
    std::vector<double> work;
    std::unique_ptr<StageScratch> scratch;
    CostMeter meter;  ///< where threads step in parallel
    EventBuffer events;
};

class EventLocator;

class HeldIslands;

class Stepper final : public EventSink
{
public:
    Stepper(world::World& world, int threads);

    /// From the next rebuild on only these components take part (by directory index); null: all. Must outlive this.
    void restrict_to(const std::vector<std::uint8_t>* components) { takes_part_ = components; }
    /// To be called after any structural change and after changes of parameters: schedule, groups, constraint graph,
    /// materials. On error (a contradictory graph) the world must be put back and rebuilt.
    Result<void> rebuild();
    /// Who may give a step up, and whom it tells how far it is; null: nobody. They must outlive this.
    void obey(const Interruption* interruption, Progress* progress) { interruption_ = interruption, progress_ = progress; }
    /// Steps from tick to tick + 1. Times in s.
    void step(Tick tick, double start_time, double dt);

    /// The last step was given up: the world is anywhere within it, and has to be put back.
    bool gave_up() const { return interruption_ && interruption_->heeded(); }

    const std::vector<Event>& events() const { return events_; }
    const StepReport& report() const { return report_; }
    const Schedule& schedule() const { return schedule_; }
    const Groups& groups() const { return groups_; }
    const ConstraintGraph& graph() const { return graph_; }
    const std::vector<Detector>& detectors() const { return detectors_; }
    /// m, about the centre of mass, by body: whatever collides is within; infinite for planes.
    std::span<const double> radius_of_body() const { return radius_of_body_; }
    /// m: of two bodies that may touch; 0 where neither ends.
    double smaller_radius(Ref a, Ref b) const
    {
        const double radius = std::min(radius_of_body_[a.index], radius_of_body_[b.index]);
        return radius < std::numeric_limits<double>::infinity() ? radius : 0.0;
    }
    /// m: overlap that is left alone.
    double overlap_tolerance(Ref a, Ref b) const { return kOverlapShare * smaller_radius(a, b); }
    ContactCache& contacts() { return cache_; }
    const ContactForces& forces() const { return forces_; }
    const ContactCache& contacts() const { return cache_; }
    const std::vector<FoundContact>& touching() const { return found_; }
    std::vector<ContactEnergy>& contact_energy() { return contact_energy_; }
    const std::vector<ContactEnergy>& contact_energy() const { return contact_energy_; }
    std::vector<double>& work() { return work_; }  ///< J by component, since the run began
    const std::vector<double>& work() const { return work_; }
    /// A component is about to be removed: its work stays in the ledger, whoever gets its place starts with none.
    void retire(std::uint32_t component)
    {
        if (component >= work_.size()) return;
        departed_work_ += work_[component];
        work_[component] = 0;
        cost_.forget(component);
        contact_energy_[component] = {};
        told_.contradictory[component] = 0;
    }
    /// J, by components that were removed since.
    double& departed_work() { return departed_work_; }
    double departed_work() const { return departed_work_; }
    /// J, by requests: what a set, push or swap changed at once.
    double& requests_work() { return requests_work_; }
    double requests_work() const { return requests_work_; }
    CostBook& cost() { return cost_; }
    const CostBook& cost() const { return cost_; }
    const CostMeter& meter() const { return meter_; }
    std::uint64_t state_hash() const;
    /// Who shares systems with whom shows in the last digits of the ledger, so a snapshot keeps it.
    const std::vector<std::uint32_t>& split() const { return split_; }
    void continue_split(const std::vector<std::uint32_t>& split)
    {
        split_ = split, split_.resize(groups_.clusters, 0), batches_ready_ = false;
    }
    Told& told() { return told_; }
    const Told& told() const { return told_; }
    /// The last step's time and length: what a swap at the boundary after it takes forces from.
    const StepFrame& frame() const { return frame_; }
    void continue_after(Tick tick, double start_time, double step)
    {
        frame_.tick = tick, frame_.start_time = start_time, frame_.step = step;
    }
    /// Where parameter changes of scripts go at the end of the drive phase.
    using ApplyChanges = void (*)(void* owner, std::vector<ParameterChange>& changes);
    void on_changes(ApplyChanges apply, void* owner) { apply_changes_ = apply, changes_owner_ = owner; }

    /// Where cameras in the scene send their pictures; null: nowhere, and they do not draw.
    void draw_for(ImageSink* images) { images_ = images; }

    void emit(Event event) override;

    // The nodes of the step tree ---------------------------------------------------------------------------------------
    void save_start();
    void drive();
    void couple_speeds();
    void advance_all();
    void locate_events();
    void finish_contacts();
    void finish();
    void draw();

    bool anything_moves() const { return !groups_.all.empty(); }
    bool anything_drives() const { return !schedule_.of(Phase::Drive).empty(); }
    bool anything_couples() const { return !schedule_.of(Phase::Couple).empty() || !graph_.trees().empty(); }
    bool anything_collides() const { return !detectors_.empty(); }
    bool anything_finishes() const { return !schedule_.of(Phase::Finish).empty(); }
    bool anything_draws() const { return images_ && !schedule_.of(Phase::Draw).empty(); }

private:
    friend class EventLocator;
    friend class ContactForces;
    friend class HeldIslands;
    friend class MidwayContacts;

    // stepper_build.cpp
    void connect_materials(Errors& errors);
    void connect_graph(Errors& errors);
    Errors run_connect(const Block& block, PhaseCall call);
    void measure_bodies();
    void plan_batches();
    Batch& lightest_batch(std::size_t total_load);
    void run_batch(Batch& batch, std::vector<double>& work);
    void run_batch_measured(Batch& batch);
    void emit_in_order();
    void collect_cost();
    void rebuild_costs();
    void run_block(const Block& block, StepContext& context, PhaseCall& call);

    // advance.cpp. A trial emits no events and freezes nobody.
    void advance_batches();
    void advance(std::span<const std::uint32_t> groups, double from, double to, WorkBook book, bool trial);
    void advance_smooth(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> shadows, double from, double to,
                        WorkBook book, bool trial);
    void advance_contacts(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> shadows, double from, double to,
                          WorkBook book, bool trial);
    bool run_solver(GroupSystem& system, std::uint32_t solver, double from, double to, WorkBook book, EventSink* events);
    bool run_solver(Batch::Part& part, std::vector<double>& work, EventSink& events);
    /// False if the command refused.
    bool call_solver(GroupSystem& system, std::uint32_t solver, const CommandInfo& command);
    bool goes_alone(const Group& group) const;
    void collect_units(std::span<const std::uint32_t> groups);
    EventSink* sink_for(bool trial) { return trial ? nullptr : this; }
    void split_by_contact(std::span<const std::uint32_t> groups);
    void collect_shadows(std::span<const std::uint32_t> groups);
    void finish_advance(GroupSystem& system, bool finite, double to, bool trial);
    void rewind(std::uint32_t group);
    void save_segment(std::uint32_t group);
    void save_end(std::uint32_t group);
    void restore_end(std::uint32_t group);
    void freeze(GroupSystem& system);
    GroupSystem& system_for(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> shadows);

    // contact_step.cpp
    void detect(const Detector& detector, std::uint32_t index, std::span<const StandingPair> standing, bool only_standing,
                std::vector<FoundContact>& out, double margin = 0);
    double number_of(std::uint32_t component, const char* parameter) const;
    void detect_with_gaps(std::uint32_t index, std::vector<FoundContact>& out);
    void detect_all(std::vector<FoundContact>& out);
    void touching_pairs_of(std::span<const std::uint32_t> groups, std::vector<FoundContact>& out, double h = 0);
    KnownContact& known_contact(const FoundContact& found);
    double gap_margin(const PairState& pair, double h) const;
    void drop_far(std::vector<FoundContact>& out, double h) const;
    bool meets_any(const GroupSystem& system, double h) const;
    void arrest(double h, WorkBook book);
    bool lead_touching(GroupSystem& system, double h);
    bool is_paradox(const Contact& contact) const;
    void tell_paradox(const Contact& contact, PairState& pair, double time);
    void fill_material(FoundContact& found) const;
    SurfaceLaw response_law(std::uint32_t detector) const;
    double standing_margin(Ref a, Ref b) const;
    void respond(std::vector<FoundContact>& contacts, ImpactMode mode, double dt, WorkBook book);
    void advance_island(std::span<const std::uint32_t> island, std::span<const std::uint32_t> shadows, double from, double to,
                        WorkBook book, bool trial);
    void bend_touching(double h);
    void book_rest(double work, WorkBook book);
    void book_impact(std::uint32_t response, const std::vector<FoundContact>& contacts, ImpactMode mode, double work, WorkBook book);
    bool note_release(PairState& pair, const Contact& contact, double presses, double parting, double from, double h);
    bool tell_release(PairState& pair);
    void keep_impulses(const std::vector<FoundContact>& contacts, double from, double h);
    static bool same_pair(const FoundContact& x, const FoundContact& y)
    {
        return x.detector == y.detector && x.contact.a == y.contact.a && x.contact.b == y.contact.b;
    }
    void correct_positions();
    void note_forces(const GroupSystem& system);
    Vec3 force_on(Ref body);

    // contact_force_swap.cpp
    struct Eased
    {
        KnownContact* known = nullptr;
        FoundContact* found = nullptr;
    };
    void ease_overlaps();
    void ease_pair(PairState& pair);
    double share_of_overlap_left(const PairState& pair, std::span<const Eased> eased) const;

    void part(std::size_t begin, std::size_t end);
    bool is_of_pair(const FoundContact& f, const PairState& pair) const;
    std::size_t first_of_pair(const PairState& pair, std::size_t from) const;
    void update_pair(PairState& pair, std::size_t begin, std::size_t end);
    double normal_velocity(const Contact& c) const;
    double standing_margin(const PairState& pair) const;
    double kinetic_energy(const std::vector<FoundContact>& contacts) const;
    Event contact_event(const char* kind, const PairState& pair, double time) const;

    world::World& world_;
    Schedule schedule_;
    Groups groups_;
    ConstraintGraph graph_;
    ShaftTorques reactions_;
    RowReportTable row_reports_;
    std::vector<Detector> detectors_;
    ContactCache cache_;
    ContactForces forces_{*this};
    std::shared_ptr<HeldIslands> held_;   ///< likewise
    ExtraForces* extra_ = nullptr;        ///< of all systems that are set up now
    std::vector<double> radius_of_body_;  ///< m, about C; infinite for planes
    WorkerPool workers_;

    std::shared_ptr<EventLocator> locator_;  ///< shared only so that its type need not be known here

    const std::vector<std::uint8_t>* takes_part_ = nullptr;
    const Interruption* interruption_ = nullptr;
    Progress* progress_ = nullptr;
    StepFrame frame_;
    world::MotionMemento start_, segment_, end_;
    std::vector<double> segment_begin_;  ///< s, by group: where its present smooth piece began
    bool rewinds_possible_ = false;

    std::vector<Batch> batches_;
    bool batches_ready_ = false;
    std::vector<std::uint32_t> split_;  ///< by cluster: 0, or which part it went to when its solver refused to advance it with others
    SystemPool pool_;

    // Working lists, kept warm.
    struct Unit
    {
        std::uint32_t solver_rank = 0, cluster = kNoIndex, group = 0;  ///< kNoIndex: whatever cluster
        friend auto operator<=>(const Unit&, const Unit&) = default;
    };
    std::vector<Unit> units_;
    std::vector<std::uint32_t> smooth_, in_contact_, shadows_, island_, island_all_, same_unit_;
    ShaftSystem speed_system_;
    CouplingWatch coupling_watch_;
    std::vector<std::uint8_t> group_flags_;
    std::vector<std::uint32_t> contact_groups_;
    std::vector<std::uint8_t> done_;
    mutable std::vector<std::uint32_t> counted_;
    DisjointSets islands_;
    std::vector<StandingPair> standing_;
    std::vector<FoundContact> found_, touching_;
    std::vector<Eased> eased_;
    std::vector<Contact> impact_contacts_;
    std::vector<std::uint32_t> members_, places_;
    MidwayContacts midway_{*this};
    KickedBodies moved_;
    /// What acts on a body besides contacts, N, as known in a step.
    struct KnownForce
    {
        Vec3 force;
        std::uint64_t serial = 0;  ///< of the step
    };
    std::uint64_t serial_ = 0;             ///< counts calls of step(), of whatever tick
    std::vector<KnownForce> known_force_;  ///< by body, where Response/Impulse advances it or parts it from others

    std::vector<Event> events_, releases_;  ///< releases: noted, and told when the step is over
    std::vector<ParameterChange> changes_;
    ApplyChanges apply_changes_ = nullptr;
    void* changes_owner_ = nullptr;
    std::vector<double> work_;
    std::vector<ContactEnergy> contact_energy_;
    double departed_work_ = 0, requests_work_ = 0;
    Told told_;
    CostMeter meter_;
    CostBook cost_;
    std::int64_t waiting_ns_ = 0;  ///< for other threads: nobody's cost
    StepReport report_;
    ImageSink* images_ = nullptr;
    SightBuilder sight_;
};

}  // namespace plab::simulation
