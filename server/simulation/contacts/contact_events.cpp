// The ends of the contact pipeline in a step: locate, and what begins, persists
// and ends.
#include <algorithm>
#include <array>
#include <tuple>

#include "simulation/contacts/island_step.h"
#include "simulation/events/event_locator.h"

namespace plab::simulation
{
Event Stepper::contact_event(const char* kind, const PairState& pair, double time) const
{
    Event e;
    e.time = time, e.kind = kind, e.component = pair.detector, e.a = pair.a, e.b = pair.b;
    return e;
}

/// A contact that `pressed` (N s) in the last step and not in this one: its force went through zero between the middles of both, where
/// a pull would have had to take `parting` (m/s, beyond what closes the gap) away in this one. Linear in between: of order 2, and it may
/// lie in the last step.
void Stepper::tell_release(const PairState& pair, const Contact& c, double pressed, double parting, double from, double h)
{
    const Bodies& bodies = world_.host().bodies;
    const std::array<std::uint32_t, 2> both{c.a.index, c.b.index};
    if (!(parting * h > kParts * least_gyration(bodies, both))) return;
    const double mobility = mobility_at(bodies, c.a.index, c.point, c.normal) + mobility_at(bodies, c.b.index, c.point, c.normal);
    const double share = pressed * mobility / (pressed * mobility + parting);
    Event e = contact_event("contact.release", pair, frame_.start_time + from + h * (share - 0.5));
    e.values = {c.point.x, c.point.y, c.point.z, c.normal.x, c.normal.y, c.normal.z};
    emit(std::move(e));
}

void Stepper::locate_events()
{
    if (!locator_) locator_ = std::make_shared<EventLocator>(*this);
    locator_->run(found_);
}

void Stepper::update_pair(PairState& pair, std::size_t begin, std::size_t end)
{
    bool overlaps = false;
    const std::uint32_t known = pair.count;
    for (std::size_t i = begin; i < end; ++i)
    {
        const Contact& c = found_[i].contact;
        overlaps = overlaps || c.depth > 0;
        found_[i].contact.id = cache_.contact_of(pair, c.feature).id;
    }
    const auto seen = [&](const KnownContact& k)
    {
        return std::any_of(found_.begin() + static_cast<std::ptrdiff_t>(begin), found_.begin() + static_cast<std::ptrdiff_t>(end),
                           [&](const FoundContact& f) { return f.contact.feature == k.feature; });
    };
    if (pair.resting) held_->pass_on(pair, known, std::span(found_).subspan(begin, end - begin));
    const auto past =
        std::remove_if(pair.contacts.begin(), pair.contacts.begin() + pair.count, [&](const KnownContact& k) { return !seen(k); });
    pair.count = static_cast<std::uint32_t>(past - pair.contacts.begin());
    pair.overlapping = overlaps;
    if (end > begin) pair.normal = found_[begin].contact.normal;
}

bool Stepper::is_of_pair(const FoundContact& f, const PairState& pair) const
{
    return detectors_[f.detector].component == pair.detector && f.contact.a == pair.a && f.contact.b == pair.b;
}

std::size_t Stepper::first_of_pair(const PairState& pair, std::size_t from) const
{
    // Both lists stand in the order of detector, a, b: one walk serves all pairs.
    const auto key = [&](std::uint32_t detector, Ref a, Ref b)
    { return std::tuple(world_.rank(detector), world_.rank(a), world_.rank(b)); };
    const auto wanted = key(pair.detector, pair.a, pair.b);
    while (from < found_.size() &&
           key(detectors_[found_[from].detector].component, found_[from].contact.a, found_[from].contact.b) < wanted)
        ++from;
    return from;
}

void Stepper::finish_contacts()
{
    if (forces_.any()) forces_.finish_step(found_);
    if (held_->any())
    {
        held_->note_state();
        held_->adopt(found_, frame_.start_time + frame_.step);
    }
    ease_overlaps();
    correct_positions();
    std::vector<PairState>& pairs = cache_.pairs();
    const double time = frame_.start_time + frame_.step;
    std::size_t kept = 0, at = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i)
    {
        PairState& pair = pairs[i];
        const std::size_t begin = first_of_pair(pair, at);
        bool touches = false;
        for (at = begin; at < found_.size() && is_of_pair(found_[at], pair); ++at)
            touches = touches || found_[at].contact.depth > (pair.resting ? -standing_margin(pair) : 0.0);
        const bool was_held = pressed(pair);
        update_pair(pair, begin, at);
        const bool ahead = held_->keeps_ahead(pair, touches, std::span(found_).subspan(begin, at - begin), time);
        if (!touches && !ahead)
        {
            // What pressed in its last step, and is gone at its end, was released in between.
            if (was_held) emit(contact_event("contact.release", pair, time));
            if (!pair.ahead) emit(contact_event("contact.end", pair, time));
            continue;
        }
        report_.resting_pairs += pair.resting && !ahead ? 1 : 0;
        if (kept != i) pairs[kept] = pair;
        ++kept;
    }
    pairs.resize(kept);
    for (const FoundContact& f : found_) report_.deepest = std::max(report_.deepest, f.contact.depth);
}

}  // namespace plab::simulation
