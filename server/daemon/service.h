/// What plabd does for clients: receives requests, and sends answers and records. Without a bus it serves the command line
/// only.
#pragma once

#include <atomic>
#include <map>
#include <memory>

#include "bus/bus.h"
#include "control/operations.h"
#include "daemon/options.h"
#include "daemon/people.h"
#include "daemon/recording.h"
#include "daemon/request_reader.h"
#include "daemon/snapshot_desk.h"
#include "daemon/wake.h"
#include "plugins/library.h"
#include "publish/collector.h"

namespace plab::daemon
{

class Service final : public ImageSink
{
public:
    Service(simulation::Simulation& simulation, plugins::PluginLibrary& library, const DaemonOptions& options);
    ~Service();
    Service(const Service&) = delete;
    Service& operator=(const Service&) = delete;

    /// Loads bus.so and joins the bus. `wake` must outlive this object, and so must `interruption`, which a client's shutdown
    /// request sets.
    Result<void> open_bus(const DaemonOptions& options, const Wake& wake, Interruption& interruption);

    /// Loads record.so and starts the recording that the options describe.
    Result<void> open_recording(const DaemonOptions& options);

    /// A request of the command line.
    void post(simulation::Request request);
    /// Restores the requests that waited when a snapshot was written, in its text form; they wait again.
    Result<void> take_over(const std::vector<std::string>& waiting);
    /// A snapshot of the current state, with the waiting requests.
    Result<void> save(const std::string& file) const;
    /// Passes requests that have arrived on the bus, and have been read, to the simulation; invalid ones are refused.
    void take_requests();
    /// Applies the newest samples of users and viewers, to be called before a step.
    void take_people();
    /// Shows the scene, as the requests that were taken have left it, to the thread that reads the next ones. To be called after they
    /// have been carried out.
    void show_scene();
    /// Like take_requests(), after those that have arrived have been read, for which it waits: the run is to end.
    void take_last_requests(std::chrono::milliseconds most);
    /// Answers requests that took effect or failed: to clients, as events, as log lines. False if one of the command line was
    /// refused, because the run is then not the one that was asked for.
    bool answer();
    /// Journal of the requests that the simulation made itself before the last step: measurements, and what components decided.
    void note_own_requests();
    /// To be called before a step: lets it note what observers will want to know of it.
    void prepare() { collector_.prepare(*simulation_); }
    /// Records for observers: after a step, or (`stepped` false) after requests between steps.
    void publish(bool stepped);
    /// While paused: sends what new observers must see.
    void idle();
    void publish_status(double rate_reached, double slipped, bool slipping);

    /// The end: answers clients whose requests still wait. Returns the number of waiting requests of the command line.
    std::size_t close();
    /// Ends the recording. False if its file is incomplete, or something was dropped; the log has the details.
    bool close_recording();

    bool shutdown_wanted() const { return shutdown_; }
    /// Why the server must end, if it must.
    std::string lost() const { return bus_ ? bus_->lost() : std::string(); }
    std::uint64_t answered() const { return done_ + refused_; }

    // ImageSink: pictures of cameras in the scene.
    bool wanted() const override;
    void show(std::uint32_t component, std::uint32_t width, std::uint32_t height, std::vector<std::uint8_t> rgba) override;

private:
    struct Origin
    {
        bool from_bus = false;
        bool was_answered = false;  ///< in an earlier run: a snapshot restored it, and its client has its answer already
        wire::ClientId client{};
        std::uint64_t number = 0;
        std::int64_t arrived_ns = 0;
        std::vector<control::Description> operations;
        std::vector<wire::Operation> texts;  ///< the same as text, for the journal
    };
    void accept(const publish::ReceivedRequest& text, control::Wanted wanted);
    void refuse(const publish::ReceivedRequest& text, Errors errors);
    void answer_client(const Origin& origin, const simulation::Reply& reply);
    void shut_down(const publish::ReceivedRequest& text);
    void cancel(const publish::ReceivedRequest& text, const control::Wanted::Cancelled& which);
    void wake_up() const;
    void note_restart();
    void note(const Origin& origin, const simulation::Reply& reply);
    void post(simulation::Request request, Origin origin);
    std::optional<Origin> origin_of(std::uint64_t request);
    std::vector<std::string> words_of(const simulation::Snapshot& snapshot) const;
    void write_journal(const Origin& origin, const simulation::Reply& reply);
    void make_snapshot(const simulation::Snapshot& snapshot, const std::string& name, const char* cause);
    void send_snapshots();
    simulation::Reply move(const People::Ask& ask);
    void publish_forces();
    void send_named_snapshots(const Origin& origin);
    std::vector<wire::KeptSnapshot> kept_snapshots() const;

    simulation::Simulation* simulation_;
    plugins::PluginLibrary* library_;
    std::string scene_file_;
    std::uint32_t threads_;
    plugins::Module module_;                 // destroyed after bus_
    std::unique_ptr<RequestReader> reader_;  // stopped before bus_ goes, destroyed after it: the bus calls wake_up()
    std::unique_ptr<bus::Bus> bus_;
    std::atomic<bool> bus_is_open_ = false;
    std::optional<RecordModule> record_module_;  // destroyed after recording_
    std::unique_ptr<record::Recording> recording_;
    publish::Collector collector_;
    People people_;
    publish::ReceivedPeople samples_;  ///< keeps its memory
    const Wake* wake_ = nullptr;
    const Interruption* interruption_ = nullptr;
    SnapshotDesk snapshots_;  // wakes the loop; the members that it uses are declared above
    std::map<std::uint64_t, Origin> waiting_;
    /// Requests that name a step, even after they took effect: a snapshot may restore them.
    std::map<std::uint64_t, Origin> timed_;
    std::uint64_t last_request_ = 0, done_ = 0, refused_ = 0;
    bool shutdown_ = false;
};

}  // namespace plab::daemon
