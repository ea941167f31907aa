// Contact events inside a step: releases and Painleve's paradox.
#include <algorithm>
#include <utility>

#include "plab/number_text.h"
#include "simulation/contacts/contact_book.h"
#include "simulation/contacts/paradox.h"

namespace plab::simulation
{
namespace
{

/// Value of PairHead::release if only the next step shows whether the pair is released.
constexpr std::uint32_t kUndecided = PairHead::kNoRelease - 1;

}  // namespace

Event ContactBook::contact_event(const char* kind, const PairState& pair, double time) const
{
    Event e;
    e.time = time, e.kind = kind, e.component = pair.detector, e.a = pair.a, e.b = pair.b;
    return e;
}

Event ContactBook::contact_event(const char* kind, const PairState& pair, double time, const Contact& at, const Vec3& impulse) const
{
    Event e = contact_event(kind, pair, time);
    e.contact = {at.point, at.normal, impulse, at.depth};
    return e;
}

ContactBook::Pressing ContactBook::pressing_of(const PairState& pair) const
{
    Pressing out;
    out.counts_all = pair.pressed_tick == step_.frame.tick || pair.release == kUndecided;
    return out;
}

bool ContactBook::stops_pressing(PairState& pair, const Pressing& pressing) const
{
    constexpr double kNothing = 0x1p-40;  // fraction of the last step's impulse: the residual of an iterative solver
    if (pair.pressed_tick != step_.frame.tick)
    {
        const bool is_open = pair.release == kUndecided && pair.pressed_tick == step_.frame.tick - 1;
        if (!is_open || pressing.before > 0) pair.pressed_before = pressing.before;
        pair.pressed_tick = step_.frame.tick, pair.release = PairHead::kNoRelease;
    }
    if (!(pair.pressed_before > 0)) return false;
    if (!(pressing.now > kNothing * pair.pressed_before)) return true;
    pair.release = PairHead::kNoRelease;
    return false;
}

void ContactBook::note_release(PairState& pair, const Contact& first, const Pressing& pressing, double from, double h)
{
    const Bodies& bodies = step_.world.host().bodies;
    const double taken = pair.pressed_before * (mobility_at(bodies, first.a.index, first.point, first.normal) +
                                                mobility_at(bodies, first.b.index, first.point, first.normal));
    if (pair.release < kUndecided || !(pressing.separation_speed > kParts * taken)) return;
    if (h < step_.frame.step && !(pressing.opens > 0))
    {
        // In a short piece of a step a gap may be too wide to close: the next step shows whether the pair holds on.
        pair.release = kUndecided;
        return;
    }
    const double time = step_.frame.start_time + from + h * (taken / (taken + pressing.separation_speed) - 0.5);
    Event e = contact_event("contact.release", pair, time, first);
    pair.release = static_cast<std::uint32_t>(releases_.size());
    releases_.push_back(std::move(e));
}

bool ContactBook::report_release(PairState& pair)
{
    if (pair.pressed_tick != step_.frame.tick || pair.release >= kUndecided) return false;
    step_.emit(std::move(releases_[std::exchange(pair.release, PairHead::kNoRelease)]));
    return true;
}

bool ContactBook::is_paradox(const Contact& contact) const
{
    return contact.depth >= -overlap_tolerance(contact.a, contact.b) &&
           pressing_share(step_.world.host().bodies, contact, step_.frame.step) <= 0;
}

/// Reports the paradox in the first step in which it occurs. What follows is one of several possible solutions: an impulse that ends the
/// sliding.
void ContactBook::report_paradox(const Contact& contact, PairState& pair, double time)
{
    const bool goes_on = pair.paradox_tick >= step_.frame.tick - 1;
    pair.paradox_tick = step_.frame.tick;
    if (goes_on) return;
    Event e = contact_event("contact.paradox", pair, time, contact);
    e.severity = Severity::Warning;
    e.message = "Painleve's paradox: with friction " + number_text(contact.friction) +
                " and this lever arm sliding has no solution; an impulse ends it. Less friction or a less slender body avoids the paradox";
    step_.emit(std::move(e));
}

}  // namespace plab::simulation
