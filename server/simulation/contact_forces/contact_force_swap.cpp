// Conversion of contacts when their response is exchanged for one of another kind. Forces stay continuous, so that nothing jumps, and
// swapping back at the same step boundary restores every bit.
//
//   spring -> hard: the overlap of the spring is kept as rest_depth and removed slowly (position_correction.h); warm-start impulses are the
//                   spring force times the step. A contact that is nearly at rest becomes persistent.
//   hard -> spring: at the present depth the spring gives the force that held the contact over the last step:
//                   f = preload + k (depth - rest_depth), and its stiction spring is stretched accordingly.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "simulation/contact_forces/contact_forces.h"
#include "world/state_hash.h"

namespace plab::simulation
{
namespace
{

template <class Pair>
auto find_same(std::vector<Pair>& list, std::uint32_t detector, Ref a, Ref b)
{
    return std::find_if(list.begin(), list.end(), [&](const Pair& p) { return p.detector == detector && p.a == a && p.b == b; });
}

/// Takes the pair out of a list of parked ones, if it is there.
template <class Pair>
bool take_parked(std::vector<Pair>& parked, std::uint32_t detector, Ref a, Ref b, Pair& out)
{
    const auto at = find_same(parked, detector, a, b);
    if (at == parked.end()) return false;
    out = *at;
    parked.erase(at);
    return true;
}

}  // namespace

std::size_t ContactForces::converted(std::uint32_t component) const
{
    std::size_t n = 0;
    for (std::size_t d = 0; d < converted_.size() && d < contacts_.detectors().size(); ++d)
        if (contacts_.detectors()[d].component == component || contacts_.detectors()[d].response == component) n += converted_[d];
    return n;
}

/// Hashes the present laws of all detectors.
void ContactForces::read_laws()
{
    laws_.assign(contacts_.detectors().size(), {});
    for (std::size_t d = 0; d < laws_.size(); ++d)
    {
        const std::uint32_t response = contacts_.detectors()[d].response;
        if (response == kNoIndex) continue;
        ByteWriter bytes;
        write(bytes, step_.world.type_of(response)->info.name);
        laws_[d].type = world::hash_bytes(0, bytes.bytes());
        step_.world.table_of(response).save(step_.world.component(response).row, world::kind_bit(FieldKind::Param), bytes);
        laws_[d].values = world::hash_bytes(0, bytes.bytes());
    }
}

void ContactForces::convert_contacts()
{
    ContactCache& cache = contacts_.cache();
    read_laws();
    converted_.assign(contacts_.detectors().size(), 0);
    const auto index_of = [&](std::uint32_t component)
    {
        std::uint32_t d = 0;
        while (d < contacts_.detectors().size() && contacts_.detectors()[d].component != component) ++d;
        return d;
    };
    const auto lives = [&](Ref r) { return step_.world.host().component_of(r) != kNoIndex; };
    std::erase_if(cache.force_pairs(),
                  [&](const ForcePair& p) { return index_of(p.detector) == contacts_.detectors().size() || !lives(p.a) || !lives(p.b); });
    // Loop over copies, so that converted pairs are not visited again.
    const auto soft = cache.force_pairs();
    std::vector<PairState> hard;
    if (any_)
        for (const PairState& p : std::as_const(cache).pairs())
            if (const std::uint32_t d = index_of(p.detector); d < contacts_.detectors().size() && by_force_[d]) hard.push_back(p);
    live_.pairs = soft;
    for (const ForcePair& p : soft)
    {
        const std::uint32_t d = index_of(p.detector);
        if (!by_force_[d])
            soft_to_hard(p, d);
        else if (p.law_type != laws_[d].type)
            soft_to_soft(p, d);
        else
            find_same(live_.pairs, p.detector, p.a, p.b)->law = laws_[d].values;
    }
    for (const PairState& p : hard) hard_to_soft(p, index_of(p.detector));
    cache.force_pairs() = live_.pairs;
}

void ContactForces::soft_to_hard(const ForcePair& pair, std::uint32_t d)
{
    ContactCache& cache = contacts_.cache();
    PairState to;
    if (!take_parked(cache.parked_pairs(), pair.detector, pair.a, pair.b, to)) to = harden(pair, contacts_.detectors()[d]);
    bool added = false;
    cache.get_or_add(pair.detector, pair.a, pair.b, step_.world, pair.since, added) = to;
    cache.parked_force_pairs().push_back(pair);
    live_.pairs.erase(find_same(live_.pairs, pair.detector, pair.a, pair.b));
    // A sensor holds no body, so contacts that become those of a sensor are not counted as converted.
    if (contacts_.detectors()[d].responds || contacts_.detectors()[d].by_rows) converted_[d] += pair.count;
}

/// Another force law takes over with the present force.
void ContactForces::soft_to_soft(const ForcePair& pair, std::uint32_t d)
{
    PairState as_hard;
    as_hard.detector = pair.detector, as_hard.a = pair.a, as_hard.b = pair.b, as_hard.since = pair.since, as_hard.normal = pair.normal;
    for (const ForceContact& c : pair.all())
    {
        KnownContact& k = as_hard.add();
        k.feature = c.feature, k.id = c.id, k.impulse = c.force * step_.frame.step;
    }
    const ForcePair to = remember_or_soften(as_hard, d);
    live_.pairs.erase(find_same(live_.pairs, pair.detector, pair.a, pair.b));
    if (to.count > 0) live_.pairs.insert(place_of(live_.pairs, pair.detector, pair.a, pair.b), to);
    contacts_.cache().parked_force_pairs().push_back(pair);
    converted_[d] += to.count;
}

void ContactForces::hard_to_soft(const PairState& pair, std::uint32_t d)
{
    ContactCache& cache = contacts_.cache();
    const ForcePair to = remember_or_soften(pair, d);
    if (to.count > 0) live_.pairs.insert(place_of(live_.pairs, pair.detector, pair.a, pair.b), to);
    cache.parked_pairs().push_back(pair);
    cache.erase(*cache.find(pair.detector, pair.a, pair.b, step_.world));
    converted_[d] += to.count;
}

/// The parked state of the pair if the same law had it at this boundary, otherwise a state computed from the impulses.
ForcePair ContactForces::remember_or_soften(const PairState& pair, std::uint32_t d)
{
    std::vector<ForcePair>& parked = contacts_.cache().parked_force_pairs();
    const auto is_it = [&](const ForcePair& p)
    { return p.detector == pair.detector && p.a == pair.a && p.b == pair.b && p.law == laws_[d].values; };
    const auto at = std::find_if(parked.begin(), parked.end(), is_it);
    if (at == parked.end()) return soften(pair, d);
    const ForcePair out = *at;
    parked.erase(at);
    return out;
}

PairState ContactForces::harden(const ForcePair& pair, const Detector& detector)
{
    PairState out;
    out.detector = pair.detector, out.a = pair.a, out.b = pair.b, out.since = pair.since, out.normal = pair.normal;
    const Bodies& bodies = step_.world.host().bodies;
    const bool answered = detector.responds || detector.by_rows;
    out.resting = answered;
    for (const ForceContact& soft : pair.all())
    {
        KnownContact& hard = out.add();
        hard.feature = soft.feature, hard.id = soft.id;
        out.overlapping = out.overlapping || soft.depth > 0;
        if (!answered) continue;
        hard.impulse = soft.force * step_.frame.step;
        hard.rest_depth = std::max(soft.depth, 0.0);
        // A pair that moves faster than a tenth of the speed of an oscillation with the static deflection as its amplitude is in the middle
        // of an impact, and does not rest.
        Contact at;
        at.a = pair.a, at.b = pair.b, at.normal = pair.normal, at.point = bodies.position[pair.b.index];
        const double swing = dot(soft.force, pair.normal) * soft.rates.mobility * soft.half_period / std::numbers::pi;
        out.resting = out.resting && std::fabs(contacts_.normal_velocity(at)) <= 0.1 * swing;
    }
    out.resting = answered && (out.resting || detector.persists());
    return out;
}

bool ContactForces::soften_contact(const KnownContact& hard, const FoundContact& at, ForceContact& soft)
{
    const double dt = step_.frame.step;
    const Contact& c = at.contact;
    const Vec3 held = dt > 0 ? hard.impulse / dt : Vec3{};
    const double press = dot(held, c.normal);
    if (!(press > 0) && c.depth <= 0) return false;
    const std::uint32_t response = contacts_.detectors()[at.detector].response;
    soft.feature = hard.feature, soft.id = hard.id, soft.begin = step_.frame.start_time + dt, soft.reported = true;
    soft.depth = c.depth;
    probe_.take(step_.world.host().bodies, c, contacts_.smaller_radius(c.a, c.b), step_.frame.step);
    // If the spring gives that force anyway, no offset is needed.
    const double plain = probe_.normal_force(step_.world, response, c.depth, 0);
    if (c.depth <= 0 || std::fabs(plain - press) > 1e-9 * press) soft.rest_depth = c.depth, soft.preload = std::max(press, 0.0);
    FoundContact asked = at;
    asked.contact.rest_depth = soft.rest_depth, asked.contact.preload = soft.preload;
    probe_.take(step_.world.host().bodies, asked.contact, contacts_.smaller_radius(asked.contact.a, asked.contact.b), step_.frame.step);
    soft.open_depth = probe_.open_depth(step_.world, response);
    const double k = probe_.stiction(step_.world, response, c.depth);
    if (k > 0) soft.stretch = (held - c.normal * press) * (-1 / k);
    soft.force = held;
    expect(soft, at, 0);
    // The contact may be converted in the middle of an impact, which gets as many pieces as one from its first touch on.
    soft.swing_speed = std::fabs(contacts_.normal_velocity(c));
    soft.peak_swing_speed = std::max(soft.swing_speed, length(held) * soft.rates.mobility * soft.half_period / std::numbers::pi);
    return true;
}

ForcePair ContactForces::soften(const PairState& pair, std::uint32_t detector)
{
    ForcePair out;
    out.detector = pair.detector, out.a = pair.a, out.b = pair.b, out.since = pair.since, out.normal = pair.normal;
    out.law_type = laws_[detector].type, out.law = laws_[detector].values;
    const PersistentPair persistent{pair.a, pair.b, {}};
    found_.clear();
    detect(detector, std::span(&persistent, 1), contacts_.persistence_margin(pair), found_);
    sort_contacts(found_, step_.world);
    for (FoundContact& f : found_)
    {
        contacts_.fill_material(f);
        const auto is_it = [&](const KnownContact& k) { return k.feature == f.contact.feature; };
        const auto known = std::find_if(pair.all().begin(), pair.all().end(), is_it);
        if (known == pair.all().end() || out.count == ForcePair::kMostContacts) continue;
        if (ForceContact soft; soften_contact(*known, f, soft)) out.contacts[out.count++] = soft;
    }
    return out;
}

}  // namespace plab::simulation
