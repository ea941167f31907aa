/// Turns the state of a simulation into records, on the step thread, as far as observers want them.
#pragma once

#include <optional>
#include <vector>

#include "publish/catalogue_tracker.h"
#include "publish/happenings.h"
#include "publish/observer.h"
#include "publish/pace.h"
#include "publish/sampler.h"
#include "simulation/simulation.h"

namespace plab::publish
{

struct CollectorOptions
{
    double states_per_second = 60;         ///< of real time; 0: each step
    double metrics_per_second = 4;         ///< of real time
    double error_share = 0.01;             ///< of real time that shadow steps may take, while somebody watches metrics
    double seconds_between_snapshots = 5;  ///< of real time, for observers without an interval of their own
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
    /// A request took effect; its place in the order of all is filled in here.
    void journal(JournalRecord entry);
    /// Why a snapshot of the present state is wanted, if somebody wants one now: "begin" of a run or of an observer's
    /// interest, or "periodic". Whoever asks must then hand one over.
    std::optional<const char*> wants_snapshot(const simulation::Simulation& simulation);
    bool anybody_reads_snapshots() const;
    void snapshot(const SnapshotRecord& snapshot);
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
        Wish states, metrics, snapshots;
        double next_frame = 0, next_metrics = 0, next_snapshot = 0;  ///< s, simulated: of those with intervals of their own
        std::uint64_t snapshot_run = 0;
        std::uint64_t frames = 0;  ///< handed over
    };
    enum class When
    {
        InTurn,
        Now,
        ForNewcomers,
    };
    static bool fresh(const Observer& observer, Stream stream, Wish& wish);
    static bool in_turn(const Observer& observer, Stream stream, double time, double& next, bool servers_turn);

    void tell_moment(const simulation::Simulation& simulation);
    void tell_catalogue(const simulation::Simulation& simulation, Nanoseconds now);
    void tell_states(const simulation::Simulation& simulation, Nanoseconds now, When when);
    void tell_events(const simulation::Simulation& simulation, const Counts& counts);
    void tell_metrics(const simulation::Simulation& simulation, Nanoseconds now, When when);
    void tell_hash(const simulation::Simulation& simulation);
    void begin_run(const simulation::Simulation& simulation);

    CollectorOptions options_;
    CatalogueTracker catalogue_;
    Sampler sampler_;
    std::vector<Watcher> watchers_;
    Pace states_, metrics_, scripted_, snapshots_;
    std::uint64_t run_ = 0;
    Nanoseconds sampled_ = 0;     ///< when metrics went out last
    bool metrics_asked_ = false;  ///< out of turn
    std::uint64_t next_event_ = 1, next_collision_ = 1, next_journal_ = 1;
    Status published_;
    Nanoseconds published_at_ = 0;
};

}  // namespace plab::publish
