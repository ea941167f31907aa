/// The contacts of a scene: its detectors, the known pairs, the contacts that were found last, and the calls of their responses.
///
/// A detector is a detection component with its resolution and response. Pairs are known from the step in which they touch until their
/// gap opens (contacts.h). All functions act on the present state: `respond` changes velocities, and none of them moves a body.
#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include "simulation/contacts/contact_log.h"
#include "simulation/contacts/crowds.h"
#include "simulation/contacts/resting_pairs.h"
#include "simulation/motion/step_state.h"

namespace plab::simulation
{

class ContactBook
{
public:
    explicit ContactBook(StepState& step) : step_(step) {}

    /// To be called after any structural change: finds detectors and sizes of bodies, and drops pairs whose detector or bodies are gone.
    /// Errors: see contact_rules.h. `sizes`: sizes of bodies are wanted even if there is no detector. `only_solvers`: nothing but solvers
    /// has changed since the last rebuild (world::Revisions).
    Errors rebuild(bool sizes = true, bool only_solvers = false);
    /// Whether found() survived the last rebuild, because nothing on which it depends has changed.
    bool keeps_found() const { return keeps_found_; }
    /// Whether nothing on which contacts may depend has changed since the last rebuild.
    bool is_of_present_structure() const;
    /// The state of the world was replaced, and not only its structure changed: the next rebuild drops found().
    void forget_found() { built_from_.reset(); }
    /// For a stepper that steps a part of a scene, before its first rebuild: takes over the sizes of bodies, unless they have changed.
    void take_sizes(const ContactBook& whole);
    /// The same, after a rebuild: from now on detectors look only for pairs with one of these bodies; null: for all. They must have looked
    /// at all bodies before, and nobody else may have moved since or may move. Must outlive this object.
    void look_among(const IndexSet* bodies) { part_ = bodies; }
    bool looks_among_some() const { return part_ != nullptr; }
    void begin_step() { releases_.clear(), resting_.forget(), log_.begin_step(); }
    enum class SearchChange : std::uint8_t
    {
        None,
        Crowds,  ///< other bodies are crowded: what was detected serves this step, but other pairs of it are persistent
        Margins  ///< what was detected with the former margins does not serve this step
    };
    /// Lets the resolutions that adapt choose how the impacts of this step are found. Returns what differs from the last step.
    SearchChange choose_search();
    /// In a step that spares crowds: locating the impacts of the other bodies costs too much. These are crowded until a dwell has passed.
    void crowd_all();
    /// Whether there are such resolutions.
    bool adapts() const;
    /// For a stepper that steps a part of a scene: from now on they choose as they would at present in a step of the whole scene, whose
    /// contacts `whole` has.
    void search_as(const ContactBook& whole);

    const std::vector<Detector>& detectors() const { return detectors_; }
    /// Whether impacts of two bodies are located inside the step.
    bool locates(const Detector& d, Ref a, Ref b) const { return d.locates && !(d.spares_crowds && is_crowded(a, b)); }
    /// Whether two bodies are a persistent pair as soon as they touch (Detector::persists).
    bool persists(const Detector& d, Ref a, Ref b) const { return d.by_force || (d.by_rows && !locates(d, a, b)); }
    /// Whether a gap between them that may close within the step is a contact.
    bool speculates(const Detector& d, Ref a, Ref b) const { return d.speculates && !locates(d, a, b); }
    /// By body, 1: crowded. Empty where no detector spares crowds in this step.
    std::span<const std::uint8_t> crowded() const { return crowded_; }
    ContactCache& cache() { return cache_; }
    const ContactCache& cache() const { return cache_; }
    /// What contacts do in this step, for whoever reads it afterwards.
    ContactLog& log() { return log_; }
    const ContactLog& log() const { return log_; }
    /// The persistent pairs of some groups.
    RestingPairs& resting() { return resting_; }
    /// Contacts at the end of the last step, or at the start of the present one until its end is known.
    std::vector<FoundContact>& found() { return found_; }
    const std::vector<FoundContact>& found() const { return found_; }
    /// Changes whenever found() does.
    std::uint64_t found_revision() const { return found_revision_; }
    /// The pairs in found(), in order.
    std::span<const FoundRun> runs() const { return runs_; }

    // Sizes and margins ----------------------------------------------------------------------------------------------------
    /// m, by body: radius of the bounding sphere about the centre of mass; infinite for planes.
    std::span<const double> radius_of_body() const { return radius_of_body_; }
    /// m: the smaller radius of two bodies; 0 if both are infinite.
    double smaller_radius(Ref a, Ref b) const
    {
        const double radius = std::min(radius_of_body_[a.index], radius_of_body_[b.index]);
        return radius < std::numeric_limits<double>::infinity() ? radius : 0.0;
    }
    /// m: overlap up to this is not corrected.
    double overlap_tolerance(Ref a, Ref b) const { return kOverlapShare * smaller_radius(a, b); }
    /// Whether a body is as thick in any direction: a ball about its centre of mass.
    bool is_ball(std::uint32_t body) const { return thickness_of_body_[body] >= radius_of_body_[body] * (1 - 1e-9); }
    /// Whether a body has a shape that is round, or a round wall that is touched from inside.
    bool is_round(Ref body) const { return std::isfinite(curve_radius_of_body_[body.index]); }
    /// m: gaps up to this do not end a persistent contact.
    double persistence_margin(Ref a, Ref b) const;
    double persistence_margin(const PairState& pair) const;

    // Detection ------------------------------------------------------------------------------------------------------------
    /// Adds what one detector finds. `only_persistent`: for the given pairs only. `margin`, m: gaps up to this count as contacts. Returns
    /// whether it is sorted, also behind what was in `out` before.
    bool detect(const Detector& detector, std::uint32_t index, std::span<const PersistentPair> persistent, bool only_persistent,
                std::vector<FoundContact>& out, double margin = 0);
    /// The same with a sink of the caller. `active`: the bodies to consider, of which one at least is in each pair; null: all. A detector
    /// must have looked at all bodies before, and nobody but these and those of earlier queries may have moved since.
    void query(const Detector& detector, ContactSink& sink, const IndexSet* active = nullptr);
    /// Sets found() to what all detectors find.
    void detect_all();
    /// From now on detect_all() leaves out pairs without one of these bodies; null: none is left out. All others must stay where they are.
    void detect_among(const IndexSet* awake) { awake_ = awake; }
    /// Bodies that are left out may have moved: detectors have to look at all of them once.
    void detect_all_once() { has_detected_all_ = false; }
    /// Whether a detector was given this body by one of its roles.
    bool takes_part(std::uint32_t detector, std::uint32_t body) const;
    /// Sets found() to the contacts of known pairs, where all others are certain to be apart.
    void detect_known_pairs();
    /// The contacts of persistent pairs with a member in `groups` (ascending), including gaps that may close within `h` (s).
    /// `only_located`: of those whose impacts are located.
    void touching_pairs_of(std::span<const std::uint32_t> groups, std::vector<FoundContact>& out, double h = 0, bool only_located = false);
    /// Gives contacts of known pairs the impulses that an advance starts from (KnownContact::warm_start).
    void warm_start(std::span<FoundContact> contacts, bool begins);
    PairState* find_pair(const FoundContact& found);
    /// The same, faster for contacts in the order of pairs (ContactCache::find).
    PairState* find_pair(const FoundContact& found, std::size_t& near);
    bool is_of_pair(const FoundContact& found, const PairState& pair) const;

    // Seams ----------------------------------------------------------------------------------------------------------------
    /// Whether one of two bodies lies on a surface along which it passes the other one, whose surface there is no higher within
    /// overlap_tolerance(). Returns the normal of the surface, a to b. A contact with `normal` (a to b), across the edges of the two, is
    /// none then; if it is that of the surface, the result is empty. `normal` zero: any, but only for a body that lies on a
    /// face. A body lies on another one by a persistent contact, or by one of `beside`.
    std::optional<Vec3> seam_between(Ref a, Ref b, const Vec3& normal, std::span<const FoundContact> beside = {});
    /// Whether all of the contacts of a pair are across such a seam.
    bool passes_over(std::span<const FoundContact> contacts);
    /// Drops the contacts of one impact that are across such a seam.
    void drop_passed(std::vector<FoundContact>& impact);

    // Responses ------------------------------------------------------------------------------------------------------------
    /// Sets friction and restitution: from the pair of materials if there is one, otherwise from the response.
    void fill_material(FoundContact& found) const;
    SurfaceLaw response_law(std::uint32_t detector) const;
    /// m/s, separation speed.
    double normal_velocity(const Contact& contact) const;
    /// Applies impulses by each detector's response. `dt`: s, time in which gaps may close (ImpactMode::Rest). With the `mobility` of
    /// contacts of one detector whose bodies joints hold (Impact::mobility), impulses are found only.
    void respond(std::vector<FoundContact>& contacts, ImpactMode mode, double dt, WorkBook book, std::span<const Mat3> mobility = {});

    // Events ---------------------------------------------------------------------------------------------------------------
    Event contact_event(const char* kind, const PairState& pair, double time) const;
    /// With the place of one contact of the pair, and what impulse it took (N s, on b).
    Event contact_event(const char* kind, const PairState& pair, double time, const Contact& at, const Vec3& impulse = {}) const;
    /// Whether two touching bodies slide in such a way that pressing harder would close them faster (paradox.h).
    bool is_paradox(const Contact& contact) const;
    /// For excludes_paradox(), where overlaps and gaps are at most depth_that_excludes() (m).
    double wedging_of(std::uint32_t body) const;
    double depth_that_excludes(Ref a, Ref b) const;
    void report_paradox(const Contact& contact, PairState& pair, double time);
    /// Sums over the points of a pair in an advance, from which its release is decided. First the impulses of all points, before they are
    /// stored; if the pair then presses no more (stops_pressing), the speeds of all points, and note_release().
    struct Pressing
    {
        double before = 0;                   ///< N s: normal impulses in the last step
        double now = 0;                      ///< N s: normal impulses in this advance
        double opens = HUGE_VAL;             ///< m/s: smallest separation speed of a point, relative to the curve of its surface
        double separation_speed = HUGE_VAL;  ///< m/s: smallest speed that a pulling impulse would have had to take away to close the gap
        bool counts_all = false;             ///< the pair is known to have pressed, so all its points count

        /// `kept`: N s, the impulse of the last step.
        void add_impulse(const Contact& contact, const Vec3& kept)
        {
            before += dot(kept, contact.normal), now += dot(contact.impulse, contact.normal);
        }
        /// A point with `depth` (m) at the start that separates with `speed` (m/s) at the end of an advance of h (s).
        void add_speed(const Contact& contact, const Vec3& kept, double depth, double speed, double h)
        {
            if (!counts_all && !(dot(kept, contact.normal) > 0)) return;  // it touches without pressing
            opens = std::min(opens, speed - contact.turning);
            separation_speed = std::min(separation_speed, speed - contact.turning + std::max(0.0, -depth) / h);
        }
    };
    /// For add_impulse().
    Pressing pressing_of(const PairState& pair) const;
    /// Whether a pair that pressed in the last step presses no more in this advance.
    bool stops_pressing(PairState& pair, const Pressing& pressing) const;
    /// Of a pair that stops pressing. `first`: one of its points. If it opens, its force went through zero
    /// between the middles of the two steps; linear interpolation gives the time with order 2, and it may lie in the last step. The event
    /// is emitted when the step is over, because after a rewind the pair may turn out to hold on.
    void note_release(PairState& pair, const Contact& first, const Pressing& pressing, double from, double h);
    /// Emits the release that was noted for this pair. True if there is one.
    bool report_release(PairState& pair);

private:
    void measure_bodies();
    void list_participants();
    std::span<const Shortlist> shortlists_of(std::size_t detector, const IndexSet& active);
    double curves_of(Ref a, Ref b) const { return std::fabs(curve_radius_of_body_[a.index] + curve_radius_of_body_[b.index]); }
    /// How the impacts of a step are found.
    struct SearchChoice
    {
        struct Of
        {
            ImpactSearch apart, crowded;  ///< pairs without a crowded body, and the others
        };
        std::vector<Of> of;                 ///< by detector
        std::vector<std::uint8_t> crowded;  ///< by body
    };
    std::vector<FirstTouch> first_touches();
    Crowds::Limits limits_of_crowds() const;
    void find_crowds(const ContactCache& cache, std::vector<double>& until);
    void ask_search(const ContactCache& cache, std::vector<double>& until, SearchChoice& out);
    void ask_search(std::size_t detector, ContactLoad load, SearchChoice::Of& out);
    SearchChange apply(const SearchChoice& choice);
    bool is_crowded(Ref a, Ref b) const { return crowded_[a.index] != 0 || crowded_[b.index] != 0; }
    bool passes_along(Ref body, Ref other, const Vec3& towards, Ref below, const Vec3& down) const;
    bool has_edges(Ref body) const;
    std::optional<Vec3> seam_below(Ref body, Ref other, const Vec3& towards, std::span<const FoundContact> beside);
    void drop_passed_pairs(std::vector<FoundContact>& contacts);
    bool detect_with_gaps(std::uint32_t index);
    void list_runs(std::size_t from);
    bool ask(const Detector& detector, ContactCollector& sink, std::span<const PersistentPair> persistent, bool only_persistent);
    double gap_margin(const PairState& pair, double h) const;
    void drop_far(std::vector<FoundContact>& out, double h) const;
    double kinetic_energy(const std::vector<FoundContact>& contacts) const;
    void book_impact(std::uint32_t response, const std::vector<FoundContact>& contacts, ImpactMode mode, double work, WorkBook book);

    StepState& step_;
    std::vector<Detector> detectors_;
    std::optional<world::Revisions> built_from_;  ///< of the world at the last rebuild; empty: there was none, or it failed
    bool keeps_found_ = false;                    ///< the last rebuild left found_ as it was
    bool has_sizes_ = false;                      ///< those of bodies are those of the revisions built_from_
    ContactCache cache_;
    ContactLog log_;
    RestingPairs resting_{step_.world, step_.groups, cache_, step_.report.visited};
    std::vector<FoundContact> found_;
    std::vector<FoundRun> runs_;  ///< of found_
    std::uint64_t found_revision_ = 0;
    std::vector<Vec3> extents_of_body_;         ///< m, about C along the axes of B: no point is further; infinite where they are not known
    std::vector<double> radius_of_body_;        ///< m, about C; infinite for planes
    std::vector<double> thickness_of_body_;     ///< m, half of the smallest width of its shapes; infinite for planes
    std::vector<double> curve_radius_of_body_;  ///< m, of the most strongly curved shape; negative inside, infinite if there is none
    std::vector<Event> releases_;               ///< noted in this step, emitted when it is over

    // Scratch lists, members to keep their memory.
    mutable std::vector<std::uint32_t> counted_;
    /// A list of bodies that a detector was given by one of its roles.
    struct Participants
    {
        const RefList* all = nullptr;
        std::vector<std::uint32_t> place;  ///< by body: in the list; kNoIndex: it is not there
    };
    std::vector<std::vector<Participants>> participants_;  ///< by detector, then by address of the list
    std::vector<std::uint64_t> seen_in_;                   ///< by detector: the step (StepState::serial) in which it looked at all bodies
    const IndexSet* part_ = nullptr;                       ///< see look_among()
    const IndexSet* awake_ = nullptr;
    bool has_detected_all_ = false;
    std::vector<Shortlist> shortlists_;  ///< lists keep their memory
    std::vector<std::uint32_t> short_places_;
    IndexSet asked_;  ///< bodies
    Crowds crowds_{step_};
    std::vector<std::uint8_t> crowded_;    ///< see crowded()
    SearchChoice choice_;                  ///< of this step
    std::optional<SearchChoice> imposed_;  ///< empty: they choose
    std::vector<PersistentPair> persistent_;
    std::vector<std::uint32_t> places_, seam_places_;
    std::vector<std::uint8_t> passed_;
    std::vector<Contact> impact_contacts_;
};

}  // namespace plab::simulation
