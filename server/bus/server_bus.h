/// plabd's end of the bus: rings that the step thread fills, and one thread that empties them into the pipe to plab-bus. The
/// thread starts plab-bus, and restarts it when it ends.
#pragma once

#include <array>
#include <atomic>
#include <future>
#include <mutex>
#include <thread>

#include "bus/bus.h"
#include "bus/bus_process.h"
#include "bus/catalogue_mirror.h"
#include "bus/feed.h"
#include "bus/log_limit.h"
#include "bus/people_desk.h"
#include "bus/request_desk.h"
#include "idl/name_lock.h"
#include "publish/hash_batch.h"

namespace plab::bus
{

class ServerBus final : public Bus
{
public:
    static Result<std::unique_ptr<ServerBus>> open(const BusOptions& options);
    /// Disposes of all instances so that clients learn about the end, and allows 200 ms for that.
    ~ServerBus() override;

    bool wants(publish::Stream stream) const override;
    std::uint64_t joins(publish::Stream stream) const override;
    wire::Frame& begin_frame() override { return states_.begin_push(); }
    void end_frame() override;
    wire::ContactForces& begin_contacts() override { return contacts_.begin_push(); }
    void end_contacts() override;
    void collisions(wire::Collisions&& batch) override { push(collisions_, std::move(batch)); }
    void events(wire::Events&& batch) override { push(events_, std::move(batch)); }
    void metrics(wire::Metrics&& metrics) override { push(metrics_, std::move(metrics)); }
    void image(wire::Image&& image) override { push(images_, std::move(image)); }
    void journal(wire::Journal&& entry) override { push(journal_, std::move(entry)); }
    void hash(std::uint64_t run, Tick step, std::uint64_t hash) override;
    void snapshot(wire::Snapshot&& snapshot) override { push(snapshots_, std::move(snapshot)); }
    void forces(wire::Forces&& forces) override { push(forces_, std::move(forces)); }
    void status(const wire::Server& status) override;
    bool catalogue(publish::CatalogueChange&& change) override;
    bool take(publish::ReceivedRequest& request) override { return desk_.take(request); }
    void take_people(publish::ReceivedPeople& people) override { people_.take(people); }
    void answer(wire::Reply&& answer) override;
    std::string lost() const override;
    std::string take_restart() override;
    int process() const override { return pid_.load(std::memory_order_relaxed); }

private:
    using Clock = std::chrono::steady_clock;
    using Nanoseconds = std::chrono::nanoseconds;
    ServerBus(const BusOptions& options, wire::NameLock lock);

    template <class Record>
    void push(Feed<Record>& feed, Record&& record)
    {
        feed.begin_push() = std::move(record);
        feed.end_push();
        wake_.notify_once();
    }
    template <class Function>
    auto of(publish::Stream stream, Function function) const;
    template <class Function>
    void each(Function function);

    // Bus thread ------------------------------------------------------------------------------------------------------
    void run();
    /// Starts plab-bus if it is not running and may be started.
    void supervise(Clock::time_point now);
    void end_process(const std::string& why, Clock::time_point now);
    void begin_anew(Clock::time_point now);
    /// Does a limited amount of each kind of work. True if there is more.
    bool pass(Clock::time_point now);
    bool receive(Clock::time_point now);
    void handle(const MessageReader::Message& message, Clock::time_point now);
    void note_wants(const WantsMessage& wants);
    bool send(Clock::time_point now);
    void send_status(Clock::time_point now);
    void send_catalogue();
    template <class Function>
    bool next_change(Function f);
    void send_answers();
    void watch(Clock::time_point now);
    bool was_stopped(Clock::time_point now);
    void sleep(Nanoseconds longest);
    void say_goodbye();
    void wake() const
    {
        if (options_.wake != nullptr) options_.wake(options_.wake_argument);
    }
    void log(const std::string& line);

    BusOptions options_;
    wire::NameLock lock_;
    StartMessage start_;
    WakeEvent wake_;  ///< notified by the step thread and by plab-bus
    std::atomic<bool> stop_{false};
    std::atomic<bool> is_lost_{false};
    std::string why_lost_;  // written once, before is_lost_
    std::atomic<int> pid_{0};
    std::atomic<bool> restarted_{false};
    std::mutex restart_mutex_;  ///< held briefly, after restarted_ was set
    std::string restart_;

    publish::Ring<publish::CatalogueChange> changes_;
    std::atomic<std::size_t> changes_waiting_{0};
    Feed<wire::Frame> states_{publish::Stream::States, 8};
    Feed<wire::Collisions> collisions_{publish::Stream::Collisions, 1024};
    Feed<wire::Events> events_{publish::Stream::Events, 1024};
    Feed<wire::Metrics> metrics_{publish::Stream::Metrics, 4};
    Feed<wire::Image> images_{publish::Stream::Images, 2};
    Feed<wire::Journal> journal_{publish::Stream::Journal, 1024};
    Feed<wire::Hashes> hashes_{publish::Stream::Hashes, 1024};
    Feed<wire::Snapshot> snapshots_{publish::Stream::Snapshots, 2};
    Feed<wire::Forces> forces_{publish::Stream::Forces, 64};
    Feed<wire::ContactForces> contacts_{publish::Stream::Contacts, 4};
    publish::Ring<wire::Server> statuses_{4};
    publish::HashBatch hash_batch_;  ///< used by the step thread only
    RequestDesk desk_;
    PeopleDesk people_;

    // Used by the bus thread only.
    std::unique_ptr<BusProcess> process_;
    bool has_joined_ = false, is_broken_ = false, has_hung_up_ = false;
    std::string failed_;  ///< why the current plab-bus could not join
    std::promise<Result<void>> first_;
    bool was_first_received_ = false;
    CatalogueMirror mirror_;
    std::optional<wire::Reply> answer_;  ///< an answer that waits for room
    StatusMessage status_;
    std::string overload_;  ///< as the step thread reported it
    bool has_status_ = false, status_is_new_ = false;
    Clock::time_point started_{}, start_at_{}, heard_{}, died_{}, status_sent_{};
    Clock::time_point stopped_{};  ///< time of the last check whether plab-bus is stopped
    Clock::duration delay_{};
    int stopped_checks_ = 0;
    int silent_ = 0;       ///< seconds in which this thread was awake and plab-bus sent nothing
    bool is_new_ = false;  ///< the current plab-bus started recently and may not know of its readers yet
    std::string why_restarted_;
    LogLimit log_limit_;
    std::thread thread_;
};

}  // namespace plab::bus
