/// What plabd does for clients: requests in, answers and records out. Without a bus it serves the command line only.
#pragma once

#include <map>
#include <memory>

#include "bus/bus.h"
#include "control/operations.h"
#include "daemon/options.h"
#include "daemon/recording.h"
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

    /// Loads bus.so and joins. `wake` must outlive this, and `interruption`, which a client's shutdown asks.
    Result<void> open_bus(const DaemonOptions& options, const Wake& wake, Interruption& interruption);

    /// Loads record.so and begins to write the recording that the options name.
    Result<void> open_recording(const DaemonOptions& options);

    /// A request of the command line.
    void post(simulation::Request request);
    /// Requests that waited when a snapshot was written, in its words, wait again.
    Result<void> take_over(const std::vector<std::string>& waiting);
    /// A snapshot of the present, with what waits.
    Result<void> save(const std::string& file) const;
    /// Requests that have arrived on the bus go to the simulation; those that are nonsense are refused.
    void take_requests();
    /// Answers those that took effect (or did not): to clients, as events, as log lines. False if one of the command line
    /// was refused: a run that was asked for something else must not pass for it.
    bool answer();
    /// Records for observers: after a step, or (`stepped` false) after requests between steps.
    void publish(bool stepped);
    /// While paused: what observers that have just come must see.
    void idle();
    void publish_status(double rate_reached, double slipped, bool slipping);

    /// The end: clients whose requests still wait are told. The number of the command line's that wait.
    std::size_t close();
    /// Ends the recording. False if its file is not whole, or something was dropped; said in the log.
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
        bool was_answered = false;  ///< in a run before: a snapshot makes it wait again, and its client has gone on since
        publish::ClientId client{};
        std::uint64_t number = 0;
        std::int64_t arrived_ns = 0;
        double read_ns = 0;  ///< what it took to understand it, on the step thread
        std::vector<control::Description> operations;
        std::vector<publish::OperationText> texts;  ///< the same, as the journal keeps them
    };
    void accept(const publish::RequestText& text, control::Wanted wanted, double read_ns);
    void refuse(const publish::RequestText& text, Errors errors, double read_ns);
    void answer_client(const Origin& origin, simulation::Reply reply);
    void shut_down(const publish::RequestText& text);
    void cancel(const publish::RequestText& text, const control::Wanted::Cancelled& which);
    void note_restart();
    void note(const Origin& origin, const simulation::Reply& reply);
    void post(simulation::Request request, Origin origin);
    std::optional<Origin> origin_of(std::uint64_t request);
    std::vector<std::string> words_of(const simulation::Snapshot& snapshot) const;
    void write_journal(const Origin& origin, const simulation::Reply& reply);
    void make_snapshot(const simulation::Snapshot& snapshot, const std::string& name, const char* cause);
    void send_snapshots();
    void send_named_snapshots(const Origin& origin);
    std::vector<publish::KeptSnapshot> kept_snapshots() const;

    simulation::Simulation* simulation_;
    plugins::PluginLibrary* library_;
    std::string scene_file_;
    std::uint32_t threads_;
    plugins::Module module_;  // goes after bus_
    std::unique_ptr<bus::Bus> bus_;
    std::optional<RecordModule> record_module_;  // goes after recording_
    std::unique_ptr<record::Recording> recording_;
    publish::Collector collector_;
    const Wake* wake_ = nullptr;
    SnapshotDesk snapshots_;  // wakes the loop; what it uses stands above
    std::map<std::uint64_t, Origin> waiting_;
    /// Requests that name a step, also after they took effect: a snapshot may make them wait again.
    std::map<std::uint64_t, Origin> timed_;
    std::uint64_t last_request_ = 0, done_ = 0, refused_ = 0;
    bool shutdown_ = false;
};

}  // namespace plab::daemon
