// What is reported of force contacts when a step is over.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "plab/number_text.h"
#include "simulation/contact_forces/contact_forces.h"
#include "simulation/contact_forces/rim_near_level.h"

namespace plab::simulation
{

/// The reported impulse of a force contact is its present force times the step.
void ContactForces::report(std::vector<FoundContact>& found)
{
    for (FoundContact& f : found)
    {
        if (!by_force_[f.detector]) continue;
        const ForceContact* known = find_known(f);
        if (!known) continue;
        f.contact.id = known->id, f.contact.impulse = known->force * step_.frame.step;
        f.contact.stretch = known->stretch;
    }
}

/// Notes what the springs that push at the end of the step have given in it: each knows its impulse since it began.
void ContactForces::log_contacts(const std::vector<FoundContact>& found)
{
    const std::vector<ForcePair>& at_start = contacts_.cache().force_pairs();  // in the order of pairs
    const auto key = [&](std::uint32_t detector, Ref a, Ref b) { return PairKey(step_.world, detector, a, b); };
    const auto before = [&](const FoundContact& f, std::uint64_t id)
    {
        const PairKey wanted = key(contacts_.detectors()[f.detector].component, f.contact.a, f.contact.b);
        const auto pair = std::lower_bound(at_start.begin(), at_start.end(), wanted,
                                           [&](const ForcePair& p, const PairKey& k) { return key(p.detector, p.a, p.b) < k; });
        if (pair == at_start.end() || key(pair->detector, pair->a, pair->b) != wanted) return Vec3{};
        for (const ForceContact& k : pair->all())
            if (k.id == id) return k.impulse;
        return Vec3{};
    };
    for (const FoundContact& f : found)
    {
        const ForceContact* known = by_force_[f.detector] ? find_known(f) : nullptr;
        if (!known) continue;
        Contact c = f.contact;
        c.impulse = known->impulse - before(f, known->id);
        contacts_.log().add(c, contacts_.detectors()[f.detector].component, c.depth, 0, step_.frame.step, false);
    }
}

/// Evaluates each law once more for all of its contacts together, so that its outputs describe the whole scene at the end of the step.
void ContactForces::run_outputs(std::vector<FoundContact>& found)
{
    StepContext context;
    context.time = step_.frame.start_time + step_.frame.step, context.dt = step_.frame.step, context.tick = step_.frame.tick;
    for (std::uint32_t d = 0; d < by_force_.size(); ++d)
    {
        const std::uint32_t response = contacts_.detectors()[d].response;
        const auto answers = [&](const Detector& other) { return other.by_force && other.response == response; };
        const auto first = std::find_if(contacts_.detectors().begin(), contacts_.detectors().end(), answers);
        if (!by_force_[d] || first - contacts_.detectors().begin() != static_cast<std::ptrdiff_t>(d)) continue;
        law_contacts_.clear();
        for (const FoundContact& f : found)
        {
            const ForceContact* known = answers(contacts_.detectors()[f.detector]) ? find_pushing(f) : nullptr;
            if (!known) continue;
            FoundContact own = f;
            contacts_.fill_material(own);
            Contact& c = own.contact;
            c.stretch = known->stretch, c.rest_depth = known->rest_depth, c.preload = known->preload, c.approach = known->approach;
            law_contacts_.push_back(c);
        }
        run_force_laws(step_.world, response, context, law_contacts_, step_.world.host().bodies, scratch_);
        for (const Contact& c : law_contacts_)
            for (const Ref r : {c.a, c.b}) scratch_.force[r.index] = scratch_.torque[r.index] = {};
    }
}

void ContactForces::emit_events()
{
    const world::World& world = step_.world;
    const auto key = [&](const ContactForceEvent& h)
    { return std::tuple(h.time, world.rank(h.detector), world.rank(h.a), world.rank(h.b), h.kind); };
    std::stable_sort(live_.events.begin(), live_.events.end(),
                     [&](const ContactForceEvent& x, const ContactForceEvent& y) { return key(x) < key(y); });
    for (const ContactForceEvent& h : live_.events)
    {
        constexpr const char* kNames[] = {"contact.begin", "contact.impact", "contact.end"};
        Event e;
        e.time = h.time, e.kind = kNames[static_cast<int>(h.kind)], e.component = h.detector, e.a = h.a, e.b = h.b;
        if (h.kind != ContactForceEvent::Kind::End) e.contact = {h.point, h.normal, h.impulse, h.depth};
        step_.emit(std::move(e));
    }
    live_.events.clear();
}

void ContactForces::emit_stiff()
{
    const bool reported = std::exchange(step_.reported.stiff, stiff_ != kNoIndex);
    if (stiff_ == kNoIndex || reported) return;
    Event e;
    e.time = step_.frame.start_time, e.kind = "contact.stiff", e.severity = Severity::Warning, e.component = stiff_;
    e.message = "steps_per_contact asks for " + rounded_text(std::ceil(pieces_needed_)) +
                " substeps per step, more than max_substeps; contacts are resolved with fewer substeps";
    e.values = {pieces_needed_};
    step_.emit(std::move(e));
}

void ContactForces::finish_step(std::vector<FoundContact>& found)
{
    for (FoundContact& f : found)
        if (by_force_[f.detector]) round_rim_near_level(f.contact);
    report(found);
    if (contacts_.log().on()) log_contacts(found);
    run_outputs(found);
    emit_events();
    emit_stiff();
    contacts_.cache().force_pairs() = live_.pairs;
}

}  // namespace plab::simulation
