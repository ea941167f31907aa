/// Finds the first contact event inside a step, rewinds whom it touches, lets the response act, and goes on.
///
/// Local scope: only the groups of the pair (and what rests on them) go back; everybody else keeps its end-of-step state,
/// bit for bit. World scope, the paper's: everything goes back. Each group remembers where its present smooth piece began.
///
/// Candidates stand in a queue by time. Those of resolutions that look at the end of the step only are pairs that overlap
/// there; those of resolutions that certify are pairs that may meet anywhere in the piece, and their time is at first a
/// bound: nothing happens before. Only the first of the queue is looked at more closely.
#pragma once

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
    /// Until the step holds no event any more. Leaves the contacts of the end of the step in `found`.
    void run(std::vector<FoundContact>& found);

private:
    struct Candidate
    {
        std::uint32_t detector = 0;
        Ref a, b;
        std::uint64_t version = 0;  ///< of both groups, when it was made: later it is stale
        bool certified = false;     ///< located by looking inside the step
        bool located = false;
        bool nothing = false;                ///< located: they do not meet
        bool stuck = false;                  ///< overlaps where the piece begins: there is nothing to bracket
        bool at_end = false;                 ///< no event location: answered where the step ends
        bool pressed = false;                ///< located: it touches without closing, and is pressed together
        Vec3 relief;                         ///< m/s^2, where it is pressed: by how much b, held, falls less towards a
        double ignored = 0;                  ///< m: overlaps up to this are what it slides along
        double bracket = 0;                  ///< s between the last clear and the first overlapping trial
        double time = 0;                     ///< s since the start of the step, on the clear side; a bound until located
        std::vector<FoundContact> contacts;  ///< as seen on the overlapping side
    };
    /// Ties go by the order of ids.
    struct Entry
    {
        double time;
        std::uint32_t detector_rank, a_rank, b_rank;
        std::uint32_t slot;
        bool operator<(const Entry& other) const;
    };
    /// One look at a pair at one time.
    struct DistanceSample
    {
        double time = 0;
        GapQuery query;
        double rate = 0;         ///< m/s, of the gap
        double speed = 0;        ///< m/s, size of the speeds that the rate is a difference of
        double contact_gap = 0;  ///< m: gaps up to this are none
        double slack = 0;        ///< m: what touches and sinks no deeper than this in the rest of the step is no event
    };
    /// A shape of one body and one of the other.
    struct ShapeGap
    {
        const ShapeExtent *shape_a = nullptr, *shape_b = nullptr;
        double gap = 0;  ///< m: they are no nearer than this
        Vec3 normal;     ///< from a to b: the direction in which they are so far apart
        Vec3 point_a, point_b;
        bool exact = false;  ///< the gap is that of the shapes, and the points are the nearest ones
    };
    /// A pair that touched at `time`, and that nothing pressed together then.
    struct UnpressedPair
    {
        std::uint32_t detector;
        Ref a, b;
        double time;
        std::uint64_t version;
    };
    /// A body of the present event.
    struct Met
    {
        bool chosen = false;
        Vec3 relief;  ///< m/s^2: by how much the event changes what forces do to it, where it stops it
    };
    /// A pair of one detector, by number.
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
    void scope_of(const Candidate& candidate, bool local);
    void close_over_resting_pairs();
    void gather(std::uint32_t first);
    void gather_until(double until);
    void take(std::uint32_t slot, double until);
    void recall_unpressed(Ref stopped, double until);
    void process();
    void detect_again(std::vector<FoundContact>& found);
    void note_resting_groups();
    void begin_budget();
    double sweeps_and_queries() const;
    void answer_the_rest(std::size_t left, std::vector<FoundContact>& found);
    void tell_too_many(std::size_t left);
    double overlap_tolerance(Ref a, Ref b) const;

    // event_courses.cpp: pairs that may meet anywhere in the piece.
    void begin_motion_bounds();
    void find_near(bool only_rewound);
    void consider_near(std::uint32_t detector, Ref a, Ref b);
    void detect_pair(const Candidate& candidate, const Vec3& shift, std::vector<FoundContact>& found);
    void query_known_pairs(std::vector<FoundContact>& found);
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
    GapQuery measure(const Candidate& candidate, double time);
    double clear_for(const Candidate& candidate, const DistanceSample& sample, const Vec3& turn, double slack, double& closing) const;
    bool was_clear(const Candidate& candidate, const DistanceSample& clear, const DistanceSample& last) const;

    // event_search.cpp
    void locate(Candidate& candidate);
    void bracket(Candidate& candidate, Trial& trial);
    bool overlaps_at(Candidate& candidate, double time);
    double begin_of_scope() const;
    void ask(const Candidate& candidate, Trial& trial);
    void search(Candidate& candidate);
    bool meets(Candidate& candidate);
    bool answered_at(const Candidate& candidate, double time) const;
    DistanceSample sample_at(const Candidate& candidate, double time);
    bool presses(Candidate& candidate, const DistanceSample& sample);
    void scope_of_pair(const Candidate& candidate);
    static Vec3 turn_between(const DistanceSample& first, const DistanceSample& then);
    bool settle_in_bracket(Candidate& candidate, const DistanceSample& clear, const DistanceSample& over, bool certify);
    bool settle_at_begin(Candidate& candidate, const DistanceSample& sample);
    bool found_when_given_up(Candidate& candidate, const DistanceSample& sample);

    // event_answer.cpp
    void advance_group(std::uint32_t group, double time, WorkBook book, bool trial);
    void advance_scope(double time, WorkBook book, bool trial);
    void move_scope(double time, WorkBook book, bool trial);
    double rounding_of(Ref a, Ref b) const;
    void advance_groups_to(double time);
    void go_on(double time);
    void suppress_resting_bounce(std::vector<FoundContact>& contacts) const;
    void keep_if_it_cannot_leave(Contact& c) const;
    void answer();
    void complete(Candidate& candidate);
    void contacts_from_clear_side(Candidate& candidate);
    void rate_of_approach(std::vector<FoundContact>& contacts, double at);
    bool stop_bouncing(const Candidate& candidate, double time, double& ends);
    void record_answered(Candidate& candidate, double time);
    void record(Candidate& candidate, const std::vector<FoundContact>& contacts, double time);
    void announce_rest(const FoundContact& f, PairState& pair);
    void note_paradoxes();

    // event_joints.cpp: impacts of who is held by joints.
    bool find_jointed();
    void respond(double time);
    void note_who_rests();
    void join(double time);
    double closing() const;
    void compress(double time);
    void compress_once(double time);
    void add_impulses(double share, bool of_all);
    void give_back(double time);

    StepState& step_;
    GroupMotion& motion_;
    ContactBook& contacts_;
    ContactForces& forces_;
    Advance& advance_;
    std::vector<Candidate> candidates_;  ///< slots
    std::vector<std::uint32_t> free_;
    std::vector<Entry> queue_;                      ///< heap, first event on top
    std::vector<std::uint64_t> versions_;           ///< by group: counts the pieces of the step
    std::vector<std::uint32_t> chosen_;             ///< slots answered together
    std::vector<std::uint32_t> set_aside_;          ///< slots
    std::vector<std::uint32_t> scope_;              ///< groups that go back, ascending
    std::vector<std::uint8_t> in_scope_, rewound_;  ///< by group; touched: reached by the last answer's impulses
    std::vector<std::uint8_t> rests_;               ///< by group: something stands on it or it on something that moves
    bool stands_ = false;                           ///< somebody in the scope of the present answer rests on something
    bool rewound_ = false;                          ///< the last answer moved somebody
    bool answers_at_end_ = false;                   ///< the budget is spent: nothing is located any more
    WorkBudget budget_;
    std::vector<PairKey> live_;          ///< pairs in the queue, sorted
    std::vector<ShapeGap> shape_gaps_;   ///< of the last look, where a body has several shapes
    std::vector<FoundContact> pressed_;  ///< one contact
    std::vector<UnpressedPair> unpressed_;
    std::vector<Met> met_;                   ///< by body; nobody is outside gather()
    std::vector<std::uint32_t> met_bodies_;  ///< those that are
    DisjointSets left_islands_;
    bool any_certifies_ = false, all_certify_ = false;

    struct Jointed
    {
        std::vector<std::uint32_t> groups, bodies, shafts;
        std::vector<Vec3> velocity, spin, momentum;  ///< beside bodies
        std::vector<double> speed;                   ///< beside shafts
        std::vector<double> restitution;             ///< beside the contacts
        std::vector<std::uint8_t> rests;
        std::vector<Vec3> impulse, last;  ///< N s: so far; by the last answer
    };
    Jointed jointed_;
    std::vector<MotionBound> motions_;   ///< by body
    std::vector<BodyExtent> extents_;    ///< by body
    std::vector<double> motion_margin_;  ///< m, by body
    std::vector<std::uint8_t> active_;   ///< by body
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
        double stays;  ///< m/s: slower than this it does not leave
    };
    std::vector<Stopped> stopped_;       ///< of the chosen ones: those that have bounced for the last time
    double rest_time_ = 0;               ///< s, when the pair being recorded comes to rest
    std::vector<std::uint8_t> paradox_;  ///< beside impact_: no impact, but the answer to Painleve's paradox
    bool meets_force_contact_ = false;
    std::vector<PersistentPair> persistent_;
    std::vector<FoundContact> seen_, impact_, at_end_;
};

}  // namespace plab::simulation
