/// Islands of contacts that are rows: what a manager (Phase::Solve) gets to
/// see, and what becomes of it.
///
/// The groups that standing contacts hold together are one island, with the
/// joints of its members. Forces are taken once, at the start; the manager says
/// how far they kick, when bodies move, and answers contacts and rows in
/// between.
///
///   work of forces    F . (way that the bodies go)
///   work of manager   the rest of the change of kinetic energy
#pragma once

#include <memory>
#include <vector>

#include "plab/island.h"
#include "simulation/contacts/contact_book.h"
#include "simulation/contacts/kicked_bodies.h"
#include "simulation/contacts/midway_contacts.h"
#include "simulation/motion/group_motion.h"

namespace plab::simulation
{

/// How the bodies of one island move. What is kicked twice without a move
/// between was kicked once: the last time.
class HeldMotion final : public IslandMotion
{
public:
    /// `members`: indices into system.bodies().
    void begin(GroupSystem& system, Bodies& bodies, Shafts& shafts, std::span<const std::uint32_t> members,
               std::span<const std::uint32_t> roots, std::span<Contact> contacts, std::span<ConstraintRow> rows, bool books);
    void kick(double h) override;
    void move(double h) override;
    void move_mean(double h) override;
    /// m/s: of separation, of a contact's two points where they have come to.
    double separation_speed(std::size_t contact) const;
    void refresh_rows() override;
    void refresh_depths() override;

    /// J: what the forces did on the way that the bodies went.
    double work_of_forces() const { return worked_; }
    double kinetic_energy() const;
    /// J, against the forces: what bodies have moved beside the moves, where overlap was parted. Counted as their way from then on.
    double count_corrections();
    /// Mean speeds of the kicks times the time they took, by member, and of
    /// roots.
    struct Mean
    {
        Vec3 velocity;  ///< m
        Vec3 momentum;  ///< N m s^2, or the spin in B of needles
        double shaft = 0;
    };
    const std::vector<Mean>& means() const { return means_; }
    std::span<const std::uint32_t> members() const { return members_; }

private:
    void commit(double h, bool mean);
    Vec3 moved(std::uint32_t body, const Vec3& arm_B, const Vec3& point) const;

    GroupSystem* system_ = nullptr;
    Bodies* bodies_ = nullptr;
    Shafts* shafts_ = nullptr;
    std::span<const std::uint32_t> members_;
    std::span<const std::uint32_t> roots_;  ///< indices into system.roots()
    std::span<Contact> contacts_;
    std::span<ConstraintRow> rows_;
    bool books_ = false;
    double worked_ = 0, since_start_ = 0;
    KickedBodies kicked_;
    std::vector<double> shaft_before_;
    std::vector<Mean> means_;
    std::vector<Vec3> started_;  ///< m, positions at the start
    struct Arms
    {
        Vec3 a, b;         ///< m, in the bodies' frames
        Vec3 point;        ///< W, at the start
        double depth = 0;  ///< m, at the start
    };
    std::vector<Arms> arms_;
};

class HeldIslands
{
public:
    HeldIslands(StepState& step, GroupMotion& motion, ContactBook& contacts)
        : step_(step), motion_(motion), contacts_(contacts), midway_(step, contacts)
    {
    }

    /// After any structural change.
    void rebuild();
    /// Whether any contacts or joints are held by managers.
    bool any() const { return any_; }
    /// Some rows may let go in this step, so that only a manager can hold them.
    bool holds_joints() const { return holds_joints_; }
    bool holds_joints_of(std::uint32_t group) const { return holds_joints_ && yields_[group] != 0; }
    /// At the start of a step: contacts where the bodies are now, unless they are
    /// known from the end of the last step; pairs that stand from now on.
    void begin_step();
    /// Pairs of detectors whose contacts stand at once, where nobody knew of
    /// them; told as contact.begin.
    void adopt(std::vector<FoundContact>& found, double time);
    /// At the end of a step, with the pair's contacts: whether it does not touch, but may within the next step. A pair that
    /// touches for the first time is told.
    bool keeps_ahead(PairState& pair, bool touches, std::span<const FoundContact> found, double time) const;
    /// What contacts held that are gone now goes to those that came in their
    /// place: corners that lie on one another change their names with every
    /// tremor. The first `known` contacts of the pair are old.
    void pass_on(PairState& pair, std::uint32_t known, std::span<const FoundContact> found) const;
    /// The contacts in `found` are those of the present state.
    void note_state();
    /// Takes the groups that managers advance out of `groups`; both
    /// ascending.
    void take(std::vector<std::uint32_t>& groups, DisjointSets& islands);
    bool holds_any() const { return !held_.empty(); }
    void advance(std::span<const std::uint32_t> observed, DisjointSets& islands, double from, double to, WorkBook book, bool trial);

private:
    struct Island
    {
        std::uint32_t manager = kNoIndex;  ///< component
        bool has_rows = false;
        bool turns = false;  ///< somebody moves along a curve
        std::vector<std::uint32_t> groups;
        std::vector<std::uint32_t> members,
            roots;                                  ///< indices into the system's lists
        std::vector<std::uint32_t> bodies, shafts;  ///< host rows
        std::vector<Contact> contacts;
        std::vector<ConstraintRow> rows;
        std::vector<std::uint32_t> places;  ///< of the contacts, in touching_
        HeldMotion motion;
    };
    std::uint32_t manager_of(const PairState& pair) const;
    bool is_current() const;
    void collect_contacts(double from, double h);
    void add_known_contacts();
    void fill(FoundContact& f, PairState& pair, const SurfaceLaw& law);
    void make_islands(DisjointSets& islands);
    void share_contacts(double h);
    void set_approach(Island& island, const GroupSystem& system, double h);
    void run(std::span<Island*> islands, std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed, double from,
             double to, WorkBook book, bool trial);
    void solve(Island& island, GroupSystem& system, double from, double to, WorkBook book, bool trial);
    void lead(std::span<Island*> islands, GroupSystem& system, double h);
    void book_contacts(Island& island, double gained, WorkBook book);
    void keep(const Island& island);
    void tell_begin(const PairState& pair, const Contact& contact, double time) const;
    void tell_impacts(const Island& island, double time);
    void note_releases(Island& island, double from, double h) const;
    void find_yielding_rows();
    static void report_rows(const Island& island, GroupSystem& system, double h, WorkBook book);
    double mobility_of(std::uint32_t root) const;
    void book_forces(GroupSystem& system, std::span<Island*> islands, double h);

    StepState& step_;
    GroupMotion& motion_;
    ContactBook& contacts_;
    bool any_ = false, holds_joints_ = false;
    std::vector<std::uint32_t> manager_of_group_;   ///< of joints that name one; kNoIndex: none
    std::vector<std::uint32_t> yielding_groups_;    ///< those that have one
    std::vector<std::uint8_t> yields_;              ///< by group: such a joint may let go in this step
    std::vector<std::uint32_t> manager_of_island_;  ///< by representative group
    std::vector<std::uint32_t> held_;
    std::vector<std::uint32_t> island_of_group_;
    std::vector<std::unique_ptr<Island>> islands_;
    std::size_t island_count_ = 0;
    MidwayContacts midway_;
    std::vector<Island*> plain_, jointed_;
    std::vector<std::uint32_t> led_places_;
    std::vector<std::uint32_t> plain_groups_;
    std::vector<FoundContact> touching_;
    std::vector<PairState*> pair_of_contact_;
    std::vector<PairState> fresh_;
    std::vector<std::size_t> first_found_;  ///< beside fresh_
    std::vector<double> shaft_mobility_;
    std::vector<double> given_speed_;  ///< m/s, by body: what forces give it in the step
    // What the state was that the found contacts are of.
    std::vector<Vec3> known_positions_, known_velocities_, known_spins_;
    std::vector<Quat> known_orientations_;
    bool known_ = false;
    // Kept while forces are booked.
    std::vector<Vec3> kept_positions_, kept_velocities_, kept_spins_, kept_momenta_;
    std::vector<Quat> kept_orientations_;
    std::vector<double> kept_speeds_, kept_angles_;
};

}  // namespace plab::simulation
