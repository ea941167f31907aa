// Contacts of islands that managers hold: which of them are known, which pairs become persistent, and what is kept for the next step.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>

#include "plab/pivot.h"
#include "simulation/contacts/held_islands.h"

namespace plab::simulation
{
namespace
{

/// Whether a contact of the same pair had an impulse in the last step.
bool pair_presses(std::span<const Contact> contacts, std::size_t i)
{
    const auto same = [&](std::size_t k) { return contacts[k].a == contacts[i].a && contacts[k].b == contacts[i].b; };
    std::size_t begin = i, end = i;
    while (begin > 0 && same(begin - 1)) --begin;
    while (end < contacts.size() && same(end)) ++end;
    return std::ranges::any_of(contacts.subspan(begin, end - begin), [](const Contact& c) { return c.impulse != Vec3{}; });
}

}  // namespace

// Known pairs ---------------------------------------------------------------------------------------------------------

void HeldIslands::note_state()
{
    const Bodies& bodies = step_.world.host().bodies;
    const RestState& rest = contacts_.cache().rest();
    const std::vector<std::uint32_t>* const some = known_ ? rest.changing_since(known_mark_) : nullptr;
    known_ = true, known_mark_ = rest.mark, known_found_ = contacts_.found_revision();
    if (some)
        for (const std::uint32_t b : *some)
        {
            known_positions_[b] = bodies.position[b], known_orientations_[b] = bodies.orientation[b];
            known_velocities_[b] = bodies.velocity[b], known_spins_[b] = bodies.angular_velocity[b];
        }
    else
    {
        known_positions_ = bodies.position, known_orientations_ = bodies.orientation;
        known_velocities_ = bodies.velocity, known_spins_ = bodies.angular_velocity;
    }
}

bool HeldIslands::is_current() const
{
    const Bodies& bodies = step_.world.host().bodies;
    // Events may have been looked for at the end of the step since.
    if (!known_ || known_found_ != contacts_.found_revision()) return false;
    // The margin up to which gaps are detected depends on velocities.
    if (const std::vector<std::uint32_t>* const some = contacts_.cache().rest().changing_since(known_mark_))
        return std::all_of(some->begin(), some->end(),
                           [&](std::uint32_t b)
                           {
                               return known_positions_[b] == bodies.position[b] && known_orientations_[b] == bodies.orientation[b] &&
                                      known_velocities_[b] == bodies.velocity[b] && known_spins_[b] == bodies.angular_velocity[b];
                           });
    if (known_positions_ != bodies.position || known_orientations_ != bodies.orientation) return false;
    return known_velocities_ == bodies.velocity && known_spins_ == bodies.angular_velocity;
}

void HeldIslands::begin_step(bool other_crowds)
{
    find_yielding_rows();
    const bool any_persists = std::any_of(contacts_.detectors().begin(), contacts_.detectors().end(),
                                          [](const Detector& d) { return d.by_rows && d.may_persist(); });
    const bool current = is_current();
    if (!any_persists || (current && !other_crowds)) return;
    if (!current) contacts_.detect_all();
    adopt(contacts_.found(), step_.frame.start_time);
    note_state();
}

void HeldIslands::adopt(std::vector<FoundContact>& found, double time)
{
    fresh_.clear(), first_found_.clear(), passed_.clear();
    const std::span<const PairKey> keys = contacts_.cache().keys();
    std::size_t at = 0;
    for (const FoundRun& run : contacts_.runs())
    {
        while (at < keys.size() && keys[at] < run.key) ++at;
        if (at < keys.size() && keys[at] == run.key) continue;
        const FoundContact& first = found[run.first];
        const Detector& d = contacts_.detectors()[first.detector];
        if (!d.by_rows || !contacts_.persists(d, first.contact.a, first.contact.b)) continue;
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
    drop_passed(found);
    for (std::size_t k = 0; k < fresh_.size(); ++k)
        if (!fresh_[k].ahead) report_begin(fresh_[k], found[first_found_[k]].contact, time);
}

/// Whether a pair passes over a seam depends on the normals of others, which finish_step() has changed since. A run that is continued from
/// here would find it with those.
void HeldIslands::adopt_again(std::vector<FoundContact>& found, double time)
{
    std::swap(fresh_, adopted_);
    adopt(found, time);
    fresh_.insert(fresh_.end(), std::make_move_iterator(adopted_.begin()), std::make_move_iterator(adopted_.end()));
}

/// Drops those of the pairs that were added last whose bodies pass one another over a seam.
void HeldIslands::drop_passed(std::span<const FoundContact> found)
{
    const auto passes = [&](std::size_t first)
    {
        std::size_t end = first;
        while (end < found.size() && same_pair(found[end], found[first])) ++end;
        return contacts_.passes_over(found.subspan(first, end - first));
    };
    for (std::size_t k = 0; k < fresh_.size(); ++k)
        if (passes(first_found_[k])) passed_.push_back(k);
    if (passed_.empty()) return;
    auto next = passed_.begin();
    const auto is_next = [&](const PairState& p)
    {
        if (next == passed_.end()) return false;
        const PairState& passed = fresh_[*next];
        if (p.detector != passed.detector || p.a != passed.a || p.b != passed.b) return false;
        ++next;
        return true;
    };
    contacts_.cache().drop_if(is_next);
    for (auto k = passed_.rbegin(); k != passed_.rend(); ++k)
    {
        fresh_.erase(fresh_.begin() + static_cast<std::ptrdiff_t>(*k));
        first_found_.erase(first_found_.begin() + static_cast<std::ptrdiff_t>(*k));
    }
    contacts_.resting().forget();
}

void HeldIslands::report_begin(const PairState& pair, const Contact& c, double time) const
{
    step_.emit(contacts_.contact_event("contact.begin", pair, time, c));
}

bool HeldIslands::keeps_ahead(PairState& pair, bool touches, std::span<const FoundContact> found, double time) const
{
    if (touches && pair.ahead) pair.ahead = false, pair.since = step_.frame.tick, report_begin(pair, found.front().contact, time);
    if (touches || found.empty()) return false;
    const FoundContact& f = found.front();
    return contacts_.speculates(contacts_.detectors()[f.detector], f.contact.a, f.contact.b);
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
void HeldIslands::collect_contacts(double from, double h, bool begins)
{
    touching_.clear();
    run_count_ = 0;
    const auto& detectors = contacts_.detectors();
    const bool locates = std::any_of(detectors.begin(), detectors.end(), [](const Detector&d) { return !d.persists(); }),
               persists = std::any_of(detectors.begin(), detectors.end(), [](const Detector&d) { return d.may_persist(); });
    const bool known = persists && from == 0 && is_current();
    if (!known || locates)
    {
        contacts_.touching_pairs_of(held_, touching_, h, known);
        contacts_.warm_start(touching_, begins);
    }
    list_touching();
    if (known) list_known();
    all_.clear();
    for (std::size_t i = 0; i < island_count_; ++i) all_.push_back(islands_[i].get());
    fill(all_, h, begins);
}

void HeldIslands::list_touching()
{
    std::size_t near = 0;
    for (std::size_t i = 0, end = 0; i < touching_.size(); i = end)
    {
        for (end = i; end < touching_.size() && same_pair(touching_[end], touching_[i]);) ++end;
        add_run(std::span(touching_).subspan(i, end - i), contacts_.find_pair(touching_[i], near), false);
    }
}

/// Lists what the last detection found of persistent pairs.
void HeldIslands::list_known()
{
    const std::vector<FoundContact>& found = contacts_.found();
    const std::span<const PairKey> keys = contacts_.cache().keys();
    const std::span<PairState> pairs = contacts_.cache().pairs();
    std::size_t at = 0;
    for (const FoundRun& run : contacts_.runs())
    {
        while (at < keys.size() && keys[at] < run.key) ++at;
        if (at == keys.size() || keys[at] != run.key || !pairs[at].resting) continue;
        if (!contacts_.persists(contacts_.detectors()[found[run.first].detector], pairs[at].a, pairs[at].b)) continue;
        add_run(std::span(found).subspan(run.first, run.end - run.first), &pairs[at], true);
    }
}

/// Lists the contacts of a pair under their island, if that is held in this advance.
void HeldIslands::add_run(std::span<const FoundContact> found, PairState* pair, bool known)
{
    const Bodies& bodies = step_.world.host().bodies;
    const std::uint32_t order = run_count_++;
    for (const Ref r : {found.front().contact.a, found.front().contact.b})
    {
        if (!bodies.dynamic(r.index) || step_.groups.of(r) == kNoIndex) continue;
        const std::uint32_t number = island_of_group_[step_.groups.of(r)];
        if (number == kNoIndex) continue;
        HeldIsland& island = *islands_[number];
        Run run;
        run.pair = pair, run.found = found.data(), run.order = order, run.known = known;
        run.first = island.contact_count(), run.end = run.first + static_cast<std::uint32_t>(found.size());
        island.runs.push_back(run);
        island.driven = island.driven || midpoint_.is_driven(found.front().contact);
        return;
    }
}

/// Copies the contacts into their islands.
void HeldIslands::fill(std::span<HeldIsland*> islands, double h, bool begins)
{
    laws_.clear();
    for (std::uint32_t d = 0; d < contacts_.detectors().size(); ++d) laws_.push_back(contacts_.response_law(d));
    make_room(islands);
    share(islands,
          [&](HeldIsland& island)
          {
              for_parts(&step_.workers, island.runs.size(), kRunPart,
                        [&](std::size_t begin, std::size_t end)
                        {
                            for (std::size_t k = begin; k < end; ++k)
                            {
                                if (k + PairState::kAhead < end) island.runs[k + PairState::kAhead].pair->prefetch();
                                if (k + kRunsAhead < end) prefetch(island, island.runs[k + kRunsAhead]);
                                fill_run(island, island.runs[k], h, begins);
                            }
                        });
          });
    const bool any_resists = step_.world.host().materials.any_resists_turning() || std::ranges::any_of(laws_, &SurfaceLaw::resists_turning);
    for (HeldIsland* island : islands)
    {
        island->resistances.clear();
        if (any_resists) find_resistances(*island);
    }
    // A contact that its pair does not know yet gets an id, and ids are given in the order of the pairs.
    incomplete_.clear();
    for (HeldIsland* island : islands)
        for (const Run& run : island->runs)
            if (run.incomplete) incomplete_.push_back({island, &run});
    std::sort(incomplete_.begin(), incomplete_.end(), [](const RunOf& x, const RunOf& y) { return x.run->order < y.run->order; });
    for (const RunOf& r : incomplete_)
        for (std::uint32_t i = r.run->first; i < r.run->end; ++i)
        {
            FoundContact f = r.run->found[i - r.run->first];
            take_known(r.island->contacts[i], f.contact, contacts_.cache().contact_of(*r.run->pair, f), begins);
            r.island->slots[i] = f.slot;
        }
}

/// Gives each island memory for its contacts.
void HeldIslands::make_room(std::span<HeldIsland*> islands)
{
    std::size_t count = 0;
    for (const HeldIsland* island : islands) count += island->contact_count();
    if (contact_memory_.size() < count) contact_memory_.resize(count), slot_memory_.resize(count), jam_memory_.resize(count);
    const bool logs = contacts_.log().on();
    if (logs) further_memory_.assign(count, Vec3{});
    std::size_t first = 0;
    for (HeldIsland* island : islands)
    {
        const std::size_t own = island->contact_count();
        island->contacts = std::span(contact_memory_).subspan(first, own);
        island->slots = std::span(slot_memory_).subspan(first, own), island->jams = std::span(jam_memory_).subspan(first, own);
        island->further = logs ? std::span(further_memory_).subspan(first, own) : std::span<Vec3>();
        first += own;
    }
}

/// Asks for the memory between which fill_run() will copy contacts.
void HeldIslands::prefetch(const HeldIsland& island, const Run& run)
{
    constexpr std::size_t kLine = 64;
    const std::size_t count = run.end - run.first;
    const char* const from = reinterpret_cast<const char*>(run.found);
    for (std::size_t i = 0; i < count * sizeof(FoundContact); i += kLine) __builtin_prefetch(from + i, 0);
    const char* const to = reinterpret_cast<const char*>(island.contacts.data() + run.first);
    for (std::size_t i = 0; i < count * sizeof(Contact); i += kLine) __builtin_prefetch(to + i, 1);
}

/// That of the materials of the pair, or that of the response.
const SurfaceLaw& HeldIslands::law_of(const Run& run) const
{
    const world::HostTables& host = step_.world.host();
    const std::uint32_t ma = host.bodies.material[run.pair->a.index], mb = host.bodies.material[run.pair->b.index];
    const SurfaceLaw* own = host.materials.find_pair(ma, mb);
    return own ? *own : laws_[run.found->detector];
}

void HeldIslands::find_resistances(HeldIsland& island) const
{
    for (const Run& run : island.runs)
        if (const SurfaceLaw& law = law_of(run); law.resists_turning())
            island.resistances.push_back({run.first, run.end, law.rolling_friction, law.spinning_friction});
}

void HeldIslands::fill_run(HeldIsland& island, Run& run, double h, bool begins)
{
    const SurfaceLaw& law = run.known ? law_of(run) : laws_[run.found->detector];
    for (std::uint32_t i = run.first; i < run.end; ++i)
    {
        const FoundContact& f = run.found[i - run.first];
        Contact& c = island.contacts[i] = f.contact;
        island.slots[i] = f.slot;
        if (!run.known) continue;
        c.friction = law.friction, c.restitution = law.restitution;
        c.resting = true;
        const std::span<KnownContact> all = run.pair->all();
        std::uint32_t slot = f.slot;
        if (!(slot < all.size() && all[slot].feature == c.feature))
            for (slot = 0; slot < all.size() && all[slot].feature != c.feature;) ++slot;
        if (slot == all.size())
            run.incomplete = true;
        else
            take_known(c, f.contact, all[slot], begins), island.slots[i] = slot;
    }
    const std::span<const Contact> contacts = island.of(run);
    const double least = -contacts_.overlap_tolerance(contacts.front().a, contacts.front().b);
    for (const Contact& c : contacts)
        if (c.depth >= least) run.most_depth = std::max(run.most_depth, std::fabs(c.depth));
    if (island.has_rows) return;
    if (std::any_of(contacts.begin(), contacts.end(), [&](const Contact& c) { return midpoint_.turns(c, h) && !has_pivot(island, c, h); }))
        std::atomic_ref(island.turns).store(true, std::memory_order_relaxed);
}

/// Whether the island's manager puts the point midway itself (pivot.h), better than midpoint_contacts.h: bodies turn there as well. Balls
/// in bowls do not need that.
bool HeldIslands::has_pivot(const HeldIsland& island, const Contact& c, double h) const
{
    constexpr double kRounding = 0x1p-20;
    if (c.pivot.of == Pivot::Of::Neither || island.contacts.size() > step_.world.type_of(island.manager)->info.pivots_up_to) return false;
    const Bodies& bodies = step_.world.host().bodies;
    const Ref own = c.pivot.of == Pivot::Of::A ? c.a : c.b, face = c.pivot.of == Pivot::Of::A ? c.b : c.a;
    const auto turns_far = [&](double w) { return !(w * 0.5 * h < kFarthestTurn); };
    const auto spin = [&](Ref body)
    { return bodies.motion[body.index] == Motion::Static ? 0.0 : length(bodies.angular_velocity[body.index]); };
    if (turns_far(spin(own))) return false;
    if (c.pivot.hollow.is_flat()) return !turns_far(spin(face));
    const Vec3 fixed = c.point - c.pivot.arm;
    if (length(fixed - bodies.position[own.index]) <= kRounding * length(c.pivot.arm)) return false;
    const auto speed = [&](Ref body)
    { return bodies.motion[body.index] == Motion::Static ? Vec3{} : bodies.velocity_at(body.index, fixed); };
    return !turns_far(spin(face) + length(speed(own) - speed(face)) * length(c.pivot.hollow.vector()));
}

void HeldIslands::take_known(Contact& c, const Contact& found, KnownContact& known, bool begins)
{
    c.id = known.id, c.impulse = known.warm_start(begins);
    c.depth = found.depth - known.rest_depth;  // overlap left by a swapped-out spring is removed gradually
}

/// Sets Contact::approach, the closing speed of impacts. A contact counts as an impact if its pair had no impulse in the last step and it
/// closes faster than half the speed that forces would give it in this one, or if the pair had an impulse and it closes faster than twice
/// that speed. Slower contacts jitter or come to rest, as corners of a body that rocks on its edges do, and get no restitution. The speed
/// is that of a whole step also in a part of one: what counts as an impact must not depend on how far a trial goes.
void HeldIslands::set_approach(HeldIsland& island, const GroupSystem& system, double h)
{
    std::atomic<double> smallest{-HUGE_VAL};  // negative, as raise_to() finds the largest
    for_parts(&step_.workers, island.members.size(), kPart,
              [&](std::size_t begin, std::size_t end)
              {
                  for (std::size_t k = begin; k < end; ++k)
                  {
                      const std::uint32_t b = island.bodies[k];
                      const double acceleration = length(system.acceleration(island.members[k]));
                      given_speed_[b] = acceleration * step_.frame.step;
                      if (starts_.empty()) continue;
                      const Bodies& bodies = step_.world.host().bodies;
                      starts_[b] = {step_.serial, acceleration, bodies.velocity[b], bodies.angular_velocity[b]};
                  }
                  raise_to(smallest, -least_gyration(step_.world.host().bodies, std::span(island.bodies).subspan(begin, end - begin)));
              });
    island.size = island.members.empty() ? 0.0 : -smallest;
    const double least = kNoApproach * island.size / h;
    for_parts(&step_.workers, island.contacts.size(), kPart,
              [&](std::size_t begin, std::size_t end)
              {
                  bool meets = false, presses = false;
                  for (std::size_t i = begin; i < end; ++i)
                  {
                      Contact& c = island.contacts[i];
                      if (i == begin || c.a != island.contacts[i - 1].a || c.b != island.contacts[i - 1].b)
                          presses = pair_presses(island.contacts, i);
                      const double speed = contacts_.normal_velocity(c), given = std::max(given_speed_[c.a.index], given_speed_[c.b.index]);
                      const double share = presses ? 2 : 0.5;
                      c.approach = speed < -std::max(least, share * given) ? -speed : 0.0;
                      meets = meets || c.approach > 0;
                  }
                  if (meets) std::atomic_ref(island.meets).store(true, std::memory_order_relaxed);
              });
    for (const std::uint32_t b : island.bodies) given_speed_[b] = 0;
}

}  // namespace plab::simulation
