/// A run: the world of one scene, the stepper that advances it, its clock, and what has been asked of it and has happened to it. A plain
/// value, so that a run can be set aside while another state of it is computed, and put back unchanged.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <set>
#include <vector>

#include "model/compile.h"
#include "simulation/levels/level_book.h"
#include "simulation/requests/requests.h"
#include "simulation/step/totals.h"
#include "simulation/watch/divergence_watch.h"
#include "simulation/watch/run_view.h"

namespace plab::simulation
{

/// Reads a request from the words in which a client, or a component of the scene, asks for it (server/docs/requests.md).
using RequestReader = std::function<Result<Request>(const std::string& verb, const std::string& target, const std::string& argument)>;

/// With what runs are computed. It outlives them.
struct RunContext
{
    model::TypeSource* types = nullptr;
    RequestReader read_request;                  ///< for components that ask for requests; none: they are refused
    int threads = 1;
    model::CompileLimits limits;                 ///< for the components that requests add
    const Interruption* interruption = nullptr;  ///< null: steps and trials cannot be interrupted
    Progress progress;                           ///< what the step thread is doing; any thread may read it
    double mean_step_ns = 0;                     ///< running mean over about the last hundred steps; 0: no step was made yet
    std::uint64_t steps_timed = 0;

    void note_cost(double ns);
};

struct RunClock
{
    Tick tick = 0;
    model::StepLength dt;
    Tick base_tick = 0;    ///< the tick at which the present dt became valid
    double base_time = 0;  ///< s
    bool paused = false;
    std::int64_t steps_left = 0;
    double rate = 0;

    /// s: t = n dt with a single rounding. After a change of dt, n counts from the tick and time at which dt changed.
    double time_at(Tick at) const { return base_tick == 0 ? dt.at(at) : base_time + dt.at(at - base_tick); }
    double time() const { return time_at(tick); }
};

struct WaitingRequest
{
    std::shared_ptr<const Request> request;  ///< shared with snapshots
    std::uint64_t run = 0;                   ///< the run in which it was posted
};

/// A world with the stepper and the levels that were built for it, which refer to it.
struct LiveScene
{
    LiveScene() = default;
    LiveScene(LiveScene&&) = default;
    /// The stepper that was here goes before its world.
    LiveScene& operator=(LiveScene&& other) noexcept
    {
        levels = std::move(other.levels), stepper = std::move(other.stepper), world = std::move(other.world);
        return *this;
    }
    /// Derives everything that follows from the structure of the world, after it has changed. On error the world must be put back and
    /// rebuilt.
    Result<void> rebuild();

    std::unique_ptr<world::World> world;
    std::unique_ptr<Stepper> stepper;
    std::unique_ptr<LevelBook> levels;
};

struct Run
{
    LiveScene live;
    std::unique_ptr<DivergenceWatch> watch = std::make_unique<DivergenceWatch>();
    std::shared_ptr<const model::SceneSpec> loaded;  ///< the scene to which a reset returns
    RunClock clock;
    double kinetic_at_start = 0;                 ///< J
    std::uint64_t number = 0;                    ///< increases with each load, each reset and each restored snapshot
    std::uint64_t revision = 0;                  ///< counts the structural requests (add, remove, swap, reset, load) that were carried out
    std::deque<WaitingRequest> waiting;          ///< requests whose step has not come
    Changes changes;                             ///< since they were taken last
    std::vector<Event> events;                   ///< of the last step and of the requests before it
    std::set<std::uint32_t> changed_by_scripts;  ///< components whose parameters scripts set in the step being computed

    world::World& world() const { return *live.world; }
    Stepper& stepper() const { return *live.stepper; }
    LevelBook& levels() const { return *live.levels; }
    RunView view() const { return {world(), stepper(), clock.tick, clock.time(), clock.dt.seconds}; }
    Totals totals() const { return totals_of(world(), stepper(), clock.time(), clock.tick); }
    /// Returns the run with its world, stepper and watch. This run keeps its clock, its counts and its requests, and waits for another
    /// world. Assigning the returned value puts everything back.
    Run set_aside();
    /// Drops the waiting requests of this run whose step has passed.
    void forget_late_requests();
};

/// A world made from a scene, ready to be stepped. An error names the element of the blueprint.
Result<LiveScene> build_scene(const RunContext& context, const model::SceneSpec& scene);

}  // namespace plab::simulation
