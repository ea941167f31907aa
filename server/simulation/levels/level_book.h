/// The levels of detail of a scene: which governor watches which components, and what components decide before a step.
///
/// Components with a command of Phase::Decide are asked at each boundary, after the requests that are due and before the step. What they
/// ask for is carried out as transactions, like requests of clients. It follows from the state of the scene and from inputs that are
/// recorded as requests, so a replay decides the same again, and what was decided is not replayed. Measured times enter only as such inputs
/// (measurements()).
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "simulation/levels/ladder.h"
#include "simulation/levels/level_change.h"
#include "simulation/levels/step_times.h"
#include "simulation/step/stepper.h"

namespace plab::simulation
{

class ComponentCosts;

/// What a component asked for in Phase::Decide: one transaction.
struct Decision
{
    std::uint32_t by = kNoIndex;         ///< directory index
    std::string verb, target, argument;  ///< of a request in words; empty: the levels below
    std::vector<Operation> operations;   ///< the exchanges of a governor
    std::vector<std::string> reasons;    ///< one for each of them, or for the request
};

/// How far apart are two levels of a component? See LevelControl::error(). The levels stay where they are until it is answered. `enough`:
/// whoever asks need not know more than that the error exceeds this distance or angle (NaN: no limit), so the trial may end there, and what
/// it has shown until then is the answer.
struct LevelQuestion
{
    std::uint32_t component = kNoIndex;
    const Level *level = nullptr, *finer = nullptr;
    double interval = 0;  ///< s, within which the error is counted
    LevelError enough;
    bool with_cost = false;  ///< also what the steps cost, for which they have to be repeated
    bool energy = false;     ///< LevelError::power, for which energies are summed up after each step
};

/// What trial steps with a level and with the next finer one showed.
struct TrialFindings
{
    LevelError error;
    double seconds = 0, finer_seconds = 0;  ///< of these steps, for all objects that they moved; 0: not measured
};

/// What is known of a level of one component from a trial step, for observers.
struct LevelTrial
{
    std::int32_t level = 0;
    std::string text;     ///< of the level
    LevelError error;     ///< within `interval` (s), against the next finer level; NaN: not told
    double interval = 0;  ///< s
    double seconds = 0;   ///< of the step; 0: not measured
};
/// In the unit in which a governor counts, as far as trial steps tell it; pixels depend on the viewer, so metres stand for them.
std::pair<double, const char*> error_of_trial(const LevelTrial& trial, const std::string& unit);

/// What was decided before a step: how many trials of levels (each beside the next finer one) and exchanges, and what both cost.
struct DecisionCost
{
    std::size_t trials = 0, exchanged = 0;
    StepCost trying, exchanging;
    StepCost told;  ///< that part of both of which the governors are told, so that they can spread it over steps
    StepCost step;  ///< the step after that, with all that is not told
};

/// A watched component as an observer sees it.
struct LevelInfo
{
    std::uint32_t component = kNoIndex, governor = kNoIndex;
    std::int32_t level = -1, levels = 0;
    std::string text;                                             ///< of the level
    std::string reason;                                           ///< of the last change; empty: it has not been changed in this run
    double since = 0;                                             ///< s, of that change
    LevelChange last;                                             ///< what it was, with the figures of both levels
    double error = std::numeric_limits<double>::quiet_NaN();      ///< as its governor measured it last; NaN: it measures none
    double next_look = std::numeric_limits<double>::quiet_NaN();  ///< s: when its governor measures it again; NaN: at its next look
    double every = 0;                                             ///< s, from one look of its governor to the next
    std::string error_unit;
    std::vector<LevelTrial> trials;  ///< what the last trial steps showed of its levels, from the cheapest on
};

class LevelBook
{
public:
    using MeasureError = std::function<TrialFindings(const LevelQuestion&)>;

    LevelBook(world::World& world, Stepper& stepper);
    ~LevelBook();
    LevelBook(const LevelBook&) = delete;
    LevelBook& operator=(const LevelBook&) = delete;

    /// To be called after any structural change and after changes of parameters, after Stepper::rebuild(). Errors: a ladder that cannot be
    /// read; a component that two governors watch.
    Result<void> rebuild();
    bool anything_decides() const { return !stepper_.schedule().of(Phase::Decide).empty(); }

    /// Asks all components that decide. `time`: s, of the coming step's start.
    std::vector<Decision> decide(Tick tick, double time, double dt, const MeasureError& error, EventSink& events);
    /// From where the viewers of the scene look at this boundary.
    std::vector<Viewpoint> viewpoints(Tick tick, double time, double dt);
    /// What is known of the levels that these exchanges take away, one for each operation; to be handed to after_exchange().
    std::vector<LevelChange> before_exchange(const std::vector<Operation>& operations);
    /// What was carried out, for observers. Returns it with what is known of both levels.
    const LevelChange& after_exchange(std::uint32_t component, std::string reason, double time, LevelChange change);

    /// Of the last boundary.
    const DecisionCost& decision_cost() const { return decided_; }
    /// What a transaction cost that exchanged n components. Each governor that spends time is told, whoever asked for it.
    void note_exchange(std::size_t n, const StepCost& cost);
    /// What the step after the last boundary cost, without what governors are told. Returns whether it was a usual one: after an exchange
    /// or a trial the processor finds other data in its caches.
    bool note_step(const StepCost& cost);
    /// Inputs for governors that have these fields: `step_cost` (s), what a step costs usually, as often as their field `every` (s) states,
    /// once as soon as it is known, soon after something was exchanged, and when steps take much longer than it was told; with it `spread`,
    /// and `trial_costs` (s for each object, by level); `exchange_cost` after each exchange, and `trial_time` after trials: how many, and
    /// what they cost. By the wall clock if their field `clock` says "wall"; steps of trials always. `steps`: how it was, which is used up
    /// then.
    std::vector<Request> measurements(double time, double dt, StepTimes& steps);

    /// All watched components, by governor and then by id.
    std::vector<LevelInfo> levels() const;
    /// Of one component; empty: no governor watches it.
    std::optional<LevelInfo> level(std::uint32_t component) const;
    /// Components that have come under a governor, or have left it, or of which it told something, since the last call.
    std::vector<std::uint32_t> take_changed() { return std::exchange(changed_, {}); }
    bool watches_anything() const { return !governors_.empty(); }
    bool is_governor(std::uint32_t component) const;
    /// On what a watched component acts, without static objects; empty: no governor watches it.
    std::span<const Ref> objects_of(std::uint32_t component) const;

private:
    struct Watched
    {
        std::uint32_t component = kNoIndex;
        std::vector<Ref> objects;  ///< on which it acts, without static ones
    };
    struct Governor
    {
        std::uint32_t component = kNoIndex;
        std::string watches, written;  ///< the texts from which the rest was derived
        Ladder ladder;
        std::vector<Watched> watched;  ///< in id order
        bool counts_energy = false;    ///< its bound is in W
        // Measured since the last input of that kind.
        std::vector<std::vector<double>> trial_seconds;  ///< for each object, by level
        std::size_t trials = 0;                          ///< whose cost was measured: after some of them, steps tell it better
        std::size_t exchanged = 0;                       ///< components, by all governors
        StepCost exchange_cost;
        std::size_t tried = 0;  ///< levels, each beside the next finer one
        StepCost trial_time;
        bool waits = true;  ///< for what a step costs with the levels that it has chosen
    };
    struct Change
    {
        std::string id, reason;
        double since = 0;
        LevelChange what;
    };
    /// Of one component: what is remembered for the figures of the next change.
    struct Known
    {
        struct Had
        {
            double cost = std::numeric_limits<double>::quiet_NaN(), error = std::numeric_limits<double>::quiet_NaN();
        };
        std::vector<Had> had;                                           ///< by level: its accounts when it had the level last
        double told_before = std::numeric_limits<double>::quiet_NaN();  ///< by the governor, of the level before the present look
    };
    /// What a governor told of a component that it watches.
    struct Told
    {
        std::uint32_t by = kNoIndex;
        double error = 0, next_look = 0;
        std::string unit;
    };
    class Desk;

    bool is_told(std::uint32_t governor, const char* input) const;
    LevelError enough_for(const Governor& governor) const;
    bool is_due(const Governor& governor, double time, double dt, const StepTimes& steps) const;
    void note_tried(Governor& governor, const StepCost& cost);
    FigurePair own_error(std::uint32_t component) const;
    std::vector<double> costs_of_levels(const Governor& governor, const ComponentCosts& costs) const;
    const Governor* governor_of(std::uint32_t component) const;
    std::string text_of_level(const Governor& governor, std::uint32_t component, std::int32_t level) const;
    static void note_trial(Governor& governor, std::size_t index, std::int32_t level, double interval, const TrialFindings& found,
                           std::vector<LevelTrial>& known);
    const Watched* find_watched(const Governor& governor, std::uint32_t component) const;

    world::CommandCall call_at(Tick tick, double time, double dt, Desk& desk) const;
    Result<void> find_watched();
    Result<void> read_governor(Governor& governor) const;
    Result<void> watch(Governor& governor, std::vector<std::uint32_t>& watcher) const;
    void find_parts();
    void add_objects(std::uint32_t component, std::vector<Ref>& out, int depth) const;
    GovernedComponent look(const Governor& governor, const Watched& watched) const;
    LevelInfo info(const Governor& governor, const Watched& watched) const;

    world::World& world_;
    Stepper& stepper_;
    std::vector<Governor> governors_;              ///< in id order
    std::vector<Change> changes_;                  ///< by directory index
    std::vector<Told> told_;                       ///< by directory index
    std::vector<Known> known_;                     ///< by directory index
    /// By governor (component) and level: s, at the last before_exchange(); NaN: unknown. One exchange may be of several governors.
    std::map<std::uint32_t, std::vector<double>> costs_of_levels_;
    std::vector<std::vector<LevelTrial>> trials_;  ///< by directory index
    /// By directory index: what the world returns is not valid any more after a trial, which may copy the directory that a snapshot shares.
    std::vector<std::string> ids_;
    std::vector<std::uint32_t> watcher_, changed_;  ///< governor of each component, by directory index; components
    DecisionCost decided_;
    bool deciding_ = false;                       ///< trials exchange components and put them back meanwhile
    std::uint64_t structure_ = 0;                 ///< counts the calls of rebuild()
    std::optional<world::Revisions> built_from_;  ///< of the world at the last rebuild; empty: it failed
    std::vector<double> radius_of_shaft_;
    // Of a Desk, kept from step to step, so that a look at a scene in which nothing changes needs no memory.
    std::vector<Viewpoint> viewpoints_;
    std::vector<GovernedComponent> looked_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> owner_of_part_;  ///< a component, and one that names it in a role; sorted
};

}  // namespace plab::simulation
