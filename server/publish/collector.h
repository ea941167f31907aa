/// Converts the state of a simulation to records, on the step thread, as far as observers want them.
#pragma once

#include <optional>
#include <vector>

#include "publish/catalogue_tracker.h"
#include "publish/contacts.h"
#include "publish/observer.h"
#include "publish/pace.h"
#include "publish/sampler.h"
#include "publish/scene_events.h"
#include "simulation/simulation.h"

namespace plab::publish
{

struct CollectorOptions
{
    double states_per_second = 60;         ///< of real time; 0: each step
    double metrics_per_second = 4;         ///< of real time
    double error_share = 0.01;             ///< largest share of real time for shadow steps, while an observer reads metrics
    double seconds_between_snapshots = 5;  ///< of real time, for observers without an interval of their own
};

class Collector
{
public:
    /// `types`: the available types, loaded or not (plugins::PluginLibrary::summaries()).
    Collector(const CollectorOptions& options, const std::vector<model::TypeSummary>& types);

    /// Call before the first collect(): earlier changes are not known. The observer must outlive this object.
    void attach(Observer& observer);

    /// Call before each step: lets it note what observers will want to know of it, and nothing else.
    void prepare(simulation::Simulation& simulation);
    /// Call after each step, and after requests that took effect between steps (then `stepped` is false: events are not
    /// collected again). `changes` describes what requests did to the structure since the last call. Frames are sent on
    /// schedule, and always while the simulation is paused; metrics on schedule, and soon after requests.
    void collect(const simulation::Simulation& simulation, const simulation::Changes& changes, bool stepped);
    /// Call from time to time while paused: sends what new observers must see, and what found no room before. Nothing else has
    /// happened.
    void idle(const simulation::Simulation& simulation);
    /// Publishes the effect of a request as an event ("request.swap", ...) with the current time, for all observers.
    void note(const simulation::Simulation& simulation, wire::EventInfo event);
    /// A request took effect; its sequence number among all requests is filled in here.
    void journal(wire::Journal entry);
    /// Whether somebody reads a stream that the caller fills.
    bool anybody_reads(Stream stream) const;
    /// After a step; its sequence number is filled in here.
    void forces(wire::Forces forces);
    /// Why a snapshot of the current state is wanted, if it is: "begin" of a run or of an observer's interest, or "periodic".
    /// The caller must then hand one over.
    std::optional<const char*> wants_snapshot(const simulation::Simulation& simulation);
    bool anybody_reads_snapshots() const { return anybody_reads(Stream::Snapshots); }
    void snapshot(const wire::Snapshot& snapshot);
    /// Cheap enough to call at each step: it sends on change, and once per second. Values that only progress (step, time, rate
    /// reached, time slipped, numbers of events) do not count as changes. States per second and those numbers are filled in
    /// here.
    void status(const wire::Server& status);

    std::uint64_t last_event() const { return next_event_ - 1; }
    std::uint64_t last_collision() const { return next_collision_ - 1; }

private:
    struct Wish
    {
        bool wanted = false;
        std::uint64_t joins = 0;
    };
    /// An observer and its current requests.
    struct Watcher
    {
        Observer* observer = nullptr;
        bool needs_everything = true;
        Pace retry{1};
        Wish states, contacts, metrics, snapshots;
        bool contacts_due = false;  ///< of the next step
        double next_frame = 0, next_contacts = 0, next_metrics = 0,
               next_snapshot = 0;  ///< s, simulated: of those with intervals of their own
        std::uint64_t snapshot_run = 0;
        std::uint64_t frames = 0, contact_samples = 0;  ///< number of those handed over
    };
    enum class When
    {
        InTurn,
        Now,
        ForNewcomers,
    };
    static bool fresh(const Observer& observer, Stream stream, Wish& wish);
    static bool in_turn(const Observer& observer, Stream stream, double time, double& next, bool servers_turn);

    void report_moment(const simulation::Simulation& simulation);
    void report_catalogue(const simulation::Simulation& simulation, Nanoseconds now);
    void report_states(const simulation::Simulation& simulation, Nanoseconds now, When when);
    void report_contacts(const simulation::Simulation& simulation);
    void report_events(const simulation::Simulation& simulation, const Counts& counts);
    void report_metrics(const simulation::Simulation& simulation, Nanoseconds now, When when);
    void report_hash(const simulation::Simulation& simulation);
    void begin_run(const simulation::Simulation& simulation);

    CollectorOptions options_;
    CatalogueTracker catalogue_;
    Sampler sampler_;
    std::vector<Watcher> watchers_;
    ContactRecords contacts_of_step_;
    Pace states_, contacts_, metrics_, scripted_, snapshots_;
    std::uint64_t run_ = 0;
    Nanoseconds sampled_ = 0;     ///< time of the last sample of metrics
    bool metrics_asked_ = false;  ///< a sample out of turn was requested
    std::uint64_t next_event_ = 1, next_collision_ = 1, next_journal_ = 1, next_forces_ = 1;
    wire::Server published_;
    Nanoseconds published_at_ = 0;
};

}  // namespace plab::publish
