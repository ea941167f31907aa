/// Turns the state of a simulation into records, on the step thread, as far as observers want them.
#pragma once

#include <vector>

#include "publish/catalogue.h"
#include "publish/happenings.h"
#include "publish/observer.h"
#include "publish/pace.h"
#include "publish/sampler.h"
#include "simulation/simulation.h"

namespace plab::publish
{

struct CollectorOptions
{
    double states_per_second = 60;  ///< of real time; 0: each step
    double metrics_per_second = 4;  ///< of real time
};

class Collector
{
public:
    /// `types`: what can be had, loaded or not (plugins::PluginLibrary::summaries()).
    Collector(const CollectorOptions& options, std::vector<model::TypeSummary> types);

    /// Before the first collect(): what happened earlier is not known. The observer must outlive this.
    void attach(Observer& observer);

    /// After each step, and after requests that took effect between steps (then `stepped` is false: events are not
    /// collected again). `changes` says what requests did to the structure since the last call. Frames go out in turn,
    /// and always while the simulation is paused; metrics in turn, and soon after requests.
    void collect(const simulation::Simulation& simulation, const simulation::Changes& changes, bool stepped);
    /// Now and then while paused: what newcomers must see, and what found no room before. Nothing else has happened.
    void idle(const simulation::Simulation& simulation);
    /// What a request did, as an event ("request.swap", ...), for everybody who watches. Its time is the present one.
    void note(const simulation::Simulation& simulation, EventRecord event);
    /// Cheap enough to be called at each step: sends on change and once a second. What only counts on (step, time, rate
    /// reached, time slipped, numbers of events) is no change. States per second and those numbers are filled in here.
    void status(const Status& status);

    std::uint64_t last_event() const { return next_event_ - 1; }
    std::uint64_t last_collision() const { return next_collision_ - 1; }

private:
    struct Wish
    {
        bool wanted = false;
        std::uint64_t joins = 0;
    };
    /// An observer and what is known of its wishes.
    struct Watcher
    {
        Observer* observer = nullptr;
        bool needs_everything = true;
        Pace retry{1};
        Wish states, metrics;
    };
    enum class When
    {
        InTurn,
        Now,
        ForNewcomers,
    };
    static bool fresh(const Observer& observer, Stream stream, Wish& wish);

    void tell_catalogue(const simulation::Simulation& simulation, Nanoseconds now);
    void tell_states(const simulation::Simulation& simulation, Nanoseconds now, When when);
    void tell_events(const simulation::Simulation& simulation, const Counts& counts);
    void tell_metrics(const simulation::Simulation& simulation, Nanoseconds now, When when);

    CollectorOptions options_;
    Catalogue catalogue_;
    Sampler sampler_;
    std::vector<Watcher> watchers_;
    Pace states_, metrics_, scripted_;
    Nanoseconds sampled_ = 0;     ///< when metrics went out last
    bool metrics_asked_ = false;  ///< out of turn
    std::uint64_t frames_ = 0;
    std::uint64_t next_event_ = 1, next_collision_ = 1;
    Status told_;
    Nanoseconds told_at_ = 0;
};

}  // namespace plab::publish
