// Events of contacts in the middle of a step: released, in Painleve's paradox.
#include <algorithm>
#include <utility>

#include "plab/number_text.h"
#include "simulation/contacts/contact_book.h"
#include "simulation/contacts/paradox.h"

namespace plab::simulation
{
namespace
{

/// PairHead::release: whether it is released shows in the next step.
constexpr std::uint32_t kUndecided = PairHead::kNoRelease - 1;

}  // namespace

Event ContactBook::contact_event(const char* kind, const PairState& pair, double time) const
{
    Event e;
    e.time = time, e.kind = kind, e.component = pair.detector, e.a = pair.a, e.b = pair.b;
    return e;
}

void ContactBook::add_point(Pressing& pressing, PairState& pair, const Contact& c, double speed, double h)
{
    const double before = dot(cache_.contact_of(pair, c.feature).impulse, c.normal);
    pressing.before += before;
    pressing.now += dot(c.impulse, c.normal);
    const bool is_known = pair.pressed_tick == step_.frame.tick || pair.release == kUndecided;
    if (!(before > 0) && !is_known) return;  // it only touches
    pressing.opens = std::min(pressing.opens, speed - c.turning);
    pressing.separation_speed = std::min(pressing.separation_speed, speed - c.turning + std::max(0.0, -c.depth) / h);
}

bool ContactBook::note_release(PairState& pair, const Contact& first, const Pressing& pressing, double from, double h)
{
    constexpr double kNothing = 0x1p-40;  // of the last step's impulse: what an iteration leaves
    if (pair.pressed_tick != step_.frame.tick)
    {
        const bool is_open = pair.release == kUndecided && pair.pressed_tick == step_.frame.tick - 1;
        if (!is_open || pressing.before > 0) pair.pressed_before = pressing.before;
        pair.pressed_tick = step_.frame.tick, pair.release = PairHead::kNoRelease;
    }
    const double pressed = pair.pressed_before;
    if (!(pressed > 0)) return false;
    if (pressing.now > kNothing * pressed)
    {
        pair.release = PairHead::kNoRelease;
        return false;
    }
    const Bodies& bodies = step_.world.host().bodies;
    const double taken = pressed * (mobility_at(bodies, first.a.index, first.point, first.normal) +
                                    mobility_at(bodies, first.b.index, first.point, first.normal));
    if (pair.release < kUndecided || !(pressing.separation_speed > kParts * taken)) return true;
    if (h < step_.frame.step && !(pressing.opens > 0))
    {
        // In a bit of a step a gap may be too wide to close: the next step shows whether it holds on.
        pair.release = kUndecided;
        return true;
    }
    Event e =
        contact_event("contact.release", pair, step_.frame.start_time + from + h * (taken / (taken + pressing.separation_speed) - 0.5));
    e.values = {first.point.x, first.point.y, first.point.z, first.normal.x, first.normal.y, first.normal.z};
    pair.release = static_cast<std::uint32_t>(releases_.size());
    releases_.push_back(std::move(e));
    return true;
}

bool ContactBook::tell_release(PairState& pair)
{
    if (pair.pressed_tick != step_.frame.tick || pair.release >= kUndecided) return false;
    step_.emit(std::move(releases_[std::exchange(pair.release, PairHead::kNoRelease)]));
    return true;
}

/// Whether two bodies that touch slide so that pressing harder would close them faster.
bool ContactBook::is_paradox(const Contact& contact) const
{
    return contact.depth >= -overlap_tolerance(contact.a, contact.b) &&
           pressing_share(step_.world.host().bodies, contact, step_.frame.step) <= 0;
}

/// Told where it begins: what follows is one of several answers, an impulse that ends the slip.
void ContactBook::tell_paradox(const Contact& contact, PairState& pair, double time)
{
    const bool goes_on = pair.paradox_tick >= step_.frame.tick - 1;
    pair.paradox_tick = step_.frame.tick;
    if (goes_on) return;
    Event e = contact_event("contact.paradox", pair, time);
    e.severity = Severity::Warning;
    e.message = "Painleve's paradox: friction of " + number_text(contact.friction) +
                " on this lever leaves sliding without an answer; an impulse ends the slip. Less friction, or a less slender body, has one";
    e.values = {contact.point.x, contact.point.y, contact.point.z, contact.normal.x, contact.normal.y, contact.normal.z};
    step_.emit(std::move(e));
}

}  // namespace plab::simulation
