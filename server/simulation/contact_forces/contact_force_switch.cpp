// Switching events of force contacts: when contact points begin and cease to push.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "simulation/contact_forces/contact_forces.h"

namespace plab::simulation
{

const ContactForces::Seen* ContactForces::find_seen(const std::vector<Seen>& list, const FoundContact& f) const
{
    const auto at =
        std::lower_bound(list.begin(), list.end(), f,
                         [&](const Seen& s, const FoundContact& wanted) { return simulation::precedes(s.found, wanted, step_.world); });
    const bool is_it = at != list.end() && at->found.contact.feature == f.contact.feature && same_pair(at->found, f);
    return is_it ? &*at : nullptr;
}

/// m: rounding error of a depth.
double ContactForces::rounding(const Contact& c) const
{
    return 0x1p-50 * (8 * contacts_.smaller_radius(c.a, c.b) + positions_of(c.a, c.b));
}

/// Whether a contact has begun or ceased to push since `before`.
bool ContactForces::switches(const Seen& seen, const std::vector<Seen>& before)
{
    const Contact& c = seen.found.contact;
    if (const ForceContact* known = find_pushing(seen.found)) return c.depth < known->open_depth && seen.separation_speed > 0;
    if (c.depth <= rounding(c)) return false;
    if (const Seen* then = find_seen(before, seen.found)) return then->found.contact.depth <= rounding(c);
    // A new corner of bodies that touch already is added at the end of the piece: as it was not detected before, there is no bracket for
    // its touch.
    return !find_pair(contacts_.detectors()[seen.found.detector].component, c.a, c.b);
}

/// Whether any contact has switched between the start of the piece and the present state. Leaves the laws evaluated.
bool ContactForces::has_switched(const std::vector<Seen>& now)
{
    evaluate_laws();
    return any_slack_change() || any_switch(at_start_, now);
}

bool ContactForces::any_switch(const std::vector<Seen>& before, const std::vector<Seen>& after)
{
    return std::any_of(after.begin(), after.end(), [&](const Seen& s) { return switches(s, before); });
}

namespace
{

/// s: when the gap closes (or the overlap opens) again that is `depth0` now, grows at `rate0` first, and has become `-depth1` after h, if
/// it is a parabola, as in a free fall: depth0 + rate0 t - c t^2 = 0, with depth0 and rate0 >= 0 and c > 0.
double time_of_return(double depth0, double rate0, double depth1, double h)
{
    const double c = (depth0 + rate0 * h + depth1) / (h * h);
    return (rate0 + std::sqrt(rate0 * rate0 + 4 * c * depth0)) / (2 * c);
}

}  // namespace

/// Estimates the first time in (low, high) at which one of the contacts that have switched at `high` does so. Inverse Hermite
/// interpolation: time as a cubic polynomial of the depth, from depths and speeds at both ends, evaluated at the depth of the switch. A
/// contact that moves away from its switch at `low` returns to it: a parabola. The middle if the speeds do not allow that.
double ContactForces::guess(double low, double high, const std::vector<Seen>& at_low, const std::vector<Seen>& at_high)
{
    const double h = high - low;
    double first = low + 0.5 * h;
    bool none = true;
    for (const Seen& s : at_high)
    {
        if (!switches(s, at_start_)) continue;
        const Seen* then = find_seen(at_low, s.found);
        const ForceContact* known = find_pushing(s.found);
        double t = 0.5 * h;
        if (then)
        {
            const double open = known ? known->open_depth : 0.0;
            const double d0 = then->found.contact.depth - open, d1 = s.found.contact.depth - open, travel = d1 - d0;
            const double u = -d0 / travel, away = known ? -then->separation_speed : then->separation_speed;
            t = u * h;
            // s: time for the whole depth interval at the speed of each end.
            const double slow0 = travel / -then->separation_speed, slow1 = travel / -s.separation_speed;
            if (slow0 > 0 && slow1 > 0 && slow0 < 3 * h && slow1 < 3 * h)
                t = u * (1 - u) * (1 - u) * slow0 + u * u * (3 - 2 * u) * h + u * u * (u - 1) * slow1;
            else if (away > 0)
                t = time_of_return(std::fabs(d0), away, std::fabs(d1), h);
        }
        if (!(t > 0 && t < h)) t = 0.5 * h;
        first = std::exchange(none, false) ? low + t : std::min(first, low + t);
    }
    return first;
}

/// Whether one of the contacts that have switched in `beyond` is at its switching depth at the present state, up to rounding, and on its
/// way across: a contact that has just opened is at that depth as well, but on its way back.
bool ContactForces::is_there(const std::vector<Seen>& now, const std::vector<Seen>& beyond)
{
    for (const Seen& s : beyond)
    {
        if (!switches(s, at_start_)) continue;
        const Seen* here = find_seen(now, s.found);
        const ForceContact* known = find_pushing(s.found);
        if (!here || (known ? here->separation_speed < 0 : here->separation_speed > 0)) continue;
        if (std::fabs(here->found.contact.depth - (known ? known->open_depth : 0.0)) <= rounding(s.found.contact)) return true;
    }
    return false;
}

void ContactForces::expect(ForceContact& known, const FoundContact& at, double closing)
{
    const std::uint32_t response = contacts_.detectors()[at.detector].response;
    FoundContact asked = at;
    asked.contact.rest_depth = known.rest_depth, asked.contact.preload = known.preload, asked.contact.approach = known.approach;
    const double depth = at.contact.depth;
    probe_.take(step_.world.host().bodies, asked.contact, contacts_.smaller_radius(asked.contact.a, asked.contact.b), step_.frame.step);
    known.peak = std::max(depth, probe_.peak_depth(step_.world, response, std::max(known.open_depth, depth), closing));
    known.rates = probe_.rates(step_.world, response, known.peak);
    const double swing = std::sqrt(std::max(known.rates.normal, known.rates.tangential));
    known.half_period = std::numbers::pi / std::max({swing, known.rates.damping, 1e-300});
}

void ContactForces::begin_contact(const Seen& seen, double time)
{
    const Contact& c = seen.found.contact;
    const std::uint32_t detector = contacts_.detectors()[seen.found.detector].component;
    ForcePair* pair = find_pair(detector, c.a, c.b);
    const bool fresh = pair == nullptr;
    if (fresh)
    {
        ForcePair p;
        p.detector = detector, p.a = c.a, p.b = c.b, p.since = step_.frame.tick;
        pair = &*live_.pairs.insert(place_of(live_.pairs, detector, c.a, c.b), p);
    }
    if (fresh) pair->law_type = laws_[seen.found.detector].type, pair->law = laws_[seen.found.detector].values;
    ForceContact* old = pair->find(c.feature);
    if (!old && pair->count == ForcePair::kMostContacts) return;
    pair->normal = c.normal;
    ForceContact known;
    known.asked = step_.frame.tick;
    known.feature = c.feature, known.id = old ? old->id : contacts_.cache().new_id();
    known.begin = time, known.depth = c.depth, known.approach = std::max(0.0, -seen.separation_speed);
    known.swing_speed = known.peak_swing_speed = known.approach;
    // Corners of bodies that begin to touch now, also those that overlap at the start of a run, push with all of their depth; not so beside
    // those that a swap has converted.
    const auto is_new = [&](const ForceContact& other) { return other.begin == time && !other.reported; };
    const bool begins = std::ranges::all_of(pair->all(), is_new);
    if (!begins && c.depth > 1e3 * rounding(c)) known.rest_depth = known.open_depth = take_over(*pair, seen.found);
    expect(known, seen.found, known.approach);
    (old ? *old : pair->contacts[pair->count++]) = known;
    if (fresh) report(ContactForceEvent::Kind::Begin, *pair, c, {}, time);
}

/// m: the rest_depth of a point that appears in an overlap. With the whole of it the spring would give the bodies energy out of nothing. So
/// it takes over what points that vanished have left, and otherwise begins without force.
double ContactForces::take_over(ForcePair& pair, const FoundContact& at)
{
    const std::uint32_t response = contacts_.detectors()[at.detector].response;
    probe_.take(step_.world.host().bodies, at.contact, contacts_.smaller_radius(at.contact.a, at.contact.b), step_.frame.step);
    const double depth = at.contact.depth, rest = probe_.rest_depth_that_stores(step_.world, response, depth, pair.released);
    if (pair.released > 0) pair.released = std::max(0.0, pair.released - probe_.stored(step_.world, response, depth, rest));
    return rest;
}

/// J: what the spring of a point that has vanished in a piece of h seconds stores at its end, where its depth is that at the start and what
/// the mean of its speeds has made of it: without that the spring would keep the work that it has done in the piece.
double ContactForces::stored_in(const ForcePair& pair, const ForceContact& known, double h)
{
    const auto was_it = [&](const Seen& s)
    {
        return s.found.contact.feature == known.feature && s.found.contact.a == pair.a && s.found.contact.b == pair.b &&
               contacts_.detectors()[s.found.detector].component == pair.detector;
    };
    const auto then = std::find_if(at_start_.begin(), at_start_.end(), was_it);
    if (then == at_start_.end()) return 0;
    Contact at = then->found.contact;
    at.preload = known.preload, at.rest_depth = known.rest_depth;
    const double depth = at.depth - 0.5 * h * (then->separation_speed + contacts_.normal_velocity(at));
    if (!(depth > known.open_depth)) return 0;
    probe_.take(step_.world.host().bodies, at, contacts_.smaller_radius(at.a, at.b), step_.frame.step);
    return std::max(0.0, probe_.stored(step_.world, contacts_.detectors()[then->found.detector].response, depth, known.rest_depth));
}

/// Ends a contact point whose force is over. If it still overlaps because of a swap, it becomes dormant instead.
void ContactForces::let_go(const Seen& seen, ForcePair& pair, double time)
{
    const Contact& c = seen.found.contact;
    ForceContact& known = *pair.find(c.feature);
    if (!(known.rest_depth > 0) || c.depth <= 1e3 * rounding(c)) return end_contact(pair, c, time);
    report_impact_once(pair, known, c, time);
    known.dormant = true, known.depth = c.depth;
    known.force = known.stretch = {};
}

void ContactForces::follow_dormant(const Seen& seen, ForceContact& known, double time)
{
    known.depth = seen.found.contact.depth;
    if (known.depth > 0 && seen.separation_speed < 0) begin_contact(seen, time);
}

/// Removes dormant points that do not overlap any more or have disappeared.
void ContactForces::drop_dormant(const std::vector<Seen>& seen)
{
    const auto overlaps = [&](const ForcePair& pair, const ForceContact& known)
    {
        const auto is_it = [&](const Seen& s)
        {
            return contacts_.detectors()[s.found.detector].component == pair.detector && s.found.contact.a == pair.a &&
                   s.found.contact.b == pair.b && s.found.contact.feature == known.feature;
        };
        const auto at = std::find_if(seen.begin(), seen.end(), is_it);
        return at != seen.end() && at->found.contact.depth > 0;
    };
    for (const NearPair& near : pairs_)
    {
        ForcePair* pair = find_pair(contacts_.detectors()[near.detector].component, near.a, near.b);
        for (std::uint32_t k = pair ? pair->count : 0; k-- > 0;)
            if (pair->contacts[k].dormant && !overlaps(*pair, pair->contacts[k])) pair->contacts[k] = pair->contacts[--pair->count];
    }
}

void ContactForces::end_contact(ForcePair& pair, const Contact& at, double time)
{
    ForceContact* known = pair.find(at.feature);
    report_impact_once(pair, *known, at, time);
    *known = pair.contacts[--pair.count];
}

void ContactForces::report(ContactForceEvent::Kind kind, const ForcePair& pair, const Contact& at, const Vec3& impulse, double time)
{
    live_.events.push_back({kind, time, pair.detector, pair.a, pair.b, at.point, at.normal, impulse, at.depth});
}

void ContactForces::report_impact_once(const ForcePair& pair, ForceContact& contact, const Contact& at, double time)
{
    if (std::exchange(contact.reported, true)) return;
    report(ContactForceEvent::Kind::Impact, pair, at, contact.impulse, time);
}

void ContactForces::drop_ended(double time)
{
    const auto over = [&](const ForcePair& p)
    {
        if (p.count > 0) return false;
        Contact at;
        at.normal = p.normal;
        report(ContactForceEvent::Kind::End, p, at, {}, time);
        return true;
    };
    std::erase_if(live_.pairs, over);
}

/// Lists pushing points that are not detected any more although their gap is small: their feature ids have changed.
void ContactForces::list_gone(const std::vector<Seen>& seen, double h)
{
    there_.clear(), gone_.clear();
    for (const Seen& s : seen)
        if (const ForceContact* known = find_pushing(s.found)) there_.push_back(known->id);
    std::sort(there_.begin(), there_.end());
    for (const Pushing& p : pushing_)
    {
        ForcePair& pair = live_.pairs[p.pair];
        const ForceContact& known = pair.contacts[p.contact];
        if (std::binary_search(there_.begin(), there_.end(), known.id)) continue;
        gone_.push_back(known.id);
        pair.released += stored_in(pair, known, h);
    }
}

/// Gives points that touch with another feature now its name.
void ContactForces::rename_points(const std::vector<Seen>& seen)
{
    for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end)
    {
        const FoundContact& first = seen[begin].found;
        for (end = begin + 1; end < seen.size() && same_pair(seen[end].found, first);) ++end;
        ForcePair* pair = find_pair(contacts_.detectors()[first.detector].component, first.contact.a, first.contact.b);
        if (!pair) continue;
        const auto contact_of = [&](std::size_t k) -> const Contact& { return seen[begin + k].found.contact; };
        const Renamed renamed = find_renamed(*pair, end - begin, contact_of);
        if (renamed.known) renamed.known->feature = contact_of(renamed.place).feature;
    }
}

/// At the end of a piece of h seconds, or 0 before the first one: updates which points push in the next one.
void ContactForces::switch_contacts(const std::vector<Seen>& seen, double t, double h)
{
    const double time = step_.frame.start_time + t;
    // Contacts that would switch within this time switch now: the corners of a face land together.
    const double instant = 1e-12 * step_.frame.step;
    rename_points(seen);
    list_gone(seen, h);
    for (const Seen& s : seen)
    {
        const Contact& c = s.found.contact;
        ForceContact* known = find_known(s.found);
        const double soon = std::fabs(s.separation_speed) * instant + rounding(c);
        if (known && known->dormant)
            follow_dormant(s, *known, time);
        else if (known && s.separation_speed > 0 && c.depth <= known->open_depth + soon)
            let_go(s, *find_pair(contacts_.detectors()[s.found.detector].component, c.a, c.b), time);
        else if (!known && (s.separation_speed < 0 ? c.depth >= -soon : c.depth > 1e3 * rounding(c)))
            begin_contact(s, time);
    }
    if (!gone_.empty()) end_gone(time);
    drop_dormant(seen);
    drop_ended(time);
    list_pushing();
}

void ContactForces::end_gone(double time)
{
    for (ForcePair& pair : live_.pairs)
        for (std::uint32_t k = pair.count; k-- > 0;)
        {
            if (std::find(gone_.begin(), gone_.end(), pair.contacts[k].id) == gone_.end()) continue;
            Contact at;
            at.feature = pair.contacts[k].feature, at.normal = pair.normal;
            end_contact(pair, at, time);
        }
}

}  // namespace plab::simulation
