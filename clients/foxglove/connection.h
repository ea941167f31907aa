/// The link to one server while it is there.
#pragma once

#include <chrono>
#include <map>
#include <optional>

#include "foxglove/audience.h"
#include "foxglove/contact_arrows.h"
#include "foxglove/playback.h"
#include "foxglove/scene.h"
#include "foxglove/topic_reader.h"
#include "idl/recording/cdr.h"
#include "link/frame_reader.h"
#include "link/requests.h"

namespace plab::foxglove
{

class Connection
{
public:
    /// Waits for the whole catalogue. All must outlive it; `playback`: what is played by this server, or null.
    static Result<std::unique_ptr<Connection>> open(const link::Session& session, Clients& clients, Audience& audience, Playback* playback,
                                                    const link::Stop& stop);

    /// Waits for what the server sends, a few milliseconds, and passes it on; true if clients got something.
    bool step();
    /// It has gone, or another one has taken its name.
    bool is_over() const { return is_over_; }
    /// Clients whose requests were not answered are told.
    void close();

    void get_parameters(ClientId client, const GetParameters& said);
    void set_parameters(ClientId client, const SetParameters& said);
    void call(ClientId client, const ServiceCall& said);

private:
    Connection(const link::Session& session, Clients& clients, Audience& audience, Playback* playback, link::Caller caller)
        : session_(session), clients_(clients), audience_(audience), playback_(playback), requests_(std::move(caller))
    {
    }

    void subscribe();
    void take_catalogue();
    void take_topics();
    void take_topic(const Channel& channel, TopicReader& reader);
    void tell_gone(const Channel& channel, const std::string& key);
    void take_frames();
    void take_contacts();
    void send_resting_frames();
    void send_kept();
    void send_scene();
    void say(ClientId client, const Json& json);
    void put(const Channel& channel, std::uint64_t instance, const Stamped& message);
    std::uint64_t stamp_of(std::optional<double> time) const;
    void note_time(double time);

    const link::Session& session_;
    Clients& clients_;
    Audience& audience_;
    Playback* playback_;
    link::Requests requests_;
    std::optional<link::Catalogue> catalogue_;
    std::int64_t started_ns_ = 0;
    std::uint64_t version_ = 0;
    std::chrono::steady_clock::time_point compared_at_{};
    double time_ = 0;                         ///< s, simulated, the newest that is known
    std::uint64_t run_ = 0, frames_run_ = 0;  ///< frames_run_: of the newest frame

    // Read only while somebody subscribes.
    std::map<ChannelId, TopicReader> readers_;
    std::optional<link::FrameReader> frames_;
    std::optional<wire::DataReader<plab_v2_ContactForces>> contacts_;

    DrawnScene sent_;  ///< what subscribers of the scene know
    FrameWriter frame_writer_;
    ContactArrows contact_arrows_;
    std::optional<Stamped> transforms_;  ///< the newest
    recording::Encoder encoder_;
    bool has_news_ = false, is_over_ = false;
};

}  // namespace plab::foxglove
