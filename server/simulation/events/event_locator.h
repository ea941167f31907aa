/// Event location: finds the first impact inside a step, rewinds the bodies that it affects to its time, lets the response apply its
/// impulses, advances the bodies to the end of the step again, and repeats until the step contains no further impact.
///
/// All groups have been advanced to the end of the step before this starts. Between two impacts a group moves along a smooth piece of
/// its trajectory; each group remembers the state at which its present piece began (GroupMotion), so that any time inside the piece can
/// be reached by advancing from there again. How much is rewound for an impact depends on the resolution:
///   - local scope: only the groups of the colliding pair, and whatever rests on them. All other groups keep their state at the end of
///     the step, bit for bit.
///   - world scope, the paper's algorithm: all groups go back.
///
/// Candidate pairs are kept in a priority queue ordered by time. There are two kinds of candidates:
///   - A resolution that tests only the end of the step supplies pairs that overlap there. The overlap gives a bracket (clear at the
///     start of the piece, overlapping at its end), and bisection or a similar method narrows it down to the time of impact. A pair that
///     touches at the start of the piece, and closes or is pressed together, meets there: no search. Bodies that pass through each other
///     within the step are missed.
///   - A resolution that certifies supplies all pairs that may meet anywhere in the piece (swept bounding boxes). The time of such a
///     candidate starts as a lower bound: motion_bound.h proves that the pair cannot meet before. From there conservative advancement
///     goes on: measure the distance, compute how long the pair is certain to stay apart, advance by that time, and repeat until the
///     gap is zero within rounding. No impact is missed as far as the bounds on the accelerations hold.
/// Only the candidate at the front of the queue is located more precisely. If its time becomes later, it goes back into the queue; if it
/// is still the earliest, it is the next event. An answer changes the trajectories of the rewound groups, so it raises their version
/// number: candidates made with an older version are stale and are dropped, and the pairs of the rewound bodies are detected again.
///
/// Sources: Mirtich, Impulse-based Dynamic Simulation, PhD thesis (1996), chapter 2 (queue of lower bounds, conservative advancement);
/// Mirtich, Timewarp Rigid Body Simulation, SIGGRAPH (2000) (rewinding only what an impact affects).
#pragma once

#include <optional>
#include <vector>

#include "simulation/advance/advance.h"
#include "simulation/events/motion_bound.h"
#include "simulation/events/work_budget.h"

namespace plab::simulation
{

class EventLocator
{
public:
    EventLocator(StepState& step, GroupMotion& motion, ContactBook& contacts, ContactForces& forces, Advance& advance)
        : step_(step), motion_(motion), contacts_(contacts), forces_(forces), advance_(advance)
    {
    }
    /// Locates and answers events until the step contains none any more. Leaves the contacts at the end of the step in `found`.
    void run(std::vector<FoundContact>& found);

private:
    /// A closing or separation speed below this fraction of the two speeds that it is the difference of counts as zero.
    static constexpr double kNoGapRate = 1e-14;
    /// Times closer than this fraction of the step are not told apart.
    static constexpr double kShortest = 0x1p-48;

    struct Candidate
    {
        std::uint32_t detector = 0;
        Ref a, b;
        std::uint64_t version = 0;  ///< sum over both groups when the candidate was made; if it has changed, the candidate is stale
        bool certified = false;     ///< located by distance queries inside the step (conservative advancement)
        bool located = false;
        bool nothing = false;                ///< located: they do not meet
        bool stuck = false;                  ///< overlaps already where the piece begins: there is no clear side to bracket from
        bool at_end = false;                 ///< not located: answered where the step ends
        bool at_begin = false;               ///< located: it touches where its piece begins, and closes or is pressed together
        bool pressed = false;                ///< located: it touches without closing, and forces press it together
        Vec3 relief;                         ///< m/s^2, if pressed: change of b's acceleration if b is stopped by a
        double ignored = 0;                  ///< m: overlaps up to this depth belong to surfaces that the pair only slides along
        double bracket = 0;                  ///< s, time between the last clear and the first overlapping trial
        double time = 0;                     ///< s since the start of the step, on the clear side; a lower bound until located
        std::vector<FoundContact> contacts;  ///< as detected on the overlapping side
    };
    /// Queue entry. Equal times are ordered by ids, so that the result does not depend on the order of detection.
    struct Entry
    {
        double time;
        std::uint32_t detector_rank, a_rank, b_rank;
        std::uint32_t slot;
        bool operator<(const Entry& other) const;
    };
    struct Measured
    {
        GapQuery query;
        bool over_seam = false;  ///< one body passes the other: the gap is that across the surface on which it lies (look_over_seam)
    };
    /// The result of one distance query: gap and closing speed of a pair at one time.
    struct DistanceSample
    {
        double time = 0;
        GapQuery query;
        double rate = 0;         ///< m/s, time derivative of the gap
        double speed = 0;        ///< m/s, sum of the two speeds whose difference is the rate: the scale of its rounding error
        double contact_gap = 0;  ///< m: gaps up to this size count as contact (rounding)
        double slack = 0;        ///< m: a pair that touches and sinks in no deeper than this in the rest of the step is not an event
    };
    /// How far the conservative advancement of a pair has got.
    struct Advancement
    {
        EventBracket trial;      ///< question to the resolution
        DistanceSample sample;   ///< the present one
        DistanceSample at_end;   ///< at the end of the step; taken after a few advances
        Vec3 turn;               ///< rad/s: angular velocity of the normal between the last two samples
        double clear = 0;        ///< s: from the present sample on, certain not to meet for so long
        double uncertified = 0;  ///< fraction of the rest of the step that the next advance without a guarantee covers
        bool touches = false;    ///< the gap is zero within rounding
        bool separates = false;  ///< the gap grows by more than rounding
        bool bracketed = false;  ///< the pair overlaps at the end of the step
    };
    /// The distance between a shape of one body and a shape of the other.
    struct ShapeGap
    {
        const ShapeExtent *shape_a = nullptr, *shape_b = nullptr;
        double gap = 0;  ///< m, lower bound of their distance
        Vec3 normal;     ///< from a to b: the direction along which they are separated by the gap
        Vec3 point_a, point_b;
        bool exact = false;  ///< the gap is the distance of the shapes, and the points are the closest ones
    };
    struct PairAtTime
    {
        std::uint32_t detector;
        Ref a, b;
        double time;  ///< s since the start of the step
        std::uint64_t version;
    };
    /// Whether a body takes part in the present event.
    struct Met
    {
        bool chosen = false;
        bool joined = false;  ///< joints hold it to a body that is hit, or that itself
        Vec3 relief;          ///< m/s^2: if the event stops the body, the change of its acceleration
    };
    /// A pair of bodies of one detector, by index.
    struct PairKey
    {
        std::uint32_t detector, a, b;
        friend auto operator<=>(const PairKey&, const PairKey&) = default;
    };

    // event_locator.cpp
    void collect(const std::vector<FoundContact>& found);
    void consider(const std::vector<FoundContact>& found, std::size_t begin, std::size_t end);
    bool acts(const Detector& detector, const PairState* pair, bool approaching) const;
    std::uint32_t new_slot();
    void push(std::uint32_t slot);
    bool pop(std::uint32_t& slot);
    std::uint64_t version_of(Ref a, Ref b) const;
    std::uint64_t version_of(const Candidate& c) const { return version_of(c.a, c.b); }
    void note_live();
    bool is_live(std::uint32_t detector, Ref a, Ref b) const;
    void scope_of(const Candidate& candidate);
    void close_over_resting_pairs();
    void close_over_forces();
    void process();
    void detect_again(std::vector<FoundContact>& found);
    void note_resting_groups();
    void note_resting_groups_of(const PairState& pair);
    void begin_run();
    void answer_all(std::vector<FoundContact>& found);
    void detect_at_end();
    void find_at_end();
    bool few_are_apart() const;
    void begin_budget();
    double sweeps_and_queries() const;
    double held_bodies() const;
    void answer_the_rest(std::size_t left, std::vector<FoundContact>& found);
    void report_too_many(std::size_t left);
    double overlap_tolerance(Ref a, Ref b) const;

    // event_gather.cpp: which candidates are one event.
    void gather(std::uint32_t first);
    void gather_until(double until, double until_joined);
    void take(std::uint32_t slot, double until);
    void recall_unpressed(Ref stopped, double until);

    // event_candidates.cpp: pairs that may meet anywhere in the piece.
    void begin_motion_bounds();
    void find_near(const IndexSet* among);
    void find_near_rewound();
    void find_near_apart();
    void consider_near(std::uint32_t detector, Ref a, Ref b);
    void detect_pair(const Candidate& candidate, const Vec3& shift, std::vector<FoundContact>& found);
    Mover mover(std::uint32_t body, const BodyState& now) const { return {body, &motions_[body], &extents_[body], now}; }
    void start_pieces(double time);
    void end_pieces();

    // event_shapes.cpp
    double speeds_at(Ref a, const Vec3& point_a, Ref b, const Vec3& point_b) const;
    double smaller_radius(Ref a, Ref b) const;
    double slack_of(Ref a, Ref b, double speed) const;
    bool slides(std::span<const FoundContact> contacts) const;
    bool slides(const Candidate& candidate, const ShapeGap& gap, double time) const;
    Clearance clearance_of(const Candidate& candidate, double left) const;
    Clearance clearance_of(const Candidate& candidate, const ShapeGap& gap, double left) const;
    ShapeGap gap_of_shapes(const Candidate& candidate, const ShapeExtent& shape_a, const ShapeExtent& shape_b, const Vec3& hint) const;
    void list_shape_gaps(const Candidate& candidate, const GapQuery& nearest);
    bool look_over_seam(const Candidate& candidate, GapQuery& query);
    Measured measure(const Candidate& candidate, double time);
    double clear_for(const Candidate& candidate, const DistanceSample& sample, const Vec3& turn, double slack, double& closing) const;
    bool was_clear(const Candidate& candidate, const DistanceSample& clear, const DistanceSample& last) const;

    // event_search.cpp
    void locate(Candidate& candidate);
    void bracket(Candidate& candidate, EventBracket& trial);
    bool overlaps_at(Candidate& candidate, double time);
    double begin_of_scope() const;
    void ask(const Candidate& candidate, EventBracket& trial);
    void search(Candidate& candidate);
    bool meets(Candidate& candidate);
    std::optional<bool> decide_now(Candidate& candidate, Advancement& a);
    void extend_uncertified(Advancement& a) const;
    void fill_trial(const Candidate& candidate, Advancement& a);
    std::optional<bool> choose_time(Candidate& candidate, Advancement& a);
    DistanceSample sample_at(const Candidate& candidate, double time);
    void scope_of_pair(const Candidate& candidate);
    static Vec3 turn_between(const DistanceSample& first, const DistanceSample& then);
    bool settle_in_bracket(Candidate& candidate, const DistanceSample& clear, const DistanceSample& over, bool certify);
    bool found_when_given_up(Candidate& candidate, const DistanceSample& sample);

    // event_touching.cpp: pairs that touch where their search begins.
    bool settle_at_begin(Candidate& candidate, const DistanceSample& sample);
    bool answered_at(const Candidate& candidate, double time) const;
    void accelerations_at_contacts(const Candidate& candidate, double time);
    bool presses(Candidate& candidate, const DistanceSample& sample);
    void find_touching(const Candidate& candidate);
    bool meets_at_begin(Candidate& candidate, double begin);

    // event_answer.cpp
    void advance_group(std::uint32_t group, double time, WorkBook book, bool trial);
    void advance_scope(double time, WorkBook book, bool trial);
    void move_scope(double time, WorkBook book, bool trial);
    double rounding_of(Ref a, Ref b) const;
    void advance_groups_to(double time);
    void go_on(double time);
    void suppress_resting_bounce(std::vector<FoundContact>& contacts) const;
    void keep_if_it_cannot_leave(Contact& c) const;
    void keep_if_it_would_sink(Contact& c) const;
    void answer();
    void log_impact(double time);
    void complete(Candidate& candidate);
    void contacts_from_clear_side(Candidate& candidate);
    void rate_of_approach(std::vector<FoundContact>& contacts, double at, WorkBook book);
    bool stop_bouncing(const Candidate& candidate, double time, double& ends);
    void record_answered(Candidate& candidate, double time);
    void record(Candidate& candidate, const std::vector<FoundContact>& contacts, double time);
    void announce_rest(const FoundContact& f, PairState& pair);
    void note_paradoxes();

    // event_joints.cpp: impacts of bodies that joints hold.
    struct Jointed
    {
        struct Speeds
        {
            std::vector<Vec3> velocity, spin, momentum;  ///< parallel to `bodies`
            std::vector<double> shaft;                   ///< parallel to `shafts`
        };
        std::vector<std::uint32_t> groups, bodies, shafts;
        Speeds start;                ///< before an impulse for trial
        std::vector<Vec3> before;    ///< m/s, W: of the contacts then
        double speed = 0;            ///< m/s: the largest of these
        std::vector<Mat3> mobility;  ///< W of event_joints.cpp
    };
    bool find_jointed();
    void respond(double time);
    bool respond_once(std::uint32_t detector, double time);
    void keep(Jointed::Speeds& speeds) const;
    void put(const Jointed::Speeds& speeds);
    void join(double time, WorkBook book);
    void join_group(std::uint32_t group, double time, WorkBook book);
    double closing() const;
    Vec3 relative_velocity(const Contact& contact) const;
    void apply_impulse(const Contact& contact, const Vec3& impulse);
    void find_column(std::size_t contact, const Vec3& axis, double time);
    std::span<const Mat3> find_mobility(double time);

    StepState& step_;
    GroupMotion& motion_;
    ContactBook& contacts_;
    ContactForces& forces_;
    Advance& advance_;
    std::vector<Candidate> candidates_;  ///< slots
    std::vector<std::uint32_t> free_;
    std::vector<Entry> queue_;                     ///< heap, earliest event on top
    std::vector<std::uint64_t> versions_;          ///< by group: number of its present smooth piece within the step
    std::vector<std::uint32_t> chosen_;            ///< slots that are answered together
    std::vector<std::uint32_t> set_aside_;         ///< slots
    std::vector<std::uint32_t> scope_;             ///< groups that are rewound, ascending
    std::vector<std::uint32_t> left_, kinematic_;  ///< scratch of move_scope()
    std::vector<std::uint32_t> resting_places_;    ///< of the persistent pairs in a scope
    std::vector<std::uint8_t> flags_;              ///< by group, scratch
    IndexSet in_scope_;                            ///< groups, while a scope is collected
    std::vector<std::uint32_t> disturbed_;         ///< groups of the last answer's pairs, and what rests on them
    std::vector<std::uint8_t> rests_;              ///< by group: it takes part in a persistent contact
    bool any_rests_ = false;                       ///< a group in the scope of the present answer takes part in a persistent contact
    bool rewound_ = false;                         ///< the last answer rewound groups
    bool answers_at_end_ = false;                  ///< the work budget is spent: nothing is located any more
    WorkBudget budget_;
    std::vector<PairKey> live_;              ///< pairs in the queue, sorted
    std::vector<ShapeGap> shape_gaps_;       ///< of the last distance query, if a body has several shapes
    std::vector<FoundContact> pressed_;      ///< one contact
    std::vector<PairAtTime> unpressed_;      ///< they touched at the time while no force pressed them together
    std::vector<PairAtTime> met_at_begin_;   ///< answered in this step at a time at which their piece began
    std::vector<Met> met_;                   ///< by body; reset outside gather()
    std::vector<std::uint32_t> met_bodies_;  ///< the bodies that take part in the present event
    DisjointSets left_islands_;
    bool any_certifies_ = false, all_certify_ = false;
    bool any_at_end_ = false;    ///< a detector looks for impacts where the step ends
    bool all_spare_ = false;     ///< all that locate spare crowds, and there are some
    bool any_persists_ = false;  ///< a detector has pairs that a manager holds as soon as they touch
    bool found_ = false;         ///< the contacts at the end of the step are known, at the positions that bodies have there
    bool pushed_since_ = false;  ///< but they were found before an answer at the end of the step changed velocities

    Jointed jointed_;
    std::vector<MotionBound> motions_;   ///< by body
    std::vector<BodyExtent> extents_;    ///< by body
    std::vector<double> motion_margin_;  ///< m, by body: how far its AABB is expanded by its motion
    IndexSet active_;                    ///< bodies of which pairs are detected
    std::vector<NearCollector::Pair> near_;
    struct Accelerated
    {
        std::uint32_t body;
        Vec3 linear, spin_up;
    };
    std::vector<Accelerated> accelerated_;
    struct Stopped
    {
        std::uint32_t slot;
        double ends;
        double stays;  ///< m/s: a pair that separates more slowly than this stays in contact
    };
    std::vector<Stopped> stopped_;       ///< those of the chosen pairs that have bounced for the last time
    double rest_time_ = 0;               ///< s, time at which the pair that is being recorded comes to rest
    std::vector<std::uint8_t> paradox_;  ///< parallel to impact_: not an impact, but the answer to Painleve's paradox
    bool meets_force_contact_ = false;
    std::vector<FoundContact> seen_, impact_, at_end_, part_;
};

}  // namespace plab::simulation
