// The ends of the contact pipeline in a step: locate, and what begins, persists
// and ends.
#include <algorithm>
#include <tuple>
#include <utility>

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

/// Whether a pair that pressed in the last step presses no more in this advance: `presses` (N s), and a pull would have had to take
/// `parting` (m/s, beyond what closes the gap) away. Its force went through zero between the middles of both steps; linear in between:
/// of order 2, and it may lie in the last step. It is told when the step is over: an advance that goes back may show that it holds on.
bool Stepper::note_release(PairState& pair, const Contact& c, double presses, double parting, double from, double h)
{
    constexpr double kNothing = 0x1p-40;  // of the last step's impulse: what an iteration leaves
    if (pair.pressed_tick != frame_.tick)
        pair.pressed_before = pressed_with(pair), pair.pressed_tick = frame_.tick, pair.release = PairHead::kNoRelease;
    const double pressed = pair.pressed_before;
    if (!(pressed > 0)) return false;
    if (presses > kNothing * pressed)
    {
        pair.release = PairHead::kNoRelease;
        return false;
    }
    const Bodies& bodies = world_.host().bodies;
    const double mobility = mobility_at(bodies, c.a.index, c.point, c.normal) + mobility_at(bodies, c.b.index, c.point, c.normal);
    const double taken = pressed * mobility;
    if (pair.release != PairHead::kNoRelease || !(parting > kParts * taken)) return true;
    Event e = contact_event("contact.release", pair, frame_.start_time + from + h * (taken / (taken + parting) - 0.5));
    e.values = {c.point.x, c.point.y, c.point.z, c.normal.x, c.normal.y, c.normal.z};
    pair.release = static_cast<std::uint32_t>(releases_.size());
    releases_.push_back(std::move(e));
    return true;
}

/// Of this pair, as noted. True if there is one.
bool Stepper::tell_release(PairState& pair)
{
    if (pair.pressed_tick != frame_.tick || pair.release == PairHead::kNoRelease) return false;
    emit(std::move(releases_[std::exchange(pair.release, PairHead::kNoRelease)]));
    return true;
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
        const bool released = tell_release(pair);
        update_pair(pair, begin, at);
        const bool ahead = held_->keeps_ahead(pair, touches, std::span(found_).subspan(begin, at - begin), time);
        if (!touches && !ahead)
        {
            // What pressed in its last step, and is gone at its end, was released in between.
            if (was_held && !released) emit(contact_event("contact.release", pair, time));
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
