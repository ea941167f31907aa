// Contacts of islands that managers hold: which of them are known, which pairs become persistent, and what is kept for the next step.
#include <algorithm>
#include <cmath>

#include "simulation/contacts/held_islands.h"
#include "simulation/contacts/paradox.h"

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
    contacts_.detect_all();
    adopt(contacts_.found(), step_.frame.start_time);
    note_state();
}

void HeldIslands::adopt(std::vector<FoundContact>& found, double time)
{
    fresh_.clear(), first_found_.clear();
    const std::span<const PairKey> keys = contacts_.cache().keys();
    std::size_t at = 0;
    for (const FoundRun& run : contacts_.runs())
    {
        while (at < keys.size() && keys[at] < run.key) ++at;
        if (at < keys.size() && keys[at] == run.key) continue;
        const FoundContact& first = found[run.first];
        const Detector& d = contacts_.detectors()[first.detector];
        if (!d.by_rows || !d.persists()) continue;
        double deepest = first.contact.depth;
        for (std::uint32_t i = run.first; i < run.end; ++i) deepest = std::max(deepest, found[i].contact.depth);
        PairState& pair = fresh_.emplace_back();
        pair.detector = d.component, pair.a = first.contact.a, pair.b = first.contact.b, pair.since = step_.frame.tick;
        pair.resting = true, pair.normal = first.contact.normal;
        pair.ahead = deepest <= -contacts_.persistence_margin(pair);
        if (pair.ahead && !d.speculates)
            fresh_.pop_back();
        else
            first_found_.push_back(run.first);
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

/// Collects the contacts of the held groups at the present state. Those of detectors that persist are known if nothing has moved since the
/// last detection. Contacts of the other detectors are detected anew, because they depend on which pairs have come to rest in the meantime:
/// this way the result is a function of the state alone, whatever happened before.
void HeldIslands::collect_contacts(double from, double h, bool trial)
{
    touching_.clear();
    run_count_ = 0;
    const auto& detectors = contacts_.detectors();
    const bool locates = std::any_of(detectors.begin(), detectors.end(), [](const Detector&d) { return !d.persists(); }),
               persists = std::any_of(detectors.begin(), detectors.end(), [](const Detector&d) { return d.persists(); });
    const bool known = persists && from == 0 && is_current();
    if (!known || locates)
    {
        contacts_.touching_pairs_of(held_, touching_, h);
        contacts_.warm_start(touching_, trial);
    }
    if (known) std::erase_if(touching_, [&](const FoundContact& f) { return detectors[f.detector].persists(); });
    share_touching(h);
    if (known) share_known(h, trial);
}

void HeldIslands::share_touching(double h)
{
    std::size_t near = 0;
    for (std::size_t i = 0, end = 0; i < touching_.size(); i = end)
    {
        for (end = i; end < touching_.size() && same_pair(touching_[end], touching_[i]);) ++end;
        HeldIsland* const island = begin_run(touching_[i], contacts_.find_pair(touching_[i], near));
        if (!island) continue;
        for (std::size_t k = i; k < end; ++k) island->contacts.push_back(touching_[k].contact), island->slots.push_back(touching_[k].slot);
        end_run(*island, h);
    }
}

/// Shares out what the last detection found of persistent pairs.
void HeldIslands::share_known(double h, bool trial)
{
    std::vector<FoundContact>& found = contacts_.found();
    const std::span<const PairKey> keys = contacts_.cache().keys();
    const std::span<PairState> pairs = contacts_.cache().pairs();
    std::uint32_t law_detector = kNoIndex;
    SurfaceLaw law;
    std::size_t at = 0;
    for (const FoundRun& found_run : contacts_.runs())
    {
        while (at < keys.size() && keys[at] < found_run.key) ++at;
        if (at + PairState::kAhead < pairs.size()) pairs[at + PairState::kAhead].prefetch();
        const FoundContact& first = found[found_run.first];
        if (at == keys.size() || keys[at] != found_run.key || !pairs[at].resting) continue;
        if (!contacts_.detectors()[first.detector].persists()) continue;
        HeldIsland* const island = begin_run(first, &pairs[at]);
        if (!island) continue;
        if (first.detector != law_detector) law_detector = first.detector, law = contacts_.response_law(law_detector);
        add_known(*island, std::span(found).subspan(found_run.first, found_run.end - found_run.first), pairs[at], law, trial);
        end_run(*island, h);
    }
}

void HeldIslands::add_known(HeldIsland& island, std::span<FoundContact> found, PairState& pair, const SurfaceLaw& law, bool trial)
{
    const world::HostTables& host = step_.world.host();
    const std::uint32_t ma = host.bodies.material[pair.a.index], mb = host.bodies.material[pair.b.index];
    const SurfaceLaw* own = ma != 0 && mb != 0 ? host.materials.find_pair(ma, mb) : nullptr;
    const SurfaceLaw& valid = own ? *own : law;
    for (FoundContact& f : found)
    {
        KnownContact& known = contacts_.cache().contact_of(pair, f);
        Contact& c = island.contacts.emplace_back(f.contact);
        c.friction = valid.friction, c.restitution = valid.restitution;
        c.id = known.id, c.impulse = known.warm_start(trial);
        c.depth -= known.rest_depth;  // overlap left by a swapped-out spring is removed gradually
        c.resting = true;
        island.slots.push_back(f.slot);
    }
}

/// The island to which the contacts of a pair belong, with a run for them; null if it is not held in this advance.
HeldIslands::HeldIsland* HeldIslands::begin_run(const FoundContact& first, PairState* pair)
{
    const Bodies& bodies = step_.world.host().bodies;
    const std::uint32_t order = run_count_++;
    for (const Ref r : {first.contact.a, first.contact.b})
    {
        if (!bodies.dynamic(r.index) || step_.groups.of(r) == kNoIndex) continue;
        const std::uint32_t number = island_of_group_[step_.groups.of(r)];
        if (number == kNoIndex) continue;
        HeldIsland& island = *islands_[number];
        island.runs.push_back({pair, first.detector, static_cast<std::uint32_t>(island.contacts.size()), 0, order, 0});
        return &island;
    }
    return nullptr;
}

void HeldIslands::end_run(HeldIsland& island, double h)
{
    Run& run = island.runs.back();
    run.end = static_cast<std::uint32_t>(island.contacts.size());
    const std::span<const Contact> own = island.of(run);
    for (const Contact& c : own) run.most_depth = std::max(run.most_depth, std::fabs(c.depth));
    island.driven = island.driven || midpoint_.is_driven(own.front());
    if (island.turns || island.has_rows) return;
    island.turns = std::any_of(own.begin(), own.end(), [&](const Contact& c) { return midpoint_.turns(c, h); });
}

/// Sets Contact::approach, the closing speed of impacts. A contact counts as an impact if it had no impulse in the last step and closes
/// faster than half the speed that forces would give it in this one, or if it had an impulse and closes faster than twice that speed.
/// Slower contacts jitter or come to rest, and get no restitution. The speed is that of a whole step also in a part of one: what counts
/// as an impact must not depend on how far a trial goes.
void HeldIslands::set_approach(HeldIsland& island, const GroupSystem& system, double h)
{
    for (std::size_t k = 0; k < island.members.size(); ++k)
        given_speed_[island.bodies[k]] = length(system.acceleration(island.members[k])) * step_.frame.step;
    const double least = kNoApproach * least_gyration(step_.world.host().bodies, island.bodies) / h;
    for (Contact& c : island.contacts)
    {
        const double speed = contacts_.normal_velocity(c), given = std::max(given_speed_[c.a.index], given_speed_[c.b.index]);
        const double share = c.impulse == Vec3{} ? 0.5 : 2;
        c.approach = speed < -std::max(least, share * given) ? -speed : 0.0;
        island.meets = island.meets || c.approach > 0;
    }
    for (const std::uint32_t b : island.bodies) given_speed_[b] = 0;
}

void HeldIslands::report_paradoxes(HeldIsland& island, double time)
{
    wedging_.resize(step_.world.host().bodies.size(), 0.0);
    for (const std::uint32_t b : island.bodies) wedging_[b] = contacts_.wedging_of(b);
    for (const Run& run : island.runs)
    {
        const std::span<const Contact> own = island.of(run);
        const Ref a = own.front().a, b = own.front().b;
        // Where bodies are ahead of the start of the step, points may be anywhere near them.
        const bool is_near = !island.turns && run.most_depth <= contacts_.depth_that_excludes(a, b);
        if (is_near && excludes_paradox(own.front().friction, std::max(wedging_[a.index], wedging_[b.index]))) continue;
        for (const Contact& c : own)
            if (contacts_.is_paradox(c)) contacts_.report_paradox(c, *run.pair, time);
    }
    for (const std::uint32_t b : island.bodies) wedging_[b] = 0;
}

/// Notes releases and keeps the impulses for the next step.
void HeldIslands::keep(HeldIsland& island, double from, double h)
{
    for (std::size_t k = 0; k < island.runs.size(); ++k)
    {
        if (k + PairState::kAhead < island.runs.size()) island.runs[k + PairState::kAhead].pair->prefetch();
        const Run& run = island.runs[k];
        const std::span<Contact> own = island.of(run);
        if (is_released(island, run, from, h))
            for (Contact& c : own) c.impulse = {};
        // The impulse of an impact is not an estimate of how hard the contact will press in the next step.
        for (std::uint32_t i = run.first; i < run.end; ++i)
            kept(island, run, i).impulse = island.contacts[i].approach > 0 ? Vec3{} : island.contacts[i].impulse;
        run.pair->normal = own.back().normal;
    }
}

KnownContact& HeldIslands::kept(const HeldIsland& island, const Run& run, std::uint32_t contact)
{
    return contacts_.cache().contact_of(*run.pair, island.contacts[contact].feature, island.slots[contact]);
}

/// Whether a pair pressed in the last step and does so no more; notes its release if all its points separate.
bool HeldIslands::is_released(HeldIsland& island, const Run& run, double from, double h)
{
    ContactBook::Pressing pressing = contacts_.pressing_of(*run.pair);
    bool is_hit = false;
    for (std::uint32_t i = run.first; i < run.end; ++i)
    {
        pressing.add_impulse(island.contacts[i], kept(island, run, i).impulse);
        is_hit = is_hit || island.contacts[i].approach > 0;
    }
    if (is_hit) pressing.now = HUGE_VAL;  // a pair with an impact is not released
    if (!contacts_.stops_pressing(*run.pair, pressing)) return false;
    for (std::uint32_t i = run.first; i < run.end; ++i)
        pressing.add_speed(island.contacts[i], kept(island, run, i).impulse, island.motion.start_depth(i),
                           island.motion.separation_speed(i), h);
    contacts_.note_release(*run.pair, island.contacts[run.first], pressing, from, h);
    return true;
}

void HeldIslands::report_impacts(const HeldIsland& island, double time)
{
    for (const Run& run : island.runs)
        for (std::uint32_t i = run.first; i < run.end; ++i)
        {
            Contact c = island.contacts[i];
            if (!(c.approach > 0) || c.impulse == Vec3{}) continue;
            c.depth = island.motion.start_depth(i);
            if (PairState& pair = *run.pair; pair.ahead) pair.ahead = false, pair.since = step_.frame.tick, report_begin(pair, c, time);
            step_.emit(contacts_.contact_event("contact.impact", *run.pair, time, c, c.impulse));
        }
}

}  // namespace plab::simulation
