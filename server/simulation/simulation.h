/// A scene that runs: world, step, requests, time.
#pragma once

#include <deque>
#include <memory>
#include <set>

#include "model/compile.h"
#include "simulation/requests/requests.h"
#include "simulation/snapshot/snapshot.h"
#include "simulation/step/step_memento.h"
#include "simulation/step/totals.h"
#include "simulation/watch/run_view.h"

namespace plab::simulation
{

class History;

class Simulation
{
public:
    explicit Simulation(model::TypeSource& types, int threads = 1);
    ~Simulation();
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    /// For what requests add.
    void limit(const model::CompileLimits& limits) { limits_ = limits; }
    const model::CompileLimits& limits() const { return limits_; }

    /// Replaces whatever is there. On error what was there goes on.
    Result<void> load(const model::SceneSpec& scene);

    /// The run at the present boundary, as a value; none before the first load. Costs a copy of its state, and the state's hash.
    Snapshot capture() const;
    /// Goes on from a snapshot, of this or another Simulation, as if it had never been left; types that are not loaded are.
    /// A new run begins, and the revision goes on counting. Requests that wait for a step are refused, but those that waited at
    /// the snapshot wait again.
    /// On error nothing has changed.
    Result<void> restore(const Snapshot& snapshot);

    /// Queues a request for the boundary before the next step, or the step that it names; that is a step of the present
    /// run: if another run begins before, the request is refused.
    void post(Request request);
    /// Carries a request out at the present boundary, between two steps.
    Reply carry_out_now(const Request& request) { return carry_out(request); }
    /// Who may have steps and trials given up while they are in work; must outlive this. Null: nobody can.
    void obey(const Interruption* interruption);
    /// Requests that are due take effect; then, unless paused, one step. False if paused, or if the step was given up.
    bool step();
    /// One step, paused or not; nothing that waits takes effect. For steps of the past that are made again. False: given up.
    bool step_once();
    /// The last step was given up: all is as it was before it, bit for bit.
    bool gave_up() const { return gave_up_; }
    /// What the step thread is at; for any thread.
    const Progress& progress() const { return progress_; }
    /// A request that waits is taken back: nobody answers it. False: there is none of this id.
    bool withdraw(std::uint64_t request);
    /// Requests that wait for their step.
    std::size_t pending_requests() const { return requests_.size(); }
    /// Requests that are due take effect now, at the boundary between two steps, paused or not. True if there were any.
    bool apply_due();
    /// Answers since the last call, in order.
    std::vector<Reply> take_replies();
    /// What requests, scripts that ask for other parameters, and failures did to components since the last call.
    Changes take_changes();
    /// Where cameras in the scene send their pictures; null: nowhere, and they do not draw.
    void draw_for(ImageSink* images) { images_ = images; }

    Tick tick() const { return tick_; }
    double time() const { return time_at(tick_); }
    double dt() const { return dt_.seconds; }
    bool paused() const { return paused_ && steps_left_ == 0; }
    double rate() const { return rate_; }
    /// Counts loads, resets and restored snapshots.
    std::uint64_t run() const { return run_; }
    /// Counts structural requests (add, remove, swap, reset, load) that were carried out; never starts again.
    std::uint64_t revision() const { return revision_; }

    /// Snapshots by name, and how far the run can be rewound.
    History& history() { return *history_; }
    const History& history() const { return *history_; }

    const world::World& world() const { return *world_; }
    world::World& world() { return *world_; }
    const Stepper& stepper() const { return *stepper_; }
    std::uint64_t state_hash() const { return stepper_->state_hash(); }
    /// Events of the last step and of the requests before it.
    const std::vector<Event>& events() const { return events_; }
    Totals totals() const;
    double kinetic_at_start() const { return kinetic_at_start_; }
    /// The largest output of a component that is declared as its error; 0 if it has none.
    double error_of(std::uint32_t component) const;

private:
    friend class Transaction;
    friend class History;

    struct Live
    {
        std::unique_ptr<world::World> world;
        std::unique_ptr<Stepper> stepper;
    };
    RunView view() const { return {*world_, *stepper_, tick_, time(), dt()}; }
    Result<Live> build(const model::SceneSpec& scene);
    Result<Live> revive(const SnapshotContent& from) const;
    void begin_run(Live live, std::shared_ptr<const model::SceneSpec> scene);
    void continue_from(const SnapshotContent& from);
    Reply carry_out(const Request& request);
    Reply outlived(const Request& request) const;
    bool run_step();
    void note_cost(double ns);
    void take_back_step();
    void forget_late_requests();
    void freeze_lost_objects();
    void release_lost_objects();
    void quarantine_failed();
    double time_at(Tick tick) const;
    static void apply_script_changes(void* self, std::vector<ParameterChange>& changes);

    model::TypeSource* types_;
    int threads_;
    model::CompileLimits limits_;
    std::unique_ptr<world::World> world_;
    std::unique_ptr<Stepper> stepper_;
    std::shared_ptr<const model::SceneSpec> loaded_;

    Tick tick_ = 0;
    model::StepLength dt_;
    Tick base_tick_ = 0;    ///< where the present dt began
    double base_time_ = 0;  ///< s
    bool paused_ = false;
    std::int64_t steps_left_ = 0;
    double rate_ = 0;
    double kinetic_at_start_ = 0;  ///< J
    std::uint64_t run_ = 0, revision_ = 0;

    struct Waiting
    {
        std::shared_ptr<const Request> request;  ///< snapshots share it
        std::uint64_t run = 0;                   ///< in which it was posted
    };
    std::deque<Waiting> requests_;
    std::vector<Reply> replies_;
    Changes changes_;
    ImageSink* images_ = nullptr;
    std::vector<Event> events_;
    std::set<std::uint32_t> changed_by_scripts_;
    struct ScriptChange
    {
        std::uint32_t component;
        std::string name;
        Value before;
    };
    std::vector<ScriptChange> script_changes_;  ///< of the step in work
    const Interruption* interruption_ = nullptr;
    Progress progress_;
    StepMemento step_start_;  ///< of the step in work, where it can be given up
    bool gave_up_ = false;
    double mean_step_ns_ = 0;  ///< of late; 0: no step was made yet
    std::uint64_t steps_timed_ = 0;
    std::unique_ptr<DivergenceWatch> watch_;
    std::unique_ptr<History> history_;
};

}  // namespace plab::simulation
