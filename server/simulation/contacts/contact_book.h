/// The contacts of a scene: who looks for them, which pairs are known, which contacts were found last, and who answers them.
///
/// A detector is a detection component with its resolution and response. Pairs are known from the step in which they touch until their
/// gap opens (contacts.h). Everything here acts on the state as it is now: `respond` changes speeds, nobody is moved.
#pragma once

#include <cmath>
#include <limits>

#include "simulation/contacts/contacts.h"
#include "simulation/motion/step_state.h"

namespace plab::simulation
{

class ContactBook
{
public:
    explicit ContactBook(StepState& step) : step_(step) {}

    /// After any structural change: detectors, sizes of bodies; pairs whose detector or bodies are gone are dropped. Errors:
    /// contact_rules.h.
    Errors rebuild();
    void begin_step() { releases_.clear(); }

    const std::vector<Detector>& detectors() const { return detectors_; }
    ContactCache& cache() { return cache_; }
    const ContactCache& cache() const { return cache_; }
    /// Contacts of the end of the last step, or of its start before that is known.
    std::vector<FoundContact>& found() { return found_; }
    const std::vector<FoundContact>& found() const { return found_; }

    // Sizes and margins ----------------------------------------------------------------------------------------------------
    /// m, about the centre of mass, by body: whatever collides is within; infinite for planes.
    std::span<const double> radius_of_body() const { return radius_of_body_; }
    /// m: of two bodies that may touch; 0 where neither ends.
    double smaller_radius(Ref a, Ref b) const
    {
        const double radius = std::min(radius_of_body_[a.index], radius_of_body_[b.index]);
        return radius < std::numeric_limits<double>::infinity() ? radius : 0.0;
    }
    /// m: overlap that is left alone.
    double overlap_tolerance(Ref a, Ref b) const { return kOverlapShare * smaller_radius(a, b); }
    /// m: gaps up to this do not end a standing contact.
    double persistence_margin(Ref a, Ref b) const;
    double persistence_margin(const PairState& pair) const;

    // Looking for contacts -------------------------------------------------------------------------------------------------
    /// Adds what one detector finds. `only_persistent`: of these pairs alone. `margin`, m: gaps up to this count.
    void detect(const Detector& detector, std::uint32_t index, std::span<const PersistentPair> persistent, bool only_persistent,
                std::vector<FoundContact>& out, double margin = 0);
    /// The same with a sink of the caller's. `active`, by body: whom it is about; empty: all.
    void query(const Detector& detector, ContactSink& sink, std::span<const std::uint8_t> active = {});
    /// Of all detectors, sorted.
    void detect_all(std::vector<FoundContact>& out);
    /// Of standing pairs with a member in `groups` (ascending), with the gaps that may close within `h` (s).
    void touching_pairs_of(std::span<const std::uint32_t> groups, std::vector<FoundContact>& out, double h = 0);
    /// What is remembered of a contact of a known pair.
    KnownContact& known_contact(const FoundContact& found);
    PairState* find_pair(const FoundContact& found);
    bool is_of_pair(const FoundContact& found, const PairState& pair) const;
    /// Where the contacts of a pair begin in found(), or would; `from`: where those of the pair before end.
    std::size_t first_of_pair(const PairState& pair, std::size_t from) const;

    // Answering them -------------------------------------------------------------------------------------------------------
    /// A parameter of a component; 0 where it has none of that name.
    double number_of(std::uint32_t component, const char* parameter) const;
    /// Friction and restitution: of the materials of both bodies, else of the response.
    void fill_material(FoundContact& found) const;
    SurfaceLaw response_law(std::uint32_t detector) const;
    /// m/s, of separation.
    double normal_velocity(const Contact& contact) const;
    /// Impulses by each detector's response. `dt`: s, over which gaps may close (ImpactMode::Rest).
    void respond(std::vector<FoundContact>& contacts, ImpactMode mode, double dt, WorkBook book);

    // Telling --------------------------------------------------------------------------------------------------------------
    Event contact_event(const char* kind, const PairState& pair, double time) const;
    /// Whether two bodies that touch slide so that pressing harder would close them faster (paradox.h).
    bool is_paradox(const Contact& contact) const;
    void tell_paradox(const Contact& contact, PairState& pair, double time);
    /// What the points of a pair did in an advance, to see where it is released.
    struct Pressing
    {
        double before = 0;                   ///< N s, along each point's normal: what they took in the last step
        double now = 0;                      ///< N s: in this advance
        double opens = HUGE_VAL;             ///< m/s: the least speed at which one of them opens, along its curve
        double separation_speed = HUGE_VAL;  ///< m/s: the least that a pull would have had to take away, beyond what closes the gap
    };
    /// Adds a point that opens with `speed` (m/s) at the end of an advance of h (s). Before its impulse is kept.
    void add_point(Pressing& pressing, PairState& pair, const Contact& contact, double speed, double h);
    /// Whether a pair that pressed in the last step presses no more in this advance. `first`: one of its points. Where it opens its force
    /// went through zero between the middles of both steps; linear in between: of order 2, and it may lie in the last step. It is told
    /// when the step is over: an advance that goes back may show that it holds on.
    bool note_release(PairState& pair, const Contact& first, const Pressing& pressing, double from, double h);
    /// Of this pair, as noted. True if there is one.
    bool tell_release(PairState& pair);

private:
    void measure_bodies();
    void detect_with_gaps(std::uint32_t index, std::vector<FoundContact>& out);
    double gap_margin(const PairState& pair, double h) const;
    void drop_far(std::vector<FoundContact>& out, double h) const;
    double kinetic_energy(const std::vector<FoundContact>& contacts) const;
    void book_impact(std::uint32_t response, const std::vector<FoundContact>& contacts, ImpactMode mode, double work, WorkBook book);

    StepState& step_;
    std::vector<Detector> detectors_;
    ContactCache cache_;
    std::vector<FoundContact> found_;
    std::vector<double> radius_of_body_;  ///< m, about C; infinite for planes
    std::vector<Event> releases_;         ///< noted, and told when the step is over

    // Working lists, kept warm.
    mutable std::vector<std::uint32_t> counted_;
    std::vector<PersistentPair> persistent_;
    std::vector<Contact> impact_contacts_;
};

}  // namespace plab::simulation
