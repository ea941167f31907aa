// Responses to contacts: materials, calls of the responses, and booking of their energy.
#include <algorithm>

#include "simulation/contacts/contact_book.h"
#include "simulation/motion/component_call.h"

namespace plab::simulation
{

void ContactBook::fill_material(FoundContact& f) const
{
    const world::HostTables& host = step_.world.host();
    const std::uint32_t ma = host.bodies.material[f.contact.a.index], mb = host.bodies.material[f.contact.b.index];
    if (const SurfaceLaw* law = host.materials.find_pair(ma, mb))
    {
        f.contact.friction = law->friction, f.contact.restitution = law->restitution;
        return;
    }
    const SurfaceLaw law = response_law(f.detector);
    f.contact.friction = law.friction, f.contact.restitution = law.restitution;
}

/// Friction and restitution that apply unless a Material/Pair sets its own.
SurfaceLaw ContactBook::response_law(std::uint32_t detector) const
{
    const Detector& d = detectors_[detector];
    return {d.friction.value_or(0), d.restitution.value_or(0), d.rolling_friction.value_or(0), d.spinning_friction.value_or(0)};
}

double ContactBook::kinetic_energy(const std::vector<FoundContact>& contacts) const
{
    const Bodies& bodies = step_.world.host().bodies;
    counted_.clear();
    for (const FoundContact& f : contacts) counted_.push_back(f.contact.a.index), counted_.push_back(f.contact.b.index);
    std::sort(counted_.begin(), counted_.end());
    counted_.erase(std::unique(counted_.begin(), counted_.end()), counted_.end());
    double sum = 0;
    for (const std::uint32_t b : counted_) sum += bodies.kinetic_energy(b);
    return sum;
}

void ContactBook::respond(std::vector<FoundContact>& contacts, ImpactMode mode, double dt, WorkBook book, std::span<const Mat3> mobility)
{
    // Each detector's contacts go to its own response; detectors are handled in id order.
    for (std::uint32_t d = 0; d < detectors_.size(); ++d)
    {
        if (!detectors_[d].responds) continue;
        impact_contacts_.clear();
        for (const FoundContact& f : contacts)
            if (f.detector == d) impact_contacts_.push_back(f.contact);
        if (impact_contacts_.empty()) continue;
        const std::uint32_t response = detectors_[d].response;
        ComponentCall answer(step_, response);
        answer.context.dt = dt, answer.context.interruption = step_.frame.interruption;
        Impact impact;
        impact.mode = mode, impact.dt = dt, impact.contacts = impact_contacts_, impact.mobility = mobility;
        answer.arguments.impact = &impact;
        const double before = book.work ? kinetic_energy(contacts) : 0.0;
        step_.meter.enter(step_.meter.of_component(response));
        step_.meter.ran(step_.world.component(response).table, Phase::Respond);
        answer.run(Phase::Respond);
        step_.meter.leave();
        if (book.work) book_impact(response, contacts, mode, kinetic_energy(contacts) - before, book);
        step_.report.worst_residual = std::max(step_.report.worst_residual, impact.residual);
        // A response that does not count its visits went through all contacts in each iteration.
        const std::size_t visits = impact.visits > 0 ? static_cast<std::size_t>(impact.visits)
                                                     : impact_contacts_.size() * static_cast<std::size_t>(impact.iterations);
        step_.report.swept_rows += 3 * (impact_contacts_.size() + visits);
        std::size_t next = 0;
        for (FoundContact& f : contacts)
            if (f.detector == d) f.contact = impact_contacts_[next++];
    }
}

/// Books the work of an impact. Without kinematic bodies an impact cannot create energy; any excess is an error of the response and goes to
/// ContactEnergy::created instead.
void ContactBook::book_impact(std::uint32_t response, const std::vector<FoundContact>& contacts, ImpactMode mode, double work,
                              WorkBook book)
{
    constexpr double kRounding = 1e-9;
    (*book.work)[response] += book.sign * work;
    if (mode != ImpactMode::Impact || !(work > kRounding * kinetic_energy(contacts))) return;
    const Bodies& bodies = step_.world.host().bodies;
    for (const FoundContact& f : contacts)
        if (bodies.motion[f.contact.a.index] == Motion::Kinematic || bodies.motion[f.contact.b.index] == Motion::Kinematic) return;
    (*book.work)[response] -= book.sign * work;
    step_.contact_energy[response].created += book.sign * work;
}

}  // namespace plab::simulation
