/// A simulation: one scene with its world, its stepper, its clock and its queue of requests.
#pragma once

#include "simulation/snapshot/history.h"
#include "simulation/step/step_memento.h"
#include "simulation/transaction/transaction.h"

namespace plab::simulation
{

class Simulation : private RunOperations
{
public:
    explicit Simulation(model::TypeSource& types, int threads = 1);
    ~Simulation() override;
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    /// Limits for the components that requests add.
    void limit(const model::CompileLimits& limits) { context_.limits = limits; }
    const model::CompileLimits& limits() const { return context_.limits; }

    /// Replaces the present scene by another one. On error the present scene stays.
    Result<void> load(const model::SceneSpec& scene) override;

    /// Returns the run at the present boundary between two steps as a value; an empty snapshot before the first load. The cost is one
    /// copy of the state plus its hash.
    Snapshot capture() const { return simulation::capture(run_); }
    /// Continues from a snapshot that this or another Simulation captured, exactly as if that run had never been interrupted. Types that
    /// are not loaded yet are loaded. A new run begins; the revision keeps counting. Requests that are waiting for a step are refused,
    /// but requests that were waiting when the snapshot was taken wait again. On error nothing has changed.
    Result<void> restore(const Snapshot& snapshot);
    /// Returns to the step nearest to a time of this run (s): restores the last checkpoint before it and makes the steps from there again,
    /// with the requests that took effect then. A new run begins. On error nothing has changed: the run, its number and the waiting
    /// requests are what they were.
    Result<void> rewind(double time) override;

    /// Queues a request. It takes effect at the boundary before the next step, or before the step that it names. A named step belongs to
    /// the present run: if another run begins before that step, the request is refused.
    void post(Request request);
    /// Carries out a request immediately, at the present boundary between two steps.
    Reply carry_out_now(const Request& request) { return carry_out(request); }
    /// Sets the flag that can interrupt a step or a trial while it is being computed. It must outlive this object. Null: steps cannot be
    /// interrupted.
    void set_interruption(const Interruption* interruption);
    /// Applies the requests that are due and then, unless paused, makes one step. Returns false if paused or if the step was interrupted.
    bool step();
    /// Makes one step whether paused or not, without applying waiting requests: for recomputing past steps. Returns false if the step was
    /// interrupted.
    bool step_once();
    /// The last step was interrupted and rolled back: the state is bit for bit what it was before the step.
    bool gave_up() const { return gave_up_; }
    /// What the step thread is doing at the moment; may be called from any thread.
    const Progress& progress() const { return context_.progress; }
    /// Withdraws a waiting request; no reply will be sent for it. Returns false if no request with this id is waiting.
    bool withdraw(std::uint64_t request);
    /// The number of requests that are waiting for their step.
    std::size_t pending_requests() const { return run_.waiting.size(); }
    /// Applies the requests that are due at the present boundary, paused or not. Returns true if there were any.
    bool apply_due();
    /// The replies since the last call, in order.
    std::vector<Reply> take_replies();
    /// The requests that the simulation made itself before the last step, with their replies: measurements for governors, and what
    /// components decided (Reply::made).
    const std::vector<Reply>& own_requests() const { return own_requests_; }
    /// What requests, scripts (when they set parameters) and failures changed about components since the last call.
    Changes take_changes();
    /// Reads the requests that components of the scene make in their own name (Phase::Decide).
    void read_requests_with(RequestReader reader) { context_.read_request = std::move(reader); }
    /// Whether governors and other components that decide are asked before each step; yes by default. A copy of a run that answers "what
    /// if" must leave them out.
    void let_decide(bool deciding) { deciding_ = deciding; }
    /// Whether step() measures what steps cost and sets that as an input of governors by cost; no by default, so that nothing of a run
    /// depends on the clock. A replay takes the measurements from the recording.
    void let_measure(bool measuring) { measuring_ = measuring; }
    const LevelBook& levels() const { return run_.levels(); }
    /// What trial steps from the present boundary tell a governor: how far a component with this level departs within `interval` (s) from
    /// where the next finer one would take it. They leave no trace. `enough`: see LevelQuestion.
    LevelError try_level(std::uint32_t component, const Level& level, const Level& finer, double interval, const LevelError& enough = {});
    /// From where the viewers of the scene look at the present boundary.
    std::vector<Viewpoint> viewpoints() { return run_.levels().viewpoints(tick(), time(), dt()); }
    /// Where the cameras of the scene send their pictures. Null: cameras do not draw.
    void draw_for(ImageSink* images) { images_ = images; }

    /// Whether the steps from the next one on are to note what contacts do in them (Stepper::contact_log); no by default.
    void log_contacts(bool on) { logs_contacts_ = on; }

    Tick tick() const { return run_.clock.tick; }
    double time() const { return run_.clock.time(); }
    double dt() const { return run_.clock.dt.seconds; }
    bool paused() const { return run_.clock.paused && run_.clock.steps_left == 0; }
    /// Whether it will be paused once one more step has been made.
    bool pauses_after_step() const { return run_.clock.paused && run_.clock.steps_left <= 1; }
    double rate() const { return run_.clock.rate; }
    /// Counts the runs: it increases with each load, each reset and each restored snapshot.
    std::uint64_t run() const { return run_.number; }
    /// Counts the structural requests (add, remove, swap, reset, load) that were carried out; never reset.
    std::uint64_t revision() const { return run_.revision; }

    /// The named snapshots, and the checkpoints from which the run can be rewound.
    History& history() { return history_; }
    const History& history() const { return history_; }

    const world::World& world() const { return run_.world(); }
    world::World& world() { return run_.world(); }
    const Stepper& stepper() const { return run_.stepper(); }
    std::uint64_t state_hash() const { return run_.stepper().state_hash(); }
    /// The events of the last step and of the requests before it.
    const std::vector<Event>& events() const { return run_.events; }
    Totals totals() const { return run_.totals(); }
    double kinetic_at_start() const { return run_.kinetic_at_start; }
    /// The largest value among the outputs that the component's type declares as its error; 0 if it declares none.
    double error_of(std::uint32_t component) const { return run_.world().largest_error(component); }

private:
    // RunOperations: what a request asks of the run as a whole.
    Result<void> keep(const std::string& name) override { return history_.keep(name, capture()); }
    Result<void> forget(const std::string& name) override { return history_.forget(name); }
    Result<void> restore(const std::string& name) override;

    void begin_run(LiveScene live, std::shared_ptr<const model::SceneSpec> scene);
    Result<void> go_forward(const std::vector<History::Asked>& requests, double time);
    Reply carry_out(const Request& request);
    Reply outlived(const Request& request) const;

    // deciding.cpp
    void measure_for_governors();
    void decide();
    void exchange_levels(std::span<const Decision> decisions);
    bool take_effect_as_one(std::span<const Decision> decisions);
    void note_levels_taken(const Decision& decision, Reply reply, std::vector<LevelChange> changes);
    void carry_out_levels(const Decision& decision);
    void carry_out_decisions(std::span<const Decision> decisions);
    void carry_out_decision(const Decision& decision);
    Result<Request> read_decision(const Decision& decision) const;
    bool take_effect_together(std::span<const Decision> additions);
    bool take_effect(const Decision& decision, const Request& request, const std::vector<std::string>& reasons);
    void announce_exchanges(const Reply& reply, const std::vector<std::string>& reasons, std::vector<LevelChange> changes);
    void announce_components(const Decision& decision, const std::vector<std::string>& ids, const std::vector<std::string>& reasons);
    void refuse_decision(std::uint32_t by, const std::string& what, const std::string& why);
    void read_changed_governors();
    /// Observers see the governor of a component with it.
    void note_levels();
    const Result<FirstStep>& step_with(std::uint32_t component, const Level& level, const FirstStepChoice& choice);
    int steps_of_trial(std::uint32_t component, double whole) const;
    TrialFindings error_of_level(const LevelQuestion& asked);

    bool run_step();
    void note_step_time(std::uint64_t begin, std::uint64_t thread_begin);
    void take_back_step();
    void freeze_lost_objects();
    void release_lost_objects();
    void quarantine_failed();
    static void apply_script_changes(void* self, std::vector<ParameterChange>& changes);

    RunContext context_;
    Run run_;
    History history_;
    std::vector<Reply> replies_, own_requests_;
    ImageSink* images_ = nullptr;
    bool logs_contacts_ = false;
    struct ScriptChange
    {
        std::uint32_t component;
        std::string name;
        Value before;
    };
    std::vector<ScriptChange> script_changes_;  ///< of the step being computed
    StepMemento step_start_;  ///< the state at the start of the step being computed; saved only if the step can be interrupted
    bool gave_up_ = false;
    bool deciding_ = true, measuring_ = false;
    /// At a boundary components decide once, even if the step after it is interrupted and made again.
    struct Decided
    {
        Tick tick = -1;
        std::vector<Event> events;  ///< to be told with those of the step
    };
    Decided decided_;
    /// The first step of a component with a level. A governor may ask for the same one twice within a look.
    struct Tried
    {
        std::uint32_t component;
        const Level* level;
        Result<FirstStep> step;
    };
    std::vector<Tried> tried_;
    std::string last_refusal_;
    StepTimes step_times_;  ///< for governors
};

}  // namespace plab::simulation
