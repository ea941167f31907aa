/// Turns the state of a simulation into records, on the step thread, as far as observers want them.
#pragma once

#include <span>

#include "publish/observer.h"
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

    void attach(Observer& observer);

    /// After each step, and after requests that took effect between steps (then `stepped` is false: events are not
    /// collected again). `changes` says what requests did to the structure since the last call.
    void collect(simulation::Simulation& simulation, const simulation::Changes& changes, bool stepped);
    /// What a request did, as an event ("request.swap", ...), for everybody who watches.
    void note(const simulation::Simulation& simulation, EventRecord event);
    /// Cheap enough to be called at each step: sends on change and once a second.
    void status(Status status);

    std::uint64_t last_event() const { return next_event_ - 1; }
    std::uint64_t last_collision() const { return next_collision_ - 1; }

private:
    CollectorOptions options_;
    std::vector<model::TypeSummary> types_;
    std::vector<Observer*> observers_;
    std::uint64_t next_event_ = 1, next_collision_ = 1;
};

}  // namespace plab::publish
