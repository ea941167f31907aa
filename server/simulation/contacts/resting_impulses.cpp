// Islands that rest or slide on impulses of a response (ImpactMode::Rest): time stepping.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "plab/number_text.h"
#include "simulation/contacts/paradox.h"
#include "simulation/step/stepper.h"

namespace plab::simulation
{

/// Whether corners of a standing pair reach the other body within the step, faster than forces alone would take them there.
bool Stepper::meets_any(const GroupSystem& system, double h) const
{
    double given = 0;
    for (std::size_t i = 0; i < system.bodies().size(); ++i) given = std::max(given, length(system.acceleration(i)) * h);
    const double least = kNoApproach * least_gyration(world_.host().bodies, system.bodies()) / h;
    const auto meets = [&](const FoundContact& f)
    {
        const double closing = -normal_velocity(f.contact);
        return closing > std::max(least, 2 * given) && closing * h > -f.contact.depth;
    };
    return std::any_of(touching_.begin(), touching_.end(), meets);
}

/// Such corners meet it without bounce, ahead of the step: a mean of the speeds before and after would carry them through.
void Stepper::arrest(double h, WorkBook book)
{
    for (FoundContact& f : touching_) f.contact.impulse = {};
    respond(touching_, ImpactMode::Rest, h, book);
    // What a blow took does not tell how hard the contact will press; the last step's impulse does.
    for (FoundContact& f : touching_) f.contact.impulse = known_contact(f).impulse;
}

/// Whether two bodies that touch slide so that pressing harder would close them faster.
bool Stepper::is_paradox(const Contact& contact) const
{
    return contact.depth >= -overlap_tolerance(contact.a, contact.b) && pressing_share(world_.host().bodies, contact, frame_.step) <= 0;
}

/// Told where it begins: what follows is one of several answers, an impulse that ends the slip.
void Stepper::tell_paradox(const Contact& contact, PairState& pair, double time)
{
    const bool goes_on = pair.paradox_tick >= frame_.tick - 1;
    pair.paradox_tick = frame_.tick;
    if (goes_on) return;
    Event e = contact_event("contact.paradox", pair, time);
    e.severity = Severity::Warning;
    e.message = "Painleve's paradox: friction of " + number_text(contact.friction) +
                " on this lever leaves sliding without an answer; an impulse ends the slip. Less friction, or a less slender body, has one";
    e.values = {contact.point.x, contact.point.y, contact.point.z, contact.normal.x, contact.normal.y, contact.normal.z};
    emit(std::move(e));
}

/// Time stepping with one-sided contacts: speeds first, impulses that keep contacts from closing, then positions with
/// the mean of old and new speeds, so that a body that slides at constant deceleration is exact.
void Stepper::advance_island(std::span<const std::uint32_t> island, std::span<const std::uint32_t> shadows, double from, double to,
                             WorkBook book, bool trial)
{
    const double h = to - from;
    Bodies& bodies = world_.host().bodies;
    Shafts& shafts = world_.host().shafts;
    GroupSystem& system = system_for(island, shadows);
    touching_.clear();
    touching_pairs_of(island, touching_, h);
    system.begin(from, to, book, trial ? nullptr : this);
    members_.resize(system.bodies().size());
    std::iota(members_.begin(), members_.end(), 0u);
    const bool led = lead_touching(system, h);
    system.evaluate_here();
    if (led) bend_touching(h);
    if (!trial)
        for (const FoundContact& f : touching_)
            if (is_paradox(f.contact))
                tell_paradox(f.contact, *cache_.find(detectors_[f.detector].component, f.contact.a, f.contact.b, world_),
                             frame_.start_time + from);
    if (!led && meets_any(system, h)) arrest(h, book), system.join();

    moved_.kick(system, bodies, members_, h);
    if (!trial) note_forces(system);
    respond(touching_, ImpactMode::Rest, h, book);
    if (!trial) keep_impulses(touching_, from, h);
    system.join();  // an impulse knows nothing of joints
    const double work = moved_.move_mean(h);
    if (led) midway_.take_back();
    if (book.work && !system.rows()) book_rest(work, book);
    system.move_shafts(h, shafts);
    system.move_prescribed();
    system.project();
    finish_advance(system, system.all_finite(), to, trial);
}

/// Who goes along a curve and meets nobody is led half a step ahead.
bool Stepper::lead_touching(GroupSystem& system, double h)
{
    const auto turns = [&](const FoundContact& f) { return midway_.turns(f.contact, h); };
    const auto is_driven = [&](const FoundContact& f) { return midway_.is_driven(f.contact); };
    if (system.rows() || std::none_of(touching_.begin(), touching_.end(), turns)) return false;
    if (std::any_of(touching_.begin(), touching_.end(), is_driven)) return false;
    system.evaluate(0, 0);
    if (meets_any(system, h)) return false;
    midway_.lead(system, members_, h);
    return true;
}

void Stepper::bend_touching(double h)
{
    places_.resize(touching_.size());
    std::iota(places_.begin(), places_.end(), 0u);
    midway_.bend(places_, touching_, h);
}

/// What resting contacts did on the way that the bodies went: no more than nothing where nobody else moves. What it is more stays
/// unexplained; respond() has booked it with the mean speeds of the impulses alone.
void Stepper::book_rest(double work, WorkBook book)
{
    const Bodies& bodies = world_.host().bodies;
    const auto driven = [&](const FoundContact& f)
    { return bodies.motion[f.contact.a.index] == Motion::Kinematic || bodies.motion[f.contact.b.index] == Motion::Kinematic; };
    if (!(work > 0) || touching_.empty() || std::any_of(touching_.begin(), touching_.end(), driven)) return;
    const std::uint32_t response = detectors_[touching_.front().detector].response;
    (*book.work)[response] -= book.sign * work;
    contact_energy_[response].made += book.sign * work;
}

void Stepper::keep_impulses(const std::vector<FoundContact>& contacts, double from, double h)
{
    for (std::size_t i = 0, end = 0; i < contacts.size(); i = end)
    {
        const Contact& first = contacts[i].contact;
        PairState* const pair = cache_.find(detectors_[contacts[i].detector].component, first.a, first.b, world_);
        double presses = 0, parting = HUGE_VAL;
        for (end = i; end < contacts.size() && same_pair(contacts[end], contacts[i]); ++end)
        {
            const Contact& c = contacts[end].contact;
            presses += dot(c.impulse, c.normal);
            parting = std::min(parting, normal_velocity(c) - c.turning + std::max(0.0, -c.depth) / h);
        }
        if (!pair) continue;
        note_release(*pair, first, presses, parting, from, h);
        for (std::size_t k = i; k < end; ++k)
        {
            cache_.contact_of(*pair, contacts[k].contact.feature).impulse = contacts[k].contact.impulse;
            pair->normal = contacts[k].contact.normal;
        }
    }
}

}  // namespace plab::simulation
