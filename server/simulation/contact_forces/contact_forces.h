/// Contacts that are forces (responses `by_force`): found and evaluated at every solver stage, in as many pieces of the
/// step as their fastest rate asks for, and only while something touches.
///
/// Which contact points push is fixed within a piece, so that what the solver sees is smooth and its order is kept. The times
/// at which a point begins and ceases to push are located, and a piece ends there. Groups whose bodies may meet by force
/// within the step advance together, as an island; an island that holds standing hard contacts too is advanced by their
/// time stepping, with the springs as forces (contact_force_advance.cpp).
#pragma once

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

    /// After any structural change. Contacts go over from hard to soft and back where a response was exchanged.
    void rebuild();
    /// Whether any detector's contacts are forces.
    bool any() const { return any_; }
    /// Whether anything may touch by force in this step; after begin_step.
    bool may_touch() const { return !near_.empty(); }
    /// Looks who may meet within the step.
    void begin_step();

    /// Takes out of `smooth` and `in_contact` the groups that may touch by force between `from` and `to`; all are advanced
    /// from there by advance().
    void take(std::span<const std::uint32_t> groups, std::vector<std::uint32_t>& smooth, std::vector<std::uint32_t>& in_contact,
              double from, double to);
    /// Advances what take() took. `shadows`: whom the groups read, and who is brought back by the caller.
    void advance(std::span<const std::uint32_t> observed, double from, double to, WorkBook book, bool trial);
    /// Springs push in this system of one or more groups from now on, at the present state.
    void attach(GroupSystem& system, std::span<const std::uint32_t> groups);
    /// Flags groups that may touch another one by force.
    void flag_near(std::vector<std::uint8_t>& groups) const;
    /// Whoever may push a group that is flagged is flagged too. True if that flagged somebody.
    bool close_over(std::vector<std::uint8_t>& groups) const;
    /// How many contact points went over from hard to soft or back when the structure was rebuilt last, by detector
    /// component or response component.
    std::size_t converted(std::uint32_t component) const;
    /// Of the end of the step: events, outputs, and what is reported with found contacts.
    void finish_step(std::vector<FoundContact>& found);

    // Contacts go back and forth with a group.
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
        bool mixed = false;
    };
    /// A contact as found, with its speed of parting.
    struct Seen
    {
        FoundContact found;
        double separation_speed = 0;  ///< m/s
    };
    /// A body where the present piece began.
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
    bool touches(Ref a, Ref b, std::uint32_t group) const;
    void make_room();
    void find_near();
    void fill_motion_margins(double h);
    void spread_motion_margins();
    bool raise_motion_margins();
    void level_motion_margins();
    bool within_motion_margins(std::span<const std::uint32_t> groups, double h) const;
    void add_near(std::uint32_t detector, Ref a, Ref b);
    void make_islands(std::span<const std::uint32_t> groups);
    void collect_observed(Island& island, std::span<const std::uint32_t> observed);
    std::uint32_t solver_of(const Island& island) const;
    bool dynamic(Ref r) const;
    double speed_of(Ref r) const;
    double positions_of(Ref a, Ref b) const;

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
    void list_pushing();
    void anchor();
    void detect(std::uint32_t detector, std::span<const PersistentPair> pairs, double margin, std::vector<FoundContact>& out);
    void inspect(double margin, std::vector<Seen>& out);
    void fill_surface(FoundContact& found) const;
    void gather(bool lead);
    Vec3 moved_along(const FoundContact& f) const;
    ForceContact* find_known(const FoundContact& f);
    ForceContact* find_pushing(const FoundContact& f);
    std::vector<ForcePair>::iterator place_of(std::uint32_t detector, Ref a, Ref b);
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
    void switch_contacts(const std::vector<Seen>& seen, double t);
    void begin_contact(const Seen& seen, double time);
    void let_go(const Seen& seen, ForcePair& pair, double time);
    void follow_dormant(const Seen& seen, ForceContact& known, double time);
    void drop_dormant(const std::vector<Seen>& seen);
    void end_contact(ForcePair& pair, const Contact& at, double time);
    void drop_ended(double time);
    void expect(ForceContact& known, const FoundContact& at, double closing);
    void list_gone(const std::vector<Seen>& seen);
    void end_gone(double time);
    void tell(ForceHappening::Kind kind, const ForcePair& pair, const Contact& at, const Vec3& impulse, double time);
    void tell_impact_once(const ForcePair& pair, ForceContact& contact, const Contact& at, double time);

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
    double fastest_rate();
    double spin_rate() const;
    double closing_bound(const NearPair& pair) const;
    double margin_for(double h) const;
    double number(std::uint32_t response, const char* name, double otherwise) const;
    void save(const GroupSystem& system);
    void restore(const GroupSystem& system);

    // contact_force_finish.cpp
    void report(std::vector<FoundContact>& found);
    void run_outputs(std::vector<FoundContact>& found);
    void emit_happenings();
    void emit_stiff();

    StepState& step_;
    GroupMotion& motion_;
    ContactBook& contacts_;
    HardContacts& hard_;
    bool any_ = false;
    std::vector<std::uint8_t> by_force_;  ///< by detector
    ForceState live_, segment_, end_;
    std::vector<NearPair> near_;
    std::vector<double> motion_margin_;  ///< m, by body, for the whole step

    std::vector<Island> islands_;
    std::size_t island_count_ = 0;
    std::vector<std::uint8_t> member_, bound_;  ///< by group
    DisjointSets sets_;

    // Of the island that is being advanced.
    std::vector<NearPair> pairs_;
    std::vector<Pushing> pushing_;
    std::vector<std::uint32_t> bodies_;  ///< of pairs_
    std::vector<Anchor> anchors_;        ///< by body, where pushing
    double margin_ = 0;                  ///< m: gaps up to this are looked at within a piece
    int order_ = 1;                      ///< of the solver
    bool taken_ = false;                 ///< the forces of this piece of a mixed island are known
    double lead_ = 0;                    ///< s: how far ahead of the speeds springs are taken (mixed islands)
    std::vector<PersistentPair> persistent_;
    std::vector<FoundContact> found_;
    std::vector<std::pair<std::size_t, ForceContact*>> matched_;  ///< found_ and what is known of it
    std::vector<Contact> law_contacts_;
    std::vector<Seen> at_start_, at_end_, at_trial_, at_low_, at_high_;
    std::vector<std::uint64_t> gone_, there_;  ///< ids of contacts
    ForceState before_;
    world::MotionMemento memento_, observed_memento_;
    Wrenches scratch_;
    ForceProbe probe_;
    std::vector<NearCollector::Pair> near_found_;
    std::array<std::vector<double>, 3> sums_;  ///< by body, of ContactRates: normal, tangential, damping
    double pieces_needed_ = 0;                 ///< the most that a step of an island asked for beyond what it may have
    std::uint32_t stiff_ = kNoIndex;           ///< response that asked
    bool undersampled_ = false;                ///< the present piece is longer than was asked for
    std::vector<std::size_t> converted_;       ///< contact points, by detector
    struct Law
    {
        std::uint64_t type = 0, values = 0;
    };
    std::vector<Law> laws_;             ///< by detector; see ForcePair
    std::vector<SurfaceLaw> surfaces_;  ///< by detector, in this step
    std::size_t last_pair_ = 0;         ///< where find_pair found something last: lists stand in one order
};

}  // namespace plab::simulation
