// Standing contacts when their response is exchanged for one of another kind: nothing pops, and swapping back at the same
// boundary brings back every bit.
//
//   spring -> hard: the overlap that the spring had is let be, and taken out slowly (ease_overlaps); impulses are the
//                   spring's force over a step. A contact that is about at rest stands.
//   hard -> spring: the spring gives at the present depth the force that held the contact over the last step:
//                   f = preload + k (depth - rest_depth), and its stiction spring is stretched accordingly.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/contact_forces/contact_forces.h"
#include "simulation/contact_forces/nudge.h"
#include "simulation/step/stepper.h"
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
    for (std::size_t d = 0; d < converted_.size() && d < s_->detectors_.size(); ++d)
        if (s_->detectors_[d].component == component || s_->detectors_[d].response == component) n += converted_[d];
    return n;
}

/// The laws of all detectors, as they are now.
void ContactForces::read_laws()
{
    laws_.assign(s_->detectors_.size(), {});
    for (std::size_t d = 0; d < laws_.size(); ++d)
    {
        const std::uint32_t response = s_->detectors_[d].response;
        if (response == kNoIndex) continue;
        ByteWriter bytes;
        write(bytes, s_->world_.type_of(response)->info.name);
        laws_[d].type = world::hash_bytes(0, bytes.bytes());
        s_->world_.table_of(response).save(s_->world_.component(response).row, world::kind_bit(FieldKind::Param), bytes);
        laws_[d].values = world::hash_bytes(0, bytes.bytes());
    }
}

void ContactForces::convert_contacts()
{
    ContactCache& cache = s_->cache_;
    read_laws();
    converted_.assign(s_->detectors_.size(), 0);
    const auto index_of = [&](std::uint32_t component)
    {
        std::uint32_t d = 0;
        while (d < s_->detectors_.size() && s_->detectors_[d].component != component) ++d;
        return d;
    };
    const auto lives = [&](Ref r) { return s_->world_.host().component_of(r) != kNoIndex; };
    std::erase_if(cache.force_pairs(),
                  [&](const ForcePair& p) { return index_of(p.detector) == s_->detectors_.size() || !lives(p.a) || !lives(p.b); });
    // From copies: what goes over must not be met again.
    const auto soft = cache.force_pairs();
    const auto hard = cache.pairs();
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
    for (const PairState& p : hard)
        if (const std::uint32_t d = index_of(p.detector); d < s_->detectors_.size() && by_force_[d]) hard_to_soft(p, d);
    cache.force_pairs() = live_.pairs;
}

void ContactForces::soft_to_hard(const ForcePair& pair, std::uint32_t d)
{
    ContactCache& cache = s_->cache_;
    PairState to;
    if (!take_parked(cache.parked_pairs(), pair.detector, pair.a, pair.b, to)) to = harden(pair, s_->detectors_[d]);
    bool added = false;
    cache.get_or_add(pair.detector, pair.a, pair.b, s_->world_, pair.since, added) = to;
    cache.parked_force_pairs().push_back(pair);
    live_.pairs.erase(find_same(live_.pairs, pair.detector, pair.a, pair.b));
    // A sensor holds nobody: what they held is lost.
    if (s_->detectors_[d].responds || s_->detectors_[d].by_rows) converted_[d] += pair.count;
}

/// Another law takes over with the force that there is.
void ContactForces::soft_to_soft(const ForcePair& pair, std::uint32_t d)
{
    PairState as_hard;
    as_hard.detector = pair.detector, as_hard.a = pair.a, as_hard.b = pair.b, as_hard.since = pair.since, as_hard.normal = pair.normal;
    for (const ForceContact& c : pair.all())
    {
        KnownContact& k = as_hard.contacts[as_hard.count++];
        k.feature = c.feature, k.id = c.id, k.impulse = c.force * s_->frame_.step;
    }
    const ForcePair to = remember_or_soften(as_hard, d);
    live_.pairs.erase(find_same(live_.pairs, pair.detector, pair.a, pair.b));
    if (to.count > 0) live_.pairs.insert(place_of(pair.detector, pair.a, pair.b), to);
    s_->cache_.parked_force_pairs().push_back(pair);
    converted_[d] += to.count;
}

void ContactForces::hard_to_soft(const PairState& pair, std::uint32_t d)
{
    ContactCache& cache = s_->cache_;
    const ForcePair to = remember_or_soften(pair, d);
    if (to.count > 0) live_.pairs.insert(place_of(pair.detector, pair.a, pair.b), to);
    cache.parked_pairs().push_back(pair);
    cache.pairs().erase(find_same(cache.pairs(), pair.detector, pair.a, pair.b));
    converted_[d] += to.count;
}

/// As the same law had it at this boundary, else as what held the contact says.
ForcePair ContactForces::remember_or_soften(const PairState& pair, std::uint32_t d)
{
    std::vector<ForcePair>& parked = s_->cache_.parked_force_pairs();
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
    const Bodies& bodies = s_->world_.host().bodies;
    const bool answered = detector.responds || detector.by_rows;
    out.resting = answered;
    for (const ForceContact& soft : pair.all())
    {
        KnownContact& hard = out.contacts[out.count++];
        hard.feature = soft.feature, hard.id = soft.id;
        out.overlapping = out.overlapping || soft.depth > 0;
        if (!answered) continue;
        hard.impulse = soft.force * s_->frame_.step;
        hard.rest_depth = std::max(soft.depth, 0.0);
        // Faster than a tenth of what a swing as wide as the spring's static give has, it is in the middle of an impact.
        Contact at;
        at.a = pair.a, at.b = pair.b, at.normal = pair.normal, at.point = bodies.position[pair.b.index];
        const double swing = dot(soft.force, pair.normal) * soft.rates.mobility * soft.half_period / std::numbers::pi;
        out.resting = out.resting && std::fabs(s_->normal_velocity(at)) <= 0.1 * swing;
    }
    out.resting = answered && (out.resting || detector.persists());
    return out;
}

bool ContactForces::soften_contact(const KnownContact& hard, const FoundContact& at, ForceContact& soft)
{
    const double dt = s_->frame_.step;
    const Contact& c = at.contact;
    const Vec3 held = dt > 0 ? hard.impulse / dt : Vec3{};
    const double press = dot(held, c.normal);
    if (!(press > 0) && c.depth <= 0) return false;
    const std::uint32_t response = s_->detectors_[at.detector].response;
    soft.feature = hard.feature, soft.id = hard.id, soft.begin = s_->frame_.start_time + dt, soft.told = true;
    soft.depth = c.depth;
    probe_.take(s_->world_.host().bodies, c, s_->smaller_radius(c.a, c.b), s_->frame_.step);
    // Where the spring gives that force anyway, nothing need be remembered.
    const double plain = probe_.normal_force(s_->world_, response, c.depth, 0);
    if (c.depth <= 0 || std::fabs(plain - press) > 1e-9 * press) soft.rest_depth = c.depth, soft.preload = std::max(press, 0.0);
    FoundContact asked = at;
    asked.contact.rest_depth = soft.rest_depth, asked.contact.preload = soft.preload;
    probe_.take(s_->world_.host().bodies, asked.contact, s_->smaller_radius(asked.contact.a, asked.contact.b), s_->frame_.step);
    soft.open_depth = probe_.open_depth(s_->world_, response);
    const double k = probe_.stiction(s_->world_, response, c.depth);
    if (k > 0) soft.stretch = (held - c.normal * press) * (-1 / k);
    soft.force = held;
    expect(soft, at, 0);
    // It may be taken over in the middle of an impact, which gets as many pieces as from the touch on.
    soft.lively = std::fabs(s_->normal_velocity(c));
    soft.liveliest = std::max(soft.lively, length(held) * soft.rates.mobility * soft.half_period / std::numbers::pi);
    return true;
}

ForcePair ContactForces::soften(const PairState& pair, std::uint32_t detector)
{
    ForcePair out;
    out.detector = pair.detector, out.a = pair.a, out.b = pair.b, out.since = pair.since, out.normal = pair.normal;
    out.law_type = laws_[detector].type, out.law = laws_[detector].values;
    const StandingPair standing{pair.a, pair.b, {}};
    found_.clear();
    detect(detector, std::span(&standing, 1), s_->standing_margin(pair), found_);
    sort_contacts(found_, s_->world_);
    for (FoundContact& f : found_)
    {
        s_->fill_material(f);
        const auto is_it = [&](const KnownContact& k) { return k.feature == f.contact.feature; };
        const auto known = std::find_if(pair.contacts.begin(), pair.contacts.begin() + pair.count, is_it);
        if (known == pair.contacts.begin() + pair.count || out.count == ForcePair::kMostContacts) continue;
        if (ForceContact soft; soften_contact(*known, f, soft)) out.contacts[out.count++] = soft;
    }
    return out;
}

/// How much of the overlap that a spring left behind stays after a step: it shrinks at a twentieth of the speed that falling
/// through it would give,
///   d' = -max(sqrt(a d) / 20, d / 2 s),   a: what presses the pair together over its mass,
/// and no further than it is. All contacts of a pair shrink alike, so that a face stays as it lies.
double Stepper::share_of_overlap_left(const PairState& pair, std::span<const Eased> eased) const
{
    const Bodies& bodies = world_.host().bodies;
    double deepest = 0, press = 0;
    for (std::uint32_t k = 0; k < pair.count; ++k)
    {
        deepest = std::max(deepest, pair.contacts[k].rest_depth);
        press += std::max(0.0, dot(pair.contacts[k].impulse, pair.normal)) / frame_.step;
    }
    const double a = press * (bodies.inverse_mass[pair.a.index] + bodies.inverse_mass[pair.b.index]);
    const double left = deepest - frame_.step * std::max(0.05 * std::sqrt(a * deepest), 0.5 * deepest);
    if (left < overlap_tolerance(pair.a, pair.b)) return 0;
    double share = left / deepest;
    for (const Eased& e : eased) share = std::min(share, std::max(0.0, e.found->contact.depth / e.known->rest_depth));
    return share;
}

void Stepper::ease_pair(PairState& pair)
{
    std::vector<Eased>& eased = eased_;
    eased.clear();
    for (std::uint32_t k = 0; k < pair.count; ++k)
    {
        KnownContact& known = pair.contacts[k];
        if (!(known.rest_depth > 0)) continue;
        const auto is_it = [&](const FoundContact& f) { return is_of_pair(f, pair) && f.contact.feature == known.feature; };
        const auto found = std::find_if(found_.begin(), found_.end(), is_it);
        if (found == found_.end())
            known.rest_depth = 0;
        else
            eased.push_back({&known, &*found});
    }
    if (eased.empty()) return;
    const double share = share_of_overlap_left(pair, eased);
    Bodies& bodies = world_.host().bodies;
    Nudge a(bodies, pair.a.index), b(bodies, pair.b.index);
    constexpr int kSweeps = 100;
    for (const Eased& e : eased) e.known->rest_depth *= share;
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (const Eased& e : eased)
        {
            const Contact& c = e.found->contact;
            const double excess = c.depth - e.known->rest_depth - dot(b.at(c.point) - a.at(c.point), c.normal);
            const double mobility = a.mobility(c.point, c.normal) + b.mobility(c.point, c.normal);
            if (!(mobility > 0)) continue;
            const Vec3 push = c.normal * (excess / mobility);
            b.push(c.point, push), a.push(c.point, -push);
        }
    a.apply(bodies, pair.a.index), b.apply(bodies, pair.b.index);
    // Found where it was: the correction of other overlaps has nothing to add.
    for (const Eased& e : eased) e.found->contact.rest_depth = e.found->contact.depth;
}

void Stepper::ease_overlaps()
{
    for (PairState& pair : cache_.pairs())
    {
        const auto eases = [](const KnownContact& k) { return k.rest_depth > 0; };
        if (std::any_of(pair.contacts.begin(), pair.contacts.begin() + pair.count, eases)) ease_pair(pair);
    }
}

}  // namespace plab::simulation
