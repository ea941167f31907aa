/// Islands of persistent contacts that a manager solves: what the manager (Phase::Solve, for example Manager/SoftStep) is given, and what
/// happens to its result.
///
/// A group is a set of objects that interactions such as joints couple. Groups that persistent contacts hold together form one island: all
/// its contacts and joint rows have to be solved at once, as an impulse on one of them changes all others, while different islands are
/// independent. In each step this class
///   1. collects the persistent contacts, from the end of the last step if nothing has moved since, or by a new detection;
///   2. joins groups to islands with disjoint sets, and hands each island its contacts, joint rows and members;
///   3. evaluates the forces once, midway through the advance (GroupSystem::go_midway), where bodies on curved surfaces are put for their
///      contacts as well (midpoint_contacts.h);
///   4. calls the island's manager. The manager decides the order of substeps through IslandMotion: kick() applies the forces for a time h,
///      move() integrates the poses, and in between it solves contacts and rows for impulses;
///   5. books the work in the energy ledger, and keeps the impulses to warm-start the next step.
///
/// The ledger splits the change of kinetic energy into
///   work of forces    F . (distance that the bodies move)
///   work of manager   the rest of the change of kinetic energy
///
/// Sources: Moreau, Unilateral contact and dry friction in finite freedom dynamics (1988), for time stepping with impulses instead of
/// forces; Stewart, Trinkle, IJNME 39 (1996).
#pragma once

#include <memory>
#include <vector>

#include "plab/island.h"
#include "plab/shares.h"
#include "simulation/contacts/contact_book.h"
#include "simulation/contacts/kicked_bodies.h"
#include "simulation/contacts/midpoint_contacts.h"
#include "simulation/motion/group_motion.h"

namespace plab::simulation
{

/// The motion of the bodies of one island, as the manager controls it. Of two kicks without a move in between only the last one counts.
class HeldMotion final : public IslandMotion
{
public:
    /// `members`: indices into system.bodies(); `member_of_body`: by host row, the place in it; of other bodies any number.
    void begin(GroupSystem& system, Bodies& bodies, Shafts& shafts, std::span<const std::uint32_t> members,
               std::span<const std::uint32_t> member_of_body, std::span<const std::uint32_t> roots, std::span<Contact> contacts,
               std::span<ConstraintRow> rows, bool books, Workers& workers);
    void kick(double h) override;
    void move(double h) override;
    void move_mean(double h) override;
    /// m/s: separation speed of a contact's two material points at their present positions.
    double separation_speed(std::size_t contact) const;
    /// m: of a contact, at the start.
    double start_depth(std::size_t contact) const { return arms_.empty() ? contacts_[contact].depth : arms_[contact].depth; }
    void refresh_rows() override;
    bool put_rows_midway(double h) override;
    void refresh_depths() override;

    /// J: work of the forces along the distance that the bodies moved.
    double work_of_forces() const { return worked_; }
    double kinetic_energy();
    /// J: work against the forces by displacements other than the moves, which is position correction. From then on these displacements
    /// count as part of the distance moved.
    double count_corrections();
    /// Mean velocities times time, summed over the moves; one for each member, then one for each root shaft.
    struct Mean
    {
        Vec3 velocity;  ///< m
        Vec3 momentum;  ///< N m s^2, or the spin in B of needles
        double shaft = 0;
    };
    const std::vector<Mean>& means() const { return means_; }
    std::span<const std::uint32_t> members() const { return members_; }

private:
    template <class After>
    void commit(double h, bool mean, const After& after);
    double commit_part(double h, bool mean, std::size_t begin, std::size_t end, double worked);
    double correction_of(std::size_t member);
    Vec3 arm(std::uint32_t body, const Vec3& point) const;
    void find_arms();
    template <class Job>
    void for_fresh_rows(std::span<const ConstraintRow> fresh, const Job& job);
    bool joints_close_a_loop();
    bool row_turns_far(const ConstraintRow& row, const ConstraintRow& midway) const;
    std::uint32_t place_of(Ref participant) const;
    Vec3 moved(std::uint32_t body, const Vec3& arm_B, const Vec3& point) const;
    Quat turned(std::uint32_t body) const;
    Pivot::Of pivot_of(const Contact& contact) const;
    double depth_on_face(std::size_t contact) const;

    GroupSystem* system_ = nullptr;
    Bodies* bodies_ = nullptr;
    Shafts* shafts_ = nullptr;
    std::span<const std::uint32_t> members_, member_of_body_;
    std::span<const std::uint32_t> roots_;  ///< indices into system.roots()
    std::span<Contact> contacts_;
    std::span<ConstraintRow> rows_;
    bool books_ = false;
    bool rows_are_midway_ = false;  ///< or there are none
    Workers* workers_ = nullptr;
    double worked_ = 0, since_start_ = 0;
    KickedBodies kicked_;
    std::vector<double> shaft_before_;
    std::vector<Mean> means_;
    std::vector<Vec3> started_;         ///< m, positions at the start
    std::vector<Quat> started_turned_;  ///< orientations at the start
    struct Arms
    {
        Vec3 a, b;         ///< m, in the bodies' frames, to the contact point or the beginning of its pivot's arm
        double depth = 0;  ///< m, at the start
    };
    std::vector<Arms> arms_;    ///< of the contacts; empty until a manager asks for their depths
    std::vector<double> sums_;  ///< working memory of sum_parts()
    struct Left
    {
        std::uint32_t body = 0;
        Vec3 position;
        Quat orientation;
        Vec3 spin;
    };
    std::vector<Left> left_;  ///< how bodies are at the start, while rows are collected midway
    DisjointSets joined_;
    std::vector<std::uint32_t> place_of_root_;  ///< by host row, the place in roots_; of other shafts any number
};

class HeldIslands
{
public:
    HeldIslands(StepState& step, GroupMotion& motion, ContactBook& contacts)
        : step_(step), motion_(motion), contacts_(contacts), midpoint_(step, contacts)
    {
    }

    /// After any structural change.
    void rebuild();
    /// Whether any contacts or joints are held by managers.
    bool any() const { return any_; }
    /// Some joint rows are one-sided (limits) or have a bounded impulse (motors, friction) in this step, so that only a manager can solve
    /// them.
    bool holds_joints() const { return holds_joints_; }
    bool holds_joints_of(std::uint32_t group) const { return holds_joints_ && yields_[group] != 0; }
    /// At the start of a step: detects the contacts at the present state, unless they are known from the end of the last step, and adds
    /// the pairs that are new. `other_crowds`: what is known may have other persistent pairs (ContactBook::SearchChange).
    void begin_step(bool other_crowds);
    /// Adds pairs that are not known yet, of detectors whose contacts are persistent at once (Detector::persists); reports each as
    /// contact.begin.
    void adopt(std::vector<FoundContact>& found, double time);
    /// The same once more, after the pairs have been brought up to date, if has_passed().
    void adopt_again(std::vector<FoundContact>& found, double time);
    /// Whether the last adopt() left out pairs that pass over a seam.
    bool has_passed() const { return !passed_.empty(); }
    /// At the end of a step, with the pair's contacts: whether it does not touch but may do so within the next step (speculative contact).
    /// A pair that touches for the first time is reported.
    bool keeps_ahead(PairState& pair, bool touches, std::span<const FoundContact> found, double time) const;
    /// Passes the warm-start impulses of contacts that have disappeared on to those that replace them: for corners that lie on one another,
    /// the feature ids change with every small motion. The first `known` contacts of the pair are old.
    void pass_on(PairState& pair, std::uint32_t known, std::span<const FoundContact> found) const;
    /// Notes that the found contacts belong to the present state.
    void note_state();
    /// Notes that they do not serve the next step: contacts are detected otherwise there.
    void forget_state() { known_ = false; }
    /// Whether all bodies are as they were when contacts were detected last.
    bool is_current() const;
    /// Takes the groups that managers advance out of `groups` (ascending). `reached`: these groups and all others of their islands;
    /// `places`: where the cache has the persistent pairs of those.
    void take(std::vector<std::uint32_t>& groups, DisjointSets& islands, std::span<const std::uint32_t> reached,
              std::span<const std::uint32_t> places);
    bool holds_any() const { return !held_.empty(); }
    /// Whether the start of each step is to be noted for the bodies of islands, and the notes, by host row.
    void note_starts(bool on) { starts_.resize(on ? step_.world.host().bodies.size() : 0); }
    std::span<const RestSample> starts() const { return starts_; }
    /// The pairs that were added last.
    std::span<const PairState> fresh() const { return fresh_; }
    /// `begins`: KnownContact::warm_start.
    void advance(std::span<const std::uint32_t> observed, DisjointSets& islands, double from, double to, WorkBook book, bool trial,
                 bool begins);

private:
    struct HeldIsland
    {
        std::uint32_t manager = kNoIndex;  ///< component
        bool has_rows = false;
        bool turns = false;   ///< some body moves along a curved surface
        bool driven = false;  ///< some contact is one of a kinematic body
        bool meets = false;   ///< some contact is an impact
        std::vector<std::uint32_t> groups;
        std::vector<std::uint32_t> members,
            roots;                                  ///< indices into the system's lists
        std::vector<std::uint32_t> bodies, shafts;  ///< host rows
        std::vector<Contact> contact_memory;        ///< keeps its size, as making contacts takes time
        std::span<Contact> contacts;                ///< the first of them
        std::vector<ConstraintRow> rows;
        /// The contacts of a pair, which follow one another.
        struct Run
        {
            PairState* pair = nullptr;
            const FoundContact* found = nullptr;  ///< the first of them
            std::uint32_t first = 0, end = 0;     ///< in `contacts`
            std::uint32_t order = 0;              ///< number of the pair among those of all islands
            bool known = false;                   ///< found by the last detection: the pair knows what is missing
            // Results of passes that threads share:
            double most_depth = 0;    ///< m, largest depth, or gap, of what may have Painleve's paradox
            bool incomplete = false;  ///< the pair does not know all of its contacts yet
            bool released = false;    ///< it pressed in the last step and does so no more
            bool counts_all = false;  ///< ContactBook::Pressing
        };
        std::vector<Run> runs;
        std::span<std::uint32_t> slots;  ///< of each contact: FoundContact::slot
        std::span<std::uint8_t> jams;    ///< of each contact: whether it has Painleve's paradox
        std::span<Vec3> further;         ///< Island::further_impulses
        std::vector<RollingResistance> resistances;
        HeldMotion motion;
        double size = 0;    ///< m, smallest radius of gyration
        double energy = 0;  ///< J, kinetic, when the manager begins
        // What the manager did:
        bool solved = false;
        int iterations = 0;
        double work = 0, created = 0, by_correction = 0;  ///< J

        void clear()
        {
            turns = driven = meets = false;
            groups.clear(), runs.clear();
        }
        std::uint32_t contact_count() const { return runs.empty() ? 0 : runs.back().end; }
        std::span<Contact> of(const Run& run) { return std::span(contacts).subspan(run.first, run.end - run.first); }
    };
    using Run = HeldIsland::Run;
    std::uint32_t manager_of(const PairState& pair) const;
    void collect_contacts(double from, double h, bool begins);
    void list_touching();
    void list_known();
    void add_run(std::span<const FoundContact> found, PairState* pair, bool known);
    void fill(std::span<HeldIsland*> islands, double h, bool begins);
    void fill_run(HeldIsland& island, Run& run, double h, bool begins);
    const SurfaceLaw& law_of(const Run& run) const;
    void find_resistances(HeldIsland& island) const;
    void make_room(std::span<HeldIsland*> islands);
    static void prefetch(const HeldIsland& island, const Run& run);
    bool has_pivot(const HeldIsland& island, const Contact& contact, double h) const;
    static void take_known(Contact& contact, const Contact& found, KnownContact& known, bool begins);
    void make_islands(DisjointSets& islands);
    void set_approach(HeldIsland& island, const GroupSystem& system, double h);
    void find_paradoxes(HeldIsland& island);
    void report_paradoxes(const HeldIsland& island, double time);
    void run(std::span<HeldIsland*> islands, std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed, double from,
             double to, WorkBook book, bool trial);
    void solve(std::span<HeldIsland*> islands, GroupSystem& system, double from, double to, WorkBook book, bool trial);
    void begin(HeldIsland& island, GroupSystem& system, bool books, bool trial);
    Island describe(HeldIsland& island, double from, double to);
    void call_managers(std::span<HeldIsland*> islands, double from, double to, bool trial);
    void call_manager(std::uint32_t manager, double from, double to, bool trial);
    void advance_to_midpoint(std::span<HeldIsland*> islands, GroupSystem& system, double h);
    static void divide_work(HeldIsland& island);
    void book_contacts(const HeldIsland& island, WorkBook book);
    void log_contacts(const HeldIsland& island, double from, double to);
    void take_back_contacts(double from);
    void keep(HeldIsland& island);
    void keep_run(HeldIsland& island, const Run& run);
    static KnownContact* kept(const HeldIsland& island, const Run& run, std::uint32_t contact);
    ContactBook::Pressing pressing_of(const HeldIsland& island, const Run& run) const;
    void note_releases(HeldIsland& island, double from, double h);
    void drop_passed(std::span<const FoundContact> found);
    void report_begin(const PairState& pair, const Contact& contact, double time) const;
    void report_impacts(const HeldIsland& island, double time);
    void find_yielding_rows();
    /// Calls job(island) for each, on several threads. Within large islands it may divide its loops.
    template <class Job>
    void share(std::span<HeldIsland*> islands, const Job& job)
    {
        shares_.run(
            &step_.workers, islands.size(), kPart, [&](std::size_t i) { return islands[i]->bodies.size() + islands[i]->contact_count(); },
            [](std::size_t) { return true; }, [&](std::size_t i) { job(*islands[i]); });
    }
    static void report_rows(const HeldIsland& island, GroupSystem& system, double h, WorkBook book);
    double mobility_of(std::uint32_t root) const;
    void book_forces(GroupSystem& system, std::span<HeldIsland*> islands, double h);

    StepState& step_;
    GroupMotion& motion_;
    ContactBook& contacts_;
    bool any_ = false, holds_joints_ = false;
    std::vector<std::uint32_t> manager_of_group_;   ///< by group: manager that one of its joints names; kNoIndex: none
    std::vector<std::uint32_t> yielding_groups_;    ///< groups with such a manager
    std::vector<std::uint8_t> yields_;              ///< by group: such a joint has one-sided or bounded rows in this step
    std::vector<std::uint32_t> manager_of_island_;  ///< by representative group
    std::vector<std::uint32_t> held_;
    std::vector<std::uint32_t> island_of_group_;  ///< kNoIndex but for numbered_
    std::vector<std::uint32_t> numbered_;         ///< groups
    std::vector<std::unique_ptr<HeldIsland>> islands_;
    std::size_t island_count_ = 0;
    MidpointContacts midpoint_;
    std::vector<HeldIsland*> plain_, jointed_, all_;
    // Of all islands, one after the other. They keep their size, as making contacts takes time.
    std::vector<Contact> contact_memory_;
    std::vector<std::uint32_t> slot_memory_;
    std::vector<std::uint8_t> jam_memory_;
    std::vector<Vec3> further_memory_;
    std::vector<Island> solved_;          ///< what a manager is given
    std::vector<HeldIsland*> solved_of_;  ///< parallel
    Shares shares_;
    /// Bodies, contacts or pairs that a thread handles at once.
    static constexpr std::size_t kPart = kKickedPart, kRunPart = 32;
    static constexpr std::size_t kRunsAhead = 2;  ///< so far ahead the memory of a run is asked for
    std::vector<SurfaceLaw> laws_;                ///< by detector, of its response
    struct RunOf
    {
        HeldIsland* island = nullptr;
        const Run* run = nullptr;
    };
    std::vector<RunOf> turning_;                  ///< pairs of islands that are advanced to the midpoint
    std::vector<RunOf> incomplete_;               ///< pairs with contacts that are new
    std::vector<FoundContact> at_midpoint_;       ///< contacts of turning_
    std::vector<std::uint32_t> midpoint_places_;  ///< of at_midpoint_
    std::vector<std::uint32_t> plain_groups_;
    std::vector<FoundContact> touching_;         ///< detected for this advance
    std::uint32_t run_count_ = 0;                ///< pairs in all islands
    std::vector<std::uint32_t> member_of_body_;  ///< by host row, for HeldMotion::begin
    std::vector<double> wedging_;                ///< by host row, of the members of one island; else 0 (paradox.h)
    std::vector<PairState> fresh_, adopted_;     ///< adopted_: working memory of adopt_again()
    std::vector<std::size_t> first_found_;       ///< parallel to fresh_ within adopt()
    std::vector<std::size_t> passed_;            ///< places in fresh_, likewise
    std::vector<double> shaft_mobility_;
    std::vector<double> given_speed_;  ///< m/s, by body: speed that forces give it in the step
    std::vector<RestSample> starts_;   ///< by body; empty: nobody wants them
    // The state to which the found contacts belong.
    std::vector<Vec3> known_positions_, known_velocities_, known_spins_;
    std::vector<Quat> known_orientations_;
    std::shared_ptr<const char> known_mark_;  ///< RestState::mark
    std::uint64_t known_found_ = 0;           ///< ContactBook::found_revision()
    bool known_ = false;
    // The state that is put back after the forces have been booked.
    std::vector<Vec3> kept_positions_, kept_velocities_, kept_spins_, kept_momenta_;
    std::vector<Quat> kept_orientations_;
    std::vector<double> kept_speeds_, kept_angles_, moved_with_;
};

}  // namespace plab::simulation
