/// Islands of bodies at rest sleep: a step leaves them out altogether, until something wakes them exactly where they were. Explained in
/// server/docs/sleeping.md.
///
/// A body is quiet in a step if at its end no point of it moves faster than sleep_speed (a parameter of the manager), |v| + r |w|, and if
/// contacts have balanced the forces: |dv| + r |dw| is at most kNetShare of the speed that forces alone would have given it. Quiet bodies
/// add up their velocities over half windows of sleep_after / 2. At the end of each half, an island falls asleep if all of its bodies have
/// been quiet for both halves, if the mean velocities of the two halves agree (which tells rest from a turning point, where the speed is
/// small too), and if something that never moves supports it. Its velocities become zero, and the energy that goes is booked as work of its
/// manager.
///
/// A sleeping island wakes as a whole: when a body that is awake touches it; and when a request or a script has changed something on which
/// its rest depends. For the latter each body keeps a hash of that (sleep_causes.h), which is compared whenever something has changed.
///
/// Everything is decided by the state alone, in the order of ids; so runs that are repeated, restored or divided over threads agree.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "simulation/contacts/declared_output.h"
#include "simulation/contacts/held_islands.h"
#include "simulation/contacts/sleep_causes.h"
#include "simulation/contacts/sleeping_pairs.h"

namespace plab::simulation
{

class SleepingIslands
{
public:
    SleepingIslands(StepState& step, GroupMotion& motion, ContactBook& contacts)
        : step_(step), motion_(motion), contacts_(contacts), causes_(step, contacts)
    {
    }

    /// After any structural change.
    void rebuild();
    /// A request or a script may have changed what the rest of a body depends on.
    void note_change() { rest().note_change(); }
    /// Whether islands may sleep in this scene.
    bool may_sleep() const { return on_; }
    /// Whether any do.
    bool any() const { return !rest().islands.empty(); }
    /// The groups that are not asleep, ascending; to be used if there are any that are.
    const std::vector<std::uint32_t>& awake_groups() const { return awake_groups_; }
    /// At the start of a step, before contacts are detected: wakes islands whose cause of rest has gone. True if there were any.
    bool begin_step();
    /// Wakes the islands that a body which is awake touches. `fresh`: the pairs that are new. True if there were any; then contacts have to
    /// be detected again.
    bool wake_touched(std::span<const PairState> fresh);
    /// At the end of a step: counts how long bodies have been quiet, and lets islands fall asleep. True if any did, or woke.
    bool finish_step(std::span<const RestSample> samples, std::span<const PairState> fresh);

    /// A body whose velocity changes by more than this share of what forces would give it is not held by contacts.
    static constexpr double kNetShare = 1.0 / 8;
    /// Of sleep_speed: how far the mean speeds of the two halves of the window may differ.
    static constexpr double kSteadyShare = 1.0 / 16;
    /// Of the acceleration by forces alone: mean acceleration of a body at rest over the window.
    static constexpr double kBalanceShare = 1.0 / 256;

private:
    struct Rule
    {
        DeclaredNumber after, speed;  ///< of one manager: s, m/s
        DeclaredOutput<std::int64_t> asleep;
        DeclaredOutput<std::string> reason;
    };
    enum class State : std::uint8_t
    {
        Moving,
        Ready,
        Blocked
    };

    RestState& rest() { return contacts_.cache().rest(); }
    const RestState& rest() const { return std::as_const(contacts_).cache().rest(); }
    void read_rules();
    std::uint32_t half_window() const;
    void find_groups_that_may_sleep();
    bool is_quiet(std::uint32_t body, const RestSample& sample) const;
    bool is_steady(std::uint32_t body, const RestSample& sample) const;
    void count_quiet_steps(std::span<const RestSample> samples);
    void begin_half();
    bool find_ready(std::span<const RestSample> samples);
    void join_pairs();
    bool fall_asleep();
    void put_to_sleep(const SleepingIsland& island);
    void put_pairs_away();
    void list_awake();
    void wake(std::vector<std::uint32_t> places, const char* why, Ref by);
    void wake_all(const char* why);
    void wake_changed();
    void report(const char* kind, const SleepingIsland& island, const char* message, Ref by, double energy);
    void publish();
    std::string reason() const;
    std::uint32_t manager_of(std::uint32_t detector) const;

    StepState& step_;
    GroupMotion& motion_;
    ContactBook& contacts_;
    SleepCauses causes_;
    bool on_ = false;
    std::vector<Rule> rules_;              ///< by detector
    double after_ = 0, speed_ = 0;         ///< s, m/s: in this step
    double now_ = 0;                       ///< s, for events
    std::vector<std::uint8_t> may_sleep_;  ///< by group
    std::shared_ptr<const char> listed_;   ///< RestState::mark when list_awake() was called last
    std::shared_ptr<const char> refused_;  ///< the same when it was last found that nothing may sleep
    std::vector<std::uint32_t> awake_groups_, quiet_bodies_;
    IndexSet awake_bodies_;                      ///< and bodies with prescribed motion
    std::vector<std::uint32_t> island_of_body_;  ///< kNoIndex: awake
    std::vector<State> states_;                  ///< by body, scratch
    std::vector<std::uint8_t> supported_;        ///< by body, scratch
    DisjointSets sets_;                          ///< of bodies, scratch
};

}  // namespace plab::simulation
