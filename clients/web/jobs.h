/// Recordings, playbacks and branches that pages have started: commands of plabctl in processes of their own, which end with this program.
/// Nothing here waits for them: answers come by update().
#pragma once

#include <chrono>
#include <functional>
#include <list>
#include <optional>
#include <string>
#include <vector>

#include "idl/json/json.h"
#include "link/session.h"
#include "program/child.h"
#include "web/recordings.h"

namespace plab::web
{

using wire::Json;

class Jobs
{
public:
    static constexpr std::size_t kMostPlaybacks = 4, kMostBranches = 4;  ///< at a time; one recording
    /// Members of the reply, or why it was not done.
    using Answer = std::function<void(const Result<Json>&)>;

    /// `recordings`: null, if there is no folder for them.
    Jobs(wire::DomainOptions domain, Recordings* recordings) : domain_(std::move(domain)), recordings_(recordings) {}
    ~Jobs();
    Jobs(const Jobs&) = delete;
    Jobs& operator=(const Jobs&) = delete;

    /// `name` "": one with the date. It ends at the latest when all recordings together have Recordings::most_bytes().
    void record(const std::string& server, std::string name, Answer answer);
    void stop_recording(const Answer& answer);
    /// The answer's member `server` is the name under which it plays; a recording that plays already is not played twice.
    void play(const std::string& recording, Answer answer);
    /// One line for a playback: `plabctl play --control` says which.
    void control(const std::string& server, const std::string& line, const Answer& answer);
    /// `name` "": one that is free.
    void branch(const std::string& server, std::string name, bool is_paused, Answer answer);
    /// Ends a playback or a branch.
    void end(const std::string& server, const Answer& answer);
    void remove(const std::string& recording, const Answer& answer);

    /// Takes what the processes say, and answers.
    void update();

    bool is_idle() const { return jobs_.empty(); }
    /// A playback or a branch that can be looked at.
    bool has_server(const std::string& name) const;
    std::vector<std::string> playbacks() const;
    /// {"recording": {name, server, seconds, bytes} or null, "servers": [{name, kind, of, is_there}], ...}
    Json state() const;
    /// Where a playback is, as text of JSON: {from, to, at, rate, paused}; "": not known, or as at the last call.
    std::string take_position(const std::string& playback);
    /// What happened by itself, in sentences.
    std::vector<std::string> take_notices();

private:
    using Clock = std::chrono::steady_clock;
    enum class Kind : unsigned char
    {
        Recording,
        Playback,
        Branch,
    };
    struct Job
    {
        Kind kind;
        std::string name;  ///< of the recording, or of the server that it is
        std::string of;    ///< the recorded or branched server; the recording that is played
        program::Child child;
        Clock::time_point begun;
        Answer answer;         ///< null once it was given
        std::string position;  ///< of a playback, as it said it last
        bool is_ending = false;
    };

    std::vector<std::string> command(const std::string& server) const;
    std::size_t count(Kind kind) const;
    Job* find(const std::string& server);
    void start(Kind kind, std::string name, std::string of, const std::vector<std::string>& command, Answer answer);
    void take_output(Job& job);
    void finish(Job& job, int code);
    std::string why_ended(Job& job, int code) const;
    std::string recorded_path(const Job& job) const;

    wire::DomainOptions domain_;
    Recordings* recordings_;
    std::list<Job> jobs_;
    std::vector<std::string> notices_;
};

}  // namespace plab::web
