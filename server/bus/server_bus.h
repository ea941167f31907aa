/// The server's end of the bus: rings that the step thread fills, and one thread that empties them into DDS.
#pragma once

#include <array>
#include <atomic>
#include <thread>

#include "bus/bus.h"
#include "bus/catalogue.h"
#include "bus/presence.h"
#include "bus/request_desk.h"
#include "bus/stream.h"
#include "idl/name_lock.h"
#include "publish/hash_batch.h"
#include "publish/wake_up.h"

namespace plab::bus
{

class ServerBus final : public Bus
{
public:
    static Result<std::unique_ptr<ServerBus>> open(const BusOptions& options);
    /// Says goodbye: everything is disposed of, and has 200 ms to arrive.
    ~ServerBus() override;

    bool wants(publish::Stream stream) const override;
    std::uint64_t joins(publish::Stream stream) const override;
    publish::Frame& begin_frame() override { return states_.begin_push(); }
    void end_frame() override;
    void collisions(publish::Batch<publish::CollisionRecord>&& batch) override;
    void events(publish::Batch<publish::EventRecord>&& batch) override;
    void metrics(publish::Metrics&& metrics) override;
    void image(publish::Image&& image) override;
    void journal(publish::JournalRecord&& entry) override;
    void hash(std::uint64_t run, Tick step, std::uint64_t hash) override;
    void snapshot(publish::SnapshotRecord&& snapshot) override;
    void status(const publish::Status& status) override;
    bool catalogue(publish::CatalogueChange&& change) override;
    bool take(publish::RequestText& request) override { return desk_.take(request); }
    void answer(publish::Answer&& answer) override;
    std::string lost() const override;

private:
    using Clock = std::chrono::steady_clock;
    ServerBus(const BusOptions& options, wire::NameLock lock);

    Result<void> join();
    void start();
    // Bus thread ------------------------------------------------------------------------------------------------------
    void run();
    template <class Function>
    auto of(publish::Stream stream, Function function) const;
    /// Does what there is to do, a little of everything. True if there is more.
    bool pass();
    bool receive(Clock::time_point now);
    void look_at_readers();
    void send_catalogue();
    void follow_scene();
    void push(std::optional<publish::HashRecord> record);
    std::vector<wire::Dropped> dropped() const;
    void say_goodbye();
    Clock::duration idle_time(Clock::time_point now) const;

    BusOptions options_;
    wire::NameLock lock_;
    Trouble trouble_;

    publish::WakeUp wake_up_;
    std::atomic<bool> matched_{true}, arrived_{true};  ///< set by listeners of DDS, on its threads
    std::atomic<bool> stop_{false};
    std::atomic<bool> is_lost_{false};
    std::string why_lost_;  // written once, before is_lost_

    // Before all that is made of them; and the listeners ring until the participant is gone.
    wire::Entity participant_, publisher_, subscriber_;

    publish::Ring<publish::CatalogueChange> changes_;
    std::atomic<std::size_t> changes_waiting_{0};
    Stream<plab_v2_Frame, wire::FrameSample, publish::Frame> states_{8};
    Stream<plab_v2_Collisions, wire::CollisionsSample, publish::Batch<publish::CollisionRecord>> collisions_{1024};
    Stream<plab_v2_Events, wire::EventsSample, publish::Batch<publish::EventRecord>> events_{1024};
    Stream<plab_v2_Metrics, wire::MetricsSample, publish::Metrics> metrics_{4};
    Stream<plab_v2_Image, wire::ImageSample, publish::Image> images_{2};
    Stream<plab_v2_Journal, wire::JournalSample, publish::JournalRecord> journal_{1024};
    Stream<plab_v2_Hashes, wire::HashesSample, publish::HashRecord> hashes_{1024};
    Stream<plab_v2_Snapshot, wire::SnapshotSample, publish::SnapshotRecord> snapshots_{2};
    publish::HashBatch hash_batch_;  ///< step thread's

    Catalogue catalogue_;
    Presence presence_;
    RequestDesk desk_;
    Clock::time_point reported_{};
    std::thread thread_;
};

}  // namespace plab::bus
