// Contacts of islands that managers hold: which of them are known, which pairs become persistent, and what is kept for the next step.
#include <algorithm>
#include <atomic>
#include <cmath>

#include "simulation/contacts/held_islands.h"

namespace plab::simulation
{
// Known pairs ---------------------------------------------------------------------------------------------------------

void HeldIslands::note_state()
{
    const Bodies& bodies = step_.world.host().bodies;
    known_positions_ = bodies.position, known_orientations_ = bodies.orientation;
    known_velocities_ = bodies.velocity, known_spins_ = bodies.angular_velocity;
    known_ = true;
}

bool HeldIslands::is_current() const
{
    const Bodies& bodies = step_.world.host().bodies;
    if (!known_ || known_positions_ != bodies.position || known_orientations_ != bodies.orientation) return false;
    // The margin up to which gaps are detected depends on velocities.
    return known_velocities_ == bodies.velocity && known_spins_ == bodies.angular_velocity;
}

void HeldIslands::begin_step()
{
    find_yielding_rows();
    const bool any_persists = std::any_of(contacts_.detectors().begin(), contacts_.detectors().end(),
                                          [](const Detector& d) { return d.by_rows && d.persists(); });
    if (!any_persists || is_current()) return;
    contacts_.detect_all(contacts_.found());
    adopt(contacts_.found(), step_.frame.start_time);
    note_state();
}

void HeldIslands::adopt(std::vector<FoundContact>& found, double time)
{
    fresh_.clear(), first_found_.clear();
    std::size_t near = 0;
    for (std::size_t i = 0; i < found.size();)
    {
        const FoundContact& first = found[i];
        double deepest = first.contact.depth;
        std::size_t end = i;
        for (; end < found.size() && same_pair(found[end], first); ++end) deepest = std::max(deepest, found[end].contact.depth);
        const Detector& d = contacts_.detectors()[first.detector];
        if (d.by_rows && d.persists() && !contacts_.cache().find(d.component, first.contact.a, first.contact.b, step_.world, near))
        {
            PairState& pair = fresh_.emplace_back();
            pair.detector = d.component, pair.a = first.contact.a, pair.b = first.contact.b, pair.since = step_.frame.tick;
            pair.resting = true, pair.normal = first.contact.normal;
            pair.ahead = deepest <= -contacts_.persistence_margin(pair);
            if (pair.ahead && !d.speculates)
                fresh_.pop_back();
            else
                first_found_.push_back(i);
        }
        i = end;
    }
    if (fresh_.empty()) return;
    contacts_.cache().add_sorted(fresh_, step_.world);
    contacts_.resting().forget();
    for (std::size_t k = 0; k < fresh_.size(); ++k)
        if (!fresh_[k].ahead) report_begin(fresh_[k], found[first_found_[k]].contact, time);
}

void HeldIslands::report_begin(const PairState& pair, const Contact& c, double time) const
{
    step_.emit(contacts_.contact_event("contact.begin", pair, time, c));
}

bool HeldIslands::keeps_ahead(PairState& pair, bool touches, std::span<const FoundContact> found, double time) const
{
    if (touches && pair.ahead) pair.ahead = false, pair.since = step_.frame.tick, report_begin(pair, found.front().contact, time);
    return !touches && !found.empty() && contacts_.detectors()[found.front().detector].speculates;
}

void HeldIslands::pass_on(PairState& pair, std::uint32_t known, std::span<const FoundContact> found) const
{
    if (!any_ || known >= pair.count || manager_of(pair) == kNoIndex) return;
    const auto seen = [&](const KnownContact& k)
    { return std::any_of(found.begin(), found.end(), [&](const FoundContact& f) { return f.contact.feature == k.feature; }); };
    Vec3 left;
    for (std::uint32_t i = 0; i < known; ++i)
        if (!seen(pair.contacts[i])) left += pair.contacts[i].impulse;
    const double share = 1.0 / (pair.count - known);
    for (std::uint32_t i = known; i < pair.count; ++i) pair.contacts[i].impulse = left * share;
}

// Contacts ------------------------------------------------------------------------------------------------------------

void HeldIslands::fill(FoundContact& f, PairState& pair, const SurfaceLaw& law, bool trial)
{
    const world::HostTables& host = step_.world.host();
    const std::uint32_t ma = host.bodies.material[f.contact.a.index], mb = host.bodies.material[f.contact.b.index];
    const SurfaceLaw* own = ma != 0 && mb != 0 ? host.materials.find_pair(ma, mb) : nullptr;
    f.contact.friction = (own ? own : &law)->friction, f.contact.restitution = (own ? own : &law)->restitution;
    KnownContact& known = contacts_.cache().contact_of(pair, f.contact.feature);
    f.contact.id = known.id, f.contact.impulse = known.warm_start(trial);
    f.contact.depth -= known.rest_depth;  // overlap left by a swapped-out spring is removed gradually
    f.contact.resting = true;
}

/// Collects the contacts of the held groups at the present state. Those of detectors that persist are known if nothing has moved since the
/// last detection. Contacts of the other detectors are detected anew, because they depend on which pairs have come to rest in the meantime:
/// this way the result is a function of the state alone, whatever happened before.
void HeldIslands::collect_contacts(double from, double h, bool trial)
{
    touching_.clear(), pair_of_contact_.clear();
    const auto& detectors = contacts_.detectors();
    std::size_t near = 0;
    const auto pair_of = [&](const FoundContact& f)
    { return contacts_.cache().find(detectors[f.detector].component, f.contact.a, f.contact.b, step_.world, near); };
    const bool locates = std::any_of(detectors.begin(), detectors.end(), [](const Detector&d) { return !d.persists(); }),
               persists = std::any_of(detectors.begin(), detectors.end(), [](const Detector&d) { return d.persists(); });
    const bool known = persists && from == 0 && is_current();
    if (!known || locates)
    {
        contacts_.touching_pairs_of(held_, touching_, h);
        contacts_.warm_start(touching_, trial);
    }
    if (!known)
    {
        for (const FoundContact& f : touching_) pair_of_contact_.push_back(pair_of(f));
        return;
    }
    std::erase_if(touching_, [&](const FoundContact& f) { return detectors[f.detector].persists(); });
    for (const FoundContact& f : touching_) pair_of_contact_.push_back(pair_of(f));
    add_known_contacts(trial);
}

/// Adds what the last detection found of persistent pairs. Both lists are sorted by detector, a and b.
void HeldIslands::add_known_contacts(bool trial)
{
    std::size_t at = 0;
    std::uint32_t law_detector = kNoIndex;
    SurfaceLaw law;
    for (PairState& pair : contacts_.cache().pairs())
    {
        at = contacts_.first_of_pair(pair, at);
        for (; at < contacts_.found().size() && contacts_.is_of_pair(contacts_.found()[at], pair); ++at)
        {
            if (!pair.resting || !contacts_.detectors()[contacts_.found()[at].detector].persists()) continue;
            FoundContact& f = touching_.emplace_back(contacts_.found()[at]);
            if (f.detector != law_detector) law = contacts_.response_law(f.detector), law_detector = f.detector;
            fill(f, pair, law, trial);
            pair_of_contact_.push_back(&pair);
        }
    }
}

std::uint32_t HeldIslands::island_of(const Contact& c) const
{
    for (const Ref r : {c.a, c.b})
    {
        if (!step_.world.host().bodies.dynamic(r.index) || step_.groups.of(r) == kNoIndex) continue;
        if (const std::uint32_t number = island_of_group_[step_.groups.of(r)]; number != kNoIndex) return number;
    }
    return kNoIndex;
}

/// Distributes the contacts over the islands; those of an island keep their order.
void HeldIslands::share_contacts(double h)
{
    const std::size_t all = touching_.size();
    island_numbers_.resize(all), turning_.resize(all), ranks_.resize(all);
    for_parts(&step_.workers, all, kPart,
              [&](std::size_t begin, std::size_t end)
              {
                  for (std::size_t i = begin; i < end; ++i)
                  {
                      const Contact& c = touching_[i].contact;
                      const std::uint32_t number = island_numbers_[i] = island_of(c);
                      turning_[i] = number != kNoIndex && !islands_[number]->has_rows && midpoint_.turns(c, h) ? 1 : 0;
                  }
              });
    for (std::size_t i = 0; i < all; ++i)
    {
        if (island_numbers_[i] == kNoIndex) continue;
        HeldIsland& island = *islands_[island_numbers_[i]];
        ranks_[i] = island.count++;
        island.turns = island.turns || turning_[i] != 0;
    }
    std::uint32_t shared = 0;
    for (std::size_t k = 0; k < island_count_; ++k) islands_[k]->first = shared, shared += islands_[k]->count;
    contacts_of_islands_.resize(shared), places_.resize(shared), paradoxes_.resize(shared);
    for (std::size_t k = 0; k < island_count_; ++k)
        islands_[k]->contacts = std::span(contacts_of_islands_).subspan(islands_[k]->first, islands_[k]->count),
        islands_[k]->places = std::span(places_).subspan(islands_[k]->first, islands_[k]->count);
    for_parts(&step_.workers, all, kPart,
              [&](std::size_t begin, std::size_t end)
              {
                  for (std::size_t i = begin; i < end; ++i)
                  {
                      if (island_numbers_[i] == kNoIndex) continue;
                      const std::size_t to = islands_[island_numbers_[i]]->first + ranks_[i];
                      contacts_of_islands_[to] = touching_[i].contact, places_[to] = static_cast<std::uint32_t>(i);
                  }
              });
}

/// Sets Contact::approach, the closing speed of impacts. A contact counts as an impact if it had no impulse in the last step and closes
/// faster than half the speed that forces would give it in this one, or if it had an impulse and closes faster than twice that speed.
/// Slower contacts jitter or come to rest, and get no restitution. The speed is that of a whole step also in a part of one: what counts
/// as an impact must not depend on how far a trial goes.
void HeldIslands::set_approach(HeldIsland& island, const GroupSystem& system, double h)
{
    std::atomic<double> smallest{-HUGE_VAL};  // negative, as raise_to() finds the largest
    for_parts(&step_.workers, island.members.size(), kPart,
              [&](std::size_t begin, std::size_t end)
              {
                  for (std::size_t k = begin; k < end; ++k)
                      given_speed_[island.bodies[k]] = length(system.acceleration(island.members[k])) * step_.frame.step;
                  raise_to(smallest, -least_gyration(step_.world.host().bodies, std::span(island.bodies).subspan(begin, end - begin)));
              });
    island.size = island.members.empty() ? 0.0 : -smallest;
    const double least = kNoApproach * island.size / h;
    for_parts(&step_.workers, island.contacts.size(), kPart,
              [&](std::size_t begin, std::size_t end)
              {
                  for (Contact& c : island.contacts.subspan(begin, end - begin))
                  {
                      const double speed = contacts_.normal_velocity(c), given = std::max(given_speed_[c.a.index], given_speed_[c.b.index]);
                      const double share = c.impulse == Vec3{} ? 0.5 : 2;
                      c.approach = speed < -std::max(least, share * given) ? -speed : 0.0;
                  }
              });
    for (const std::uint32_t b : island.bodies) given_speed_[b] = 0;
}

void HeldIslands::keep(const HeldIsland& island)
{
    for (std::size_t i = 0; i < island.contacts.size(); ++i)
    {
        const Contact& c = island.contacts[i];
        PairState& pair = *pair_of_contact_[island.places[i]];
        // The impulse of an impact is not an estimate of how hard the contact will press in the next step.
        contacts_.cache().contact_of(pair, c.feature).impulse = c.approach > 0 ? Vec3{} : c.impulse;
        pair.normal = c.normal;
    }
}

/// Finds pairs that pressed in the last step and whose points all separate now.
void HeldIslands::note_releases(HeldIsland& island, double from, double h) const
{
    for (std::size_t i = 0, end = 0; i < island.contacts.size(); i = end)
    {
        PairState& pair = *pair_of_contact_[island.places[i]];
        ContactBook::Pressing pressing;
        bool is_hit = false;
        for (end = i; end < island.contacts.size() && pair_of_contact_[island.places[end]] == &pair; ++end)
        {
            Contact c = island.contacts[end];
            c.depth = touching_[island.places[end]].contact.depth;
            contacts_.add_point(pressing, pair, c, island.motion.separation_speed(end), h);
            is_hit = is_hit || c.approach > 0;
        }
        if (is_hit) pressing.now = HUGE_VAL;  // a pair with an impact is not released
        if (!contacts_.note_release(pair, island.contacts[i], pressing, from, h)) continue;
        for (std::size_t k = i; k < end; ++k) island.contacts[k].impulse = {};
    }
}

void HeldIslands::report_paradoxes(const HeldIsland& island, double time)
{
    for (std::size_t i = 0; i < island.contacts.size(); ++i)
        if (paradoxes_[island.first + i] != 0) contacts_.report_paradox(island.contacts[i], *pair_of_contact_[island.places[i]], time);
}

void HeldIslands::report_impacts(const HeldIsland& island, double time)
{
    for (std::size_t i = 0; i < island.contacts.size(); ++i)
    {
        const Contact& c = island.contacts[i];
        if (!(c.approach > 0) || c.impulse == Vec3{}) continue;
        PairState& pair = *pair_of_contact_[island.places[i]];
        if (pair.ahead) pair.ahead = false, pair.since = step_.frame.tick, report_begin(pair, touching_[island.places[i]].contact, time);
        Event e = contacts_.contact_event("contact.impact", pair, time, c, c.impulse);
        e.contact->depth = touching_[island.places[i]].contact.depth;
        step_.emit(std::move(e));
    }
}

}  // namespace plab::simulation
