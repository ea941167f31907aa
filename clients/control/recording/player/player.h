/// Publishes a recording on the bus as the recorded server would: same topics, in its partition, the catalogue before the
/// samples that refer to it, everything at its time.
/// A jump back begins a new run, as a reset does, so that clients start afresh. Numbers of events and frames continue without
/// gaps, except for those of the recording itself.
#pragma once

#include <map>
#include <set>

#include "control/recording/player/pace.h"
#include "control/recording/player/retained_samples.h"
#include "control/recording/player/server_facade.h"
#include "control/recording/player/track.h"
#include "idl/domain.h"
#include "idl/recording/reader.h"
#include "link/session.h"

namespace plab::player
{

struct PlaybackOptions
{
    std::string file;
    std::string name;            ///< of the server; empty: the recorded one's
    std::string version;         ///< of this program
    std::optional<double> from;  ///< s of the recording's time line; empty: its start
    std::optional<double> to;    ///< s; empty: its end
    double rate = 1;
    bool paused = false;
    bool loop = false;
    bool from_first_state = false;  ///< where `from` is empty: a recorder begins before the first state reaches it
    std::uint32_t readers = 0;  ///< starts when this many readers of the states are connected
    wire::DomainOptions domain = {};
};

class Player
{
public:
    using Clock = std::chrono::steady_clock;

    /// Opens the file, reserves the name and joins the bus. Nothing is sent before the first step().
    static Result<std::unique_ptr<Player>> open(const PlaybackOptions& options);
    ~Player();
    Player(const Player&) = delete;
    Player& operator=(const Player&) = delete;

    /// Sends what is due, or a part of it if it is much. Nothing: continue. An error: another server has the name.
    Result<void> step(Clock::time_point now);
    /// Waits until there is something to do, a request has arrived, or `latest`.
    void wait(Clock::time_point latest);
    /// False: it waits for readers.
    bool has_begun() const { return has_begun_; }
    /// Everything has been sent, and it does not loop.
    bool is_over() const { return is_over_; }
    /// Number of readers that read the complete states of this playback.
    std::uint32_t readers() const;

    void pause(bool paused, Clock::time_point now);
    void set_rate(double rate, Clock::time_point now);
    /// Jumps to a time on the recording's time line, ns.
    void seek(std::uint64_t time, Clock::time_point now);

    const Pace& pace() const { return pace_; }
    const std::string& name() const { return facade_.name(); }
    PlaybackState state() const { return state_; }
    std::uint64_t sent() const { return sent_; }
    /// Messages that are damaged, or are not samples of their topic.
    std::uint64_t broken() const { return broken_; }
    /// Topics of the recording that are not pLab topics, and are not sent.
    const std::vector<std::string>& foreign() const { return foreign_; }

private:
    Player(recording::McapReader reader, ServerFacade front, const Pace& pace, const PlaybackOptions& options);
    Result<void> join(const PlaybackOptions& options);
    Result<void> make_tracks();
    void show_scene();
    void begin(Clock::time_point now);
    void send_due(Clock::time_point now);
    void end_or_loop(Clock::time_point now);
    void jump_back(std::uint64_t time, Clock::time_point now);
    std::uint64_t run_at(std::uint64_t time) const;
    void jump(std::uint64_t time);
    void put_catalogue(RetainedSamples wanted);
    void put_status(std::uint64_t until);
    void put_latest(const std::string& topic, std::uint64_t until);
    void put_frame(std::uint64_t until);
    /// False: nothing is left.
    bool fetch();
    void send_next();
    void send_entry(const recording::Found& found);
    void send(const std::string& topic, recording::ByteView bytes);
    void take_gone(recording::ByteView bytes);
    void dispose(const std::set<InstanceKey>& places);
    void note_place(recording::Peek& peek, recording::ByteView bytes);
    void serve_new_readers();
    bool has_newcomers(const std::string& topic);
    void report_status(Clock::time_point now, bool at_once);
    Track* track_of(const std::string& topic);

    recording::McapReader reader_;
    ServerFacade facade_;
    Pace pace_;
    bool loop_, moved_only_ = false;
    Changes changes_;
    std::vector<std::string> topics_, foreign_;
    wire::Participant participant_;
    wire::Entity publisher_, subscriber_, waitset_;
    std::map<std::string, std::unique_ptr<Track>> tracks_;
    std::unique_ptr<recording::Peek> frames_, statuses_;

    std::optional<recording::Cursor> cursor_;
    std::optional<recording::Found> next_;  ///< the next message
    std::uint64_t position_ = 0;            ///< log_time of the last one
    std::uint64_t jumped_to_ = 0;           ///< the catalogue of this time is already on the bus
    std::uint32_t wanted_readers_;
    bool has_begun_ = false, is_over_ = false;
    RetainedSamples retained_;                   ///< catalogue samples that are on the bus
    std::uint64_t retained_shift_ = 0;           ///< run_shift with which it was written
    std::set<InstanceKey> doomed_;               ///< disposed in the recording, and disposed of unless they return at the same moment
    std::uint64_t highest_run_ = 0;              ///< highest run number published
    std::map<std::string, std::uint32_t> seen_;  ///< readers so far, of topics that newcomers get at once

    PlaybackState state_;
    std::uint64_t sent_ = 0, broken_ = 0;
    Clock::time_point published_at_{};
    std::uint64_t published_position_ = 0;
};

}  // namespace plab::player
