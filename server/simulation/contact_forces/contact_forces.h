/// Force contacts (responses `by_force`): springs and dampers such as Response/Penalty, integrated by the solver of the bodies.
///
/// A contact force has a kink where the contact begins: it is zero before and rises after it. An integrator of order p keeps its order only
/// if the right-hand side is smooth over each of its steps. Two measures achieve that:
///
/// 1. Switching events. The step is divided into pieces, and within a piece the set of contact points that push is fixed. After each piece
///    the contacts are detected: if a point has begun to overlap, a pushing point has opened, or a damper has become slack (it would have
///    to pull, so its law gives no force), the piece is undone, the time of the first such switch is located by inverse cubic
///    interpolation of the depth with bisection as a safeguard, and the piece is repeated up to that time. There the set changes.
/// 2. Piece length. A stiff contact may last much shorter than a step. The largest frequency or decay rate of all pushing contacts is
///    bounded by Gershgorin's theorem, and a piece is pi / (rate * steps_per_contact) long, so that half a period gets that many pieces.
///    As an oscillation decays, fewer pieces give the same error. max_substeps limits their number; if more would be needed, pieces
///    become longer and the event contact.stiff warns.
/// While nothing pushes, a piece is as long as no body can pass through another one unnoticed.
///
/// At every stage of the solver the contacts are detected again and the law is evaluated. Each contact point has a tangential (stiction)
/// spring, whose stretch is its value at the start of the piece plus the relative displacement since then; it is committed once a piece
/// is finished, so rejected trials leave no trace.
///
/// Groups whose bodies may touch by force within the step advance together as an island. An island that contains persistent hard
/// contacts as well is advanced by the time stepping of those, with the springs as forces (contact_force_advance.cpp).
///
/// Sources: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.6 (discontinuous right-hand sides: locate the switch and
/// restart there); Cundall, Strack, Geotechnique 29 (1979) (contacts as springs and dampers with a tangential history).
#pragma once

#include <cmath>
#include <vector>

#include "simulation/contact_forces/contact_force_probe.h"
#include "simulation/contacts/hard_contacts.h"

namespace plab::simulation
{

class ContactForces final : public ExtraForces, public GroupMemory
{
public:
    ContactForces(StepState& step, GroupMotion& motion, ContactBook& contacts, HardContacts& hard)
        : step_(step), motion_(motion), contacts_(contacts), hard_(hard)
    {
    }

    /// To be called after any structural change. Converts contacts from hard to soft and back if a response was exchanged.
    void rebuild();
    /// Whether any detector's contacts are forces.
    bool any() const { return any_; }
    /// Whether anything may touch by force in this step; after begin_step.
    bool any_near() const { return !near_.empty(); }
    /// Finds the pairs that may meet within the step.
    void begin_step();

    /// Takes the groups that may touch by force between `from` and `to` (s) out of `smooth` and `in_contact`; advance() moves them.
    void take(std::span<const std::uint32_t> groups, std::vector<std::uint32_t>& smooth, std::vector<std::uint32_t>& in_contact,
              double from, double to);
    /// Advances the groups that take() took. `observed`: groups whose state they read; the caller restores those.
    void advance(std::span<const std::uint32_t> observed, double from, double to, WorkBook book, bool trial);
    /// Adds the contact forces at the present state to this system of one or more groups.
    void attach(GroupSystem& system, std::span<const std::uint32_t> groups);
    /// Flags groups that may touch another one by force.
    void flag_near(std::vector<std::uint8_t>& groups) const;
    /// Flags all groups that may push a flagged group. True if that flagged any.
    bool close_over(std::vector<std::uint8_t>& groups) const;
    /// Number of contact points that were converted from hard to soft or back when the structure was rebuilt last, for a detector or
    /// response component.
    std::size_t converted(std::uint32_t component) const;
    /// Finishes the step: emits events, evaluates outputs, and fills the forces into the found contacts.
    void finish_step(std::vector<FoundContact>& found);

    // The state of contacts is rewound and restored with that of their groups.
    void rewind(std::uint32_t group) override
    {
        if (any_) transfer(segment_, live_, group);
    }
    void save_segment(std::uint32_t group) override
    {
        if (any_) transfer(live_, segment_, group);
    }
    void save_end(std::uint32_t group) override
    {
        if (any_) transfer(live_, end_, group);
    }
    void restore_end(std::uint32_t group) override
    {
        if (any_) transfer(end_, live_, group);
    }
    void save_ends() override
    {
        if (any_) end_ = live_;
    }

    void add(const StepContext& context, Wrenches& wrenches) override;
    bool is_undersampled() const override { return undersampled_; }
    void join(DisjointSets& groups) const override;
    void book(const StepContext& context, std::vector<double>& work, std::vector<double>& power, double share) override;

private:
    /// Two bodies that may meet by force within the step.
    struct NearPair
    {
        std::uint32_t detector = 0;  ///< index
        Ref a, b;
    };
    struct Island
    {
        std::vector<std::uint32_t> groups, observed;
        std::vector<std::uint32_t> near;  ///< indices in near_
        bool mixed = false;
    };
    /// A detected contact with its separation speed.
    struct Seen
    {
        FoundContact found;
        double separation_speed = 0;  ///< m/s
    };
    /// The pose of a body at the start of the present piece.
    struct Anchor
    {
        Vec3 position;
        Quat orientation;
    };
    /// A contact point that pushes now.
    struct Pushing
    {
        std::uint32_t pair = 0, contact = 0;  ///< in live_
    };
    /// A pushing point that touches with another feature than before: it, and its place among the contacts of the pair.
    struct Renamed
    {
        ForceContact* known = nullptr;
        std::size_t place = 0;
    };
    struct FastestRates
    {
        double swing = 0;  ///< rad/s
        double decay = 0;  ///< 1/s
    };
    struct Piece
    {
        GroupSystem* system = nullptr;
        std::uint32_t solver = kNoIndex;
        double begin = 0, end = 0;  ///< of the advance
        double t = 0;
        WorkBook book;
        bool trial = false;
        int events = 0, pieces = 0;
        bool finite = true;
    };

    // contact_forces.cpp
    void transfer(const ForceState& from, ForceState& to, std::uint32_t group);
    bool involves(Ref a, Ref b, std::uint32_t group) const;
    void make_room();
    void find_near();
    void fill_motion_margins(double h);
    void spread_motion_margins();
    bool raise_motion_margins();
    void level_motion_margins();
    bool within_motion_margins(std::span<const std::uint32_t> groups, double h) const;
    void add_near(std::uint32_t detector, Ref a, Ref b);
    bool dynamic(Ref r) const;
    double speed_of(Ref r) const;
    double positions_of(Ref a, Ref b) const;

    // contact_force_islands.cpp
    void join_near(std::span<const std::uint32_t> groups);
    void make_islands(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> in_contact);
    bool claims(std::uint32_t group);
    void borrow(const Island& island);
    void give_back();
    void merge_returned();
    void collect_observed(Island& island, std::span<const std::uint32_t> observed);
    std::uint32_t solver_of(const Island& island) const;
    void advance_beside(const Island& island, double from, double to, WorkBook book, bool trial);

    // contact_force_swap.cpp
    void convert_contacts();
    void read_laws();
    void soft_to_hard(const ForcePair& pair, std::uint32_t detector);
    void soft_to_soft(const ForcePair& pair, std::uint32_t detector);
    void hard_to_soft(const PairState& pair, std::uint32_t detector);
    ForcePair remember_or_soften(const PairState& pair, std::uint32_t detector);
    PairState harden(const ForcePair& pair, const Detector& detector);
    ForcePair soften(const PairState& pair, std::uint32_t detector);
    bool soften_contact(const KnownContact& hard, const FoundContact& at, ForceContact& soft);

    // contact_force_stage.cpp
    void bind(std::span<const std::uint32_t> groups);
    void bind(const Island& island);
    void list_bodies();
    void list_pushing();
    void anchor();
    /// The only pushing point of the pair that is not among `count` contacts, if just one of these overlaps without being known, about as
    /// deep. So the same place stays one contact when its feature changes, as where the end of a capsule that is nearly upright counts as
    /// nearest point or as corner: between two pieces it would lose and gain a spring, within one its force.
    template <class ContactOf>
    Renamed find_renamed(ForcePair& pair, std::size_t count, ContactOf contact_of) const
    {
        Renamed out;
        std::size_t strangers = 0, lost = 0, there = 0;  // bits by contact
        for (std::size_t k = 0; k < count; ++k)
        {
            const Contact& c = contact_of(k);
            if (const ForceContact* known = pair.find(c.feature))
                there |= std::size_t{1} << (known - pair.contacts.data());
            else if (c.depth > 0)
                ++strangers, out.place = k;
        }
        if (strangers != 1) return {};
        for (std::uint32_t i = 0; i < pair.count; ++i)
            if ((there >> i & 1) == 0 && !pair.contacts[i].dormant) ++lost, out.known = &pair.contacts[i];
        const bool is_it = lost == 1 && std::fabs(contact_of(out.place).depth - out.known->depth) <= margin_;
        return is_it ? out : Renamed{};
    }
    void detect(std::uint32_t detector, std::span<const PersistentPair> pairs, double margin, std::vector<FoundContact>& out);
    void inspect(double margin, std::vector<Seen>& out);
    void fill_surface(FoundContact& found) const;
    void detect_pushing();
    void match(bool extrapolate);
    void add_match(std::size_t i, ForceContact& known, bool extrapolate);
    Vec3 moved_along(const FoundContact& f) const;
    ForceContact* find_known(const FoundContact& f);
    ForceContact* find_pushing(const FoundContact& f);
    bool precedes(const ForcePair& x, const ForcePair& y) const;
    std::vector<ForcePair>::iterator place_of(std::vector<ForcePair>& pairs, std::uint32_t detector, Ref a, Ref b);
    ForcePair* find_pair(std::uint32_t detector, Ref a, Ref b);
    bool is_advanced(const StepContext& context, const Contact& c) const;
    void clear_scratch();
    void run_laws(const StepContext& context, Wrenches& wrenches);
    void evaluate_laws();
    bool any_slack_change() const;
    void commit(double t, double h);

    // contact_force_switch.cpp
    const Seen* find_seen(const std::vector<Seen>& list, const FoundContact& f) const;
    double rounding(const Contact& c) const;
    bool switches(const Seen& seen, const std::vector<Seen>& before);
    bool has_switched(const std::vector<Seen>& now);
    bool any_switch(const std::vector<Seen>& before, const std::vector<Seen>& after);
    double guess(double low, double high, const std::vector<Seen>& at_low, const std::vector<Seen>& at_high);
    bool is_there(const std::vector<Seen>& now, const std::vector<Seen>& beyond);
    void switch_contacts(const std::vector<Seen>& seen, double t, double h);
    void begin_contact(const Seen& seen, double time);
    double take_over(ForcePair& pair, const FoundContact& at);
    double stored_in(const ForcePair& pair, const ForceContact& known, double h);
    void let_go(const Seen& seen, ForcePair& pair, double time);
    void follow_dormant(const Seen& seen, ForceContact& known, double time);
    void drop_dormant(const std::vector<Seen>& seen);
    void end_contact(ForcePair& pair, const Contact& at, double time);
    void drop_ended(double time);
    void rename_points(const std::vector<Seen>& seen);
    void expect(ForceContact& known, const FoundContact& at, double closing);
    void list_gone(const std::vector<Seen>& seen, double h);
    void end_gone(double time);
    void report(ContactForceEvent::Kind kind, const ForcePair& pair, const Contact& at, const Vec3& impulse, double time);
    void report_impact_once(const ForcePair& pair, ForceContact& contact, const Contact& at, double time);

    // contact_force_advance.cpp
    void advance_island(const Island& island, double from, double to, WorkBook book, bool trial);
    void advance_mixed(const Island& island, double from, double to, WorkBook book, bool trial);
    void start(double from);
    bool run(Piece& piece, double to, WorkBook book, bool trial);
    void one_piece(Piece& piece);
    double locate(Piece& piece, double high);
    double next_time(const Piece& piece);
    double contact_time(double left, int used);
    double pieces_per_contact(const ForceContact& contact, double wanted) const;
    double free_time(double most) const;
    double time_through(const NearPair& pair) const;
    FastestRates fastest_rates();
    double spin_rate() const;
    double closing_bound(const NearPair& pair) const;
    double margin_for(double h) const;
    void save(const GroupSystem& system);
    void restore(const GroupSystem& system);

    // contact_force_finish.cpp
    void report(std::vector<FoundContact>& found);
    void run_outputs(std::vector<FoundContact>& found);
    void log_contacts(const std::vector<FoundContact>& found);
    void emit_events();
    void emit_stiff();

    StepState& step_;
    GroupMotion& motion_;
    ContactBook& contacts_;
    HardContacts& hard_;
    bool any_ = false;
    std::vector<std::uint8_t> by_force_;  ///< by detector
    /// Of the whole scene; while an island is advanced only what it has borrowed from `scene_`, so that its pieces cost what it has.
    ForceState live_;
    ForceState scene_, segment_, end_;
    std::vector<std::uint32_t> borrowed_;  ///< in scene_.pairs: those of the island that is being advanced
    std::vector<std::uint8_t> gone_back_;  ///< by pair of scene_: 1 if `returned_` has it, or its end
    std::vector<ForcePair> returned_;      ///< pairs of islands in which pairs have begun or ended
    std::vector<std::uint32_t> order_of_returned_;
    std::vector<ForcePair> merged_;
    std::vector<NearPair> near_;
    std::vector<double> motion_margin_;  ///< m, by body, for the whole step: expansion of its AABB

    std::vector<Island> islands_;
    std::size_t island_count_ = 0;
    std::vector<std::uint8_t> member_, bound_;  ///< by group
    std::vector<std::uint32_t> island_of_;      ///< by first group of a set
    IndexSet known_;                            ///< groups
    DisjointSets sets_;

    // State of the island that is being advanced.
    std::vector<NearPair> pairs_;
    std::vector<Pushing> pushing_;
    IndexSet bodies_;              ///< bodies of pairs_
    std::vector<Anchor> anchors_;  ///< by body; valid for bodies_
    double margin_ = 0;            ///< m: gaps up to this are detected within a piece
    int order_ = 1;                ///< order of the solver
    double memory_ = 1;            ///< half periods in which the speed amplitude of an oscillation is forgotten
    bool taken_ = false;           ///< the forces of this piece of a mixed island have been evaluated
    double time_ahead_ = 0;        ///< s: how far ahead of the state springs are evaluated (mixed islands)
    std::vector<PersistentPair> persistent_;
    std::vector<FoundContact> found_;
    std::vector<std::pair<std::size_t, ForceContact*>> matched_;  ///< index in found_, and the known contact
    std::vector<Contact> law_contacts_;
    std::vector<Seen> at_start_, at_end_, at_trial_, at_low_, at_high_;
    std::vector<std::uint64_t> gone_, there_;  ///< ids of contacts
    ForceState before_;
    world::MotionMemento memento_, observed_memento_;
    Wrenches scratch_;
    ForceProbe probe_;
    std::vector<NearCollector::Pair> near_found_;
    std::array<std::vector<double>, 3> sums_;  ///< by body, of ContactRates: normal, tangential, damping
    double pieces_needed_ = 0;                 ///< largest number of pieces that an island asked for beyond max_substeps in this step
    std::uint32_t stiff_ = kNoIndex;           ///< the response that asked for them
    bool undersampled_ = false;                ///< the present piece is longer than steps_per_contact asks for
    std::vector<std::size_t> converted_;       ///< contact points, by detector
    struct Law
    {
        std::uint64_t type = 0, values = 0;
    };
    std::vector<Law> laws_;             ///< by detector; see ForcePair
    std::vector<SurfaceLaw> surfaces_;  ///< by detector, in this step
    std::size_t last_pair_ = 0;         ///< index that find_pair found last: pairs are usually looked up in order
};

}  // namespace plab::simulation
