#include "simulation/contacts/impulse_islands.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace plab::simulation
{

/// Whether corners of a persistent pair reach the other body within the step, faster than forces alone would move them there. Evaluates
/// the forces at the start of the step only if that decides.
bool ImpulseIslands::meets_any(GroupSystem& system, double h) const
{
    double least = kNoApproach * least_gyration(step_.world.host().bodies, system.bodies()) / h;
    const auto meets = [&](const FoundContact& f)
    {
        const double closing = -contacts_.normal_velocity(f.contact);
        return closing > least && closing * h > -f.contact.depth;
    };
    if (std::none_of(touching_.begin(), touching_.end(), meets)) return false;
    system.evaluate(0, 0);
    for (std::size_t i = 0; i < system.bodies().size(); ++i) least = std::max(least, 2 * h * length(system.acceleration(i)));
    return std::any_of(touching_.begin(), touching_.end(), meets);
}

/// Stops such corners without a bounce before the step: moving with the mean of the velocities before and after the impact would carry
/// them into the other body.
void ImpulseIslands::stop_closing(std::span<const std::uint32_t> island, double from, double to, WorkBook book)
{
    for (FoundContact& f : touching_) f.contact.impulse = {};
    contacts_.respond(touching_, ImpactMode::Rest, to - from, book);
    log_touching(island, from, to, true, book);
    // The impulse of the impact is not an estimate of how hard the contact will press; that of the last step is.
    contacts_.warm_start(touching_, false);
}

void ImpulseIslands::advance(std::span<const std::uint32_t> island, std::span<const std::uint32_t> observed, double from, double to,
                             WorkBook book, bool trial, bool begins)
{
    const double h = to - from;
    Bodies& bodies = step_.world.host().bodies;
    Shafts& shafts = step_.world.host().shafts;
    GroupSystem& system = motion_.system_for(island, observed);
    touching_.clear();
    contacts_.touching_pairs_of(island, touching_, h);
    contacts_.warm_start(touching_, begins);
    system.begin(from, to, book, trial ? nullptr : &step_);
    members_.resize(system.bodies().size());
    std::iota(members_.begin(), members_.end(), 0u);
    const bool at_midpoint = advance_to_midpoint(system, h);
    if (!at_midpoint && !trial) report_paradoxes(from);
    if (!at_midpoint && meets_any(system, h))
    {
        stop_closing(island, from, to, book);
        system.join();
        system.begin(from, to, book, trial ? nullptr : &step_);  // the work of forces is booked with the speeds that the impact leaves
    }
    if (!at_midpoint) system.go_midway();
    system.evaluate_here();
    system.leave_midway();
    if (at_midpoint) update_touching(h);
    if (at_midpoint && !trial) report_paradoxes(from);

    moved_.kick(system, bodies, members_, h);
    if (!trial) positions_.note_forces(system);
    contacts_.respond(touching_, ImpactMode::Rest, h, book);
    log_touching(island, from, to, false, book);
    if (!trial) keep_impulses(touching_, from, h);
    system.join();  // contact impulses ignore joints: project the velocities onto them
    const double work = moved_.move_mean(h);
    if (at_midpoint) midpoint_.take_back();
    if (book.work && !system.rows()) book_rest(work, book);
    system.move_shafts(h, shafts);
    system.move_prescribed();
    system.project();
    motion_.finish_advance(system, system.all_finite(), to, trial);
}

/// Advances an island to the midpoint if a body moves along a curved surface and there is no impact.
bool ImpulseIslands::advance_to_midpoint(GroupSystem& system, double h)
{
    const auto turns = [&](const FoundContact& f) { return midpoint_.turns(f.contact, h); };
    const auto is_driven = [&](const FoundContact& f) { return midpoint_.is_driven(f.contact); };
    if (system.rows() || std::none_of(touching_.begin(), touching_.end(), turns)) return false;
    if (std::any_of(touching_.begin(), touching_.end(), is_driven)) return false;
    if (meets_any(system, h)) return false;
    system.evaluate(0, 0);
    midpoint_.advance_to_midpoint(system, members_, h);
    return true;
}

void ImpulseIslands::update_touching(double h)
{
    places_.resize(touching_.size());
    std::iota(places_.begin(), places_.end(), 0u);
    midpoint_.update_contacts(places_, touching_, h);
}

void ImpulseIslands::report_paradoxes(double from)
{
    for (const FoundContact& f : touching_)
        if (contacts_.is_paradox(f.contact)) contacts_.report_paradox(f.contact, *contacts_.find_pair(f), step_.frame.start_time + from);
}

/// Notes what the touching points took. An advance whose work is taken back has nothing left from its start on.
void ImpulseIslands::log_touching(std::span<const std::uint32_t> island, double from, double to, bool is_impact, WorkBook book)
{
    ContactLog& log = contacts_.log();
    if (!log.on() || !book.work) return;
    if (book.sign < 0)
        return log.take_back(from, [&](Ref r) { return std::binary_search(island.begin(), island.end(), step_.groups.of(r)); });
    for (const FoundContact& f : touching_)
        if (!is_impact || !(f.contact.impulse == Vec3{}))
            log.add(f.contact, contacts_.detectors()[f.detector].component, f.contact.depth, from, to, is_impact);
}

/// Corrects the booked work of resting contacts. Along the actual displacements it must not be positive if no kinematic body takes part.
/// Any excess is energy that the method created: it is moved to ContactEnergy::created, so that it remains unexplained in the ledger.
/// ContactBook::respond() has booked the impulses at their mean velocities.
void ImpulseIslands::book_rest(double work, WorkBook book)
{
    const Bodies& bodies = step_.world.host().bodies;
    const auto driven = [&](const FoundContact& f)
    { return bodies.motion[f.contact.a.index] == Motion::Kinematic || bodies.motion[f.contact.b.index] == Motion::Kinematic; };
    if (!(work > 0) || touching_.empty() || std::any_of(touching_.begin(), touching_.end(), driven)) return;
    const std::uint32_t response = contacts_.detectors()[touching_.front().detector].response;
    (*book.work)[response] -= book.sign * work;
    step_.contact_energy[response].created += book.sign * work;
}

void ImpulseIslands::keep_impulses(std::span<FoundContact> contacts, double from, double h)
{
    std::size_t near = 0;
    for (std::size_t i = 0, end = 0; i < contacts.size(); i = end)
    {
        for (end = i; end < contacts.size() && same_pair(contacts[end], contacts[i]);) ++end;
        const std::span<FoundContact> own = contacts.subspan(i, end - i);
        if (PairState* const pair = contacts_.find_pair(own.front(), near)) keep_impulses_of(*pair, own, from, h);
    }
}

void ImpulseIslands::keep_impulses_of(PairState& pair, std::span<FoundContact> contacts, double from, double h)
{
    ContactCache& cache = contacts_.cache();
    ContactBook::Pressing pressing = contacts_.pressing_of(pair);
    for (FoundContact& f : contacts) pressing.add_impulse(f.contact, cache.contact_of(pair, f).impulse);
    if (contacts_.stops_pressing(pair, pressing))
    {
        for (FoundContact& f : contacts)
            pressing.add_speed(f.contact, cache.contact_of(pair, f).impulse, f.contact.depth, contacts_.normal_velocity(f.contact), h);
        contacts_.note_release(pair, contacts.front().contact, pressing, from, h);
    }
    for (FoundContact& f : contacts) cache.contact_of(pair, f).impulse = f.contact.impulse, pair.normal = f.contact.normal;
}

}  // namespace plab::simulation
