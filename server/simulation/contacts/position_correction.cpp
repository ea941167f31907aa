// What time stepping leaves in overlap is parted again, by moving and turning: speeds stay as they are.
//
// Nonlinear Gauss-Seidel on positions (Mueller et al., Position based dynamics, 2007; Deul et al. for rigid bodies, 2016):
//   lambda = depth / K,  K = 1/ma + 1/mb + (ra x n) . Ia^-1 (ra x n) + (rb x n) . Ib^-1 (rb x n)
// A shift of the whole body by its deepest corner would lift the other corners and feed its rocking for ever.
#include "simulation/contact_forces/nudge.h"
#include "simulation/step/stepper.h"

namespace plab::simulation
{
namespace
{

constexpr int kSweeps = 8;

}  // namespace

void Stepper::part(std::size_t begin, std::size_t end)
{
    Bodies& bodies = world_.host().bodies;
    const std::uint32_t ia = found_[begin].contact.a.index, ib = found_[begin].contact.b.index;
    Nudge a(bodies, ia), b(bodies, ib);
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (std::size_t i = begin; i < end; ++i)
        {
            const Contact& c = found_[i].contact;
            const double depth = c.depth - c.rest_depth - dot(b.at(c.point) - a.at(c.point), c.normal);
            const double mobility = a.mobility(c.point, c.normal) + b.mobility(c.point, c.normal);
            if (depth <= 0 || mobility <= 0) continue;
            const Vec3 push = c.normal * (depth / mobility);
            b.push(c.point, push), a.push(c.point, -push);
        }
    a.apply(bodies, ia), b.apply(bodies, ib);
    const std::uint32_t response = detectors_[found_[begin].detector].response;
    if (response == kNoIndex) return;
    const Contact& c = found_[begin].contact;
    contact_energy_[response].lifted -= dot(force_on(c.a), a.shift) + dot(force_on(c.b), b.shift);
}

void Stepper::note_forces(const GroupSystem& system)
{
    const Bodies& bodies = world_.host().bodies;
    known_force_.resize(bodies.size());
    for (std::size_t i = 0; i < system.bodies().size(); ++i)
    {
        const std::uint32_t b = system.bodies()[i];
        known_force_[b] = {system.acceleration(i) * bodies.mass[b], serial_};
    }
}

/// N, of this step; what has just met others has not been advanced with them yet.
Vec3 Stepper::force_on(Ref body)
{
    if (!world_.host().bodies.dynamic(body.index)) return {};
    known_force_.resize(world_.host().bodies.size());
    if (known_force_[body.index].serial != serial_)
    {
        const std::uint32_t group = groups_.of(body);
        GroupSystem& system = system_for(std::span(&group, 1), {});
        system.begin(frame_.step, frame_.step, {}, nullptr);
        system.evaluate_here();
        note_forces(system);
    }
    return known_force_[body.index].force;
}

void Stepper::correct_positions()
{
    for (std::size_t i = 0; i < found_.size();)
    {
        double deepest = 0;
        std::size_t end = i;
        for (; end < found_.size() && same_pair(found_[end], found_[i]); ++end)
            deepest = std::max(deepest, found_[end].contact.depth - found_[end].contact.rest_depth);
        const Contact& c = found_[i].contact;
        const PairState* pair = cache_.find(detectors_[found_[i].detector].component, c.a, c.b, world_);
        if (pair && pair->resting && !detectors_[found_[i].detector].by_rows && deepest > overlap_tolerance(c.a, c.b)) part(i, end);
        i = end;
    }
}

}  // namespace plab::simulation
