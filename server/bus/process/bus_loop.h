/// The main loop of plab-bus: records from plabd become DDS samples, requests of clients go to plabd.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <deque>
#include <set>
#include <string>

#include "bus/channel/messages.h"
#include "bus/channel/wake_event.h"
#include "bus/process/catalogue_writer.h"
#include "bus/process/dds_log.h"
#include "bus/process/newest_samples.h"
#include "bus/process/outbox.h"
#include "bus/process/presence.h"
#include "bus/process/stream.h"
#include "idl/domain.h"
#include "idl/frame_updates.h"
#include "idl/samples.h"

namespace plab::bus
{

/// Uses one thread; DDS has its own threads, whose listeners set a flag and the wake event.
class BusLoop
{
public:
    /// Uses the descriptors of channel/inherited.h.
    BusLoop(MessageReader reader, MessageWriter writer, WakeEvent& wake, const WakeEvent& server, int lifeline, const StartMessage& start);
    /// False if it cannot join the domain; the reason goes to plabd.
    bool join();
    /// Runs until plabd announces the end. False if plabd has ended without an announcement: then no farewell is sent to
    /// clients.
    bool run();

private:
    using Clock = std::chrono::steady_clock;

    Result<void> enter();
    bool pass(Clock::time_point now);
    bool receive();
    bool handle(const MessageReader::Message& message);
    bool stream(std::uint32_t stream, std::span<const std::byte> bytes);
    bool read_requests();
    bool read_people(Clock::time_point now);
    void keep(const plab_v2_Request& request);
    void pass_on();
    void check_readers();
    void follow_scene();
    void each_second(Clock::time_point now);
    void report_dds();
    std::vector<wire::DroppedSamples> dropped() const;
    void say_goodbye();
    template <class Function>
    void each(Function function);
    template <class... Record>
    void report(Up kind, const Record&... record);
    bool sleep(Clock::time_point now);

    StartMessage start_;
    WakeEvent* wake_;
    const WakeEvent* server_;
    int lifeline_;
    MessageReader reader_;
    MessageWriter writer_;
    Trouble trouble_;
    std::atomic<bool> matched_{true}, arrived_{true}, people_arrived_{true};  ///< set by DDS listeners, on threads of DDS
    bool is_over_ = false;

    DdsLog dds_log_;
    // Declared before all entities that depend on it; listeners notify until the participant is deleted.
    wire::Participant participant_;
    wire::Entity publisher_, subscriber_;
    Stream<plab_v2_Frame, wire::Frame, wire::FrameWriter> states_;  ///< also writes plab/updates
    Stream<plab_v2_Collisions, wire::Collisions> collisions_;
    Stream<plab_v2_Events, wire::Events> events_;
    Stream<plab_v2_Metrics, wire::Metrics> metrics_;
    Stream<plab_v2_Image, wire::Image> images_;
    Stream<plab_v2_Journal, wire::Journal> journal_;
    Stream<plab_v2_Hashes, wire::Hashes> hashes_;
    Stream<plab_v2_Snapshot, wire::Snapshot> snapshots_;
    Stream<plab_v2_Forces, wire::Forces> forces_;
    Stream<plab_v2_ContactForces, wire::ContactForces> contacts_;
    CatalogueWriter catalogue_;
    Presence presence_;
    wire::DataReader<plab_v2_Request> requests_;
    NewestSamples<plab_v2_UserSample, wire::UserSample> users_{Up::User};
    NewestSamples<plab_v2_ViewerSample, wire::ViewerSample> viewers_{Up::Viewer};
    Clock::duration people_due_ = Clock::duration::max();  ///< time until the next of their samples may be passed on
    std::deque<RequestMessage> waiting_;                   ///< taken from the reader in one pass, and not passed on yet
    wire::DataWriter<plab_v2_Reply> replies_;
    wire::SampleView<plab_v2_Reply> reply_sample_;
    Outbox outbox_;
    std::array<std::uint64_t, kStreams> ring_dropped_{};
    Clock::time_point second_{};
};

}  // namespace plab::bus
