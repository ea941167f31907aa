#include "simulation/contacts/position_correction.h"

#include <algorithm>
#include <cmath>

#include "simulation/contacts/body_displacement.h"

namespace plab::simulation
{
namespace
{

constexpr int kCorrectionSweeps = 8, kEasingSweeps = 100;

}  // namespace

/// Removes the overlap of one pair by sweeps over its contact points. Each point is moved apart by its own remaining depth, which includes
/// what the points before it have moved: nonlinear Gauss-Seidel. The displacements are collected in `a` and `b` and applied at the end, so
/// that all points refer to the same poses; the sum of their rotations is small.
void PositionCorrection::separate(std::span<const FoundContact> contacts)
{
    Bodies& bodies = step_.world.host().bodies;
    const Ref first = contacts.front().contact.a, second = contacts.front().contact.b;
    BodyDisplacement a(bodies, first.index), b(bodies, second.index);
    for (int sweep = 0; sweep < kCorrectionSweeps; ++sweep)
        for (const FoundContact& f : contacts)
        {
            const Contact& c = f.contact;
            const double depth = c.depth - c.rest_depth - dot(b.at(c.point) - a.at(c.point), c.normal);
            const double mobility = a.mobility(c.point, c.normal) + b.mobility(c.point, c.normal);
            if (depth <= 0 || mobility <= 0) continue;
            const Vec3 push = c.normal * (depth / mobility);
            b.push(c.point, push), a.push(c.point, -push);
        }
    a.apply(bodies, first.index), b.apply(bodies, second.index);
    const std::uint32_t response = contacts_.detectors()[contacts.front().detector].response;
    if (response != kNoIndex)
        step_.contact_energy[response].by_correction -= dot(force_on(first), a.shift) + dot(force_on(second), b.shift);
}

void PositionCorrection::note_forces(const GroupSystem& system)
{
    const Bodies& bodies = step_.world.host().bodies;
    known_force_.resize(bodies.size());
    for (std::size_t i = 0; i < system.bodies().size(); ++i)
    {
        const std::uint32_t b = system.bodies()[i];
        known_force_[b] = {system.acceleration(i) * bodies.mass[b], step_.serial};
    }
}

/// N, in this step. A pair that has only just met has not been advanced as an island yet, so its forces are evaluated here.
Vec3 PositionCorrection::force_on(Ref body)
{
    if (!step_.world.host().bodies.dynamic(body.index)) return {};
    known_force_.resize(step_.world.host().bodies.size());
    if (known_force_[body.index].serial != step_.serial)
    {
        const std::uint32_t group = step_.groups.of(body);
        GroupSystem& system = motion_.system_for(std::span(&group, 1), {});
        system.begin(step_.frame.step, step_.frame.step, {}, nullptr);
        system.evaluate_here();
        note_forces(system);
    }
    return known_force_[body.index].force;
}

/// One pair after the other, in the order of ids. Overlap up to the tolerance stays. Correcting one pair may press its bodies into others;
/// the next detection finds that overlap, and the next step corrects it.
void PositionCorrection::correct_positions()
{
    const auto& detectors = contacts_.detectors();
    if (std::all_of(detectors.begin(), detectors.end(), [](const Detector& d) { return d.by_rows; })) return;
    const std::span<const FoundContact> found = contacts_.found();
    std::size_t near = 0;
    for (std::size_t i = 0, end = 0; i < found.size(); i = end)
    {
        double deepest = 0;
        for (end = i; end < found.size() && same_pair(found[end], found[i]); ++end)
            deepest = std::max(deepest, found[end].contact.depth - found[end].contact.rest_depth);
        if (detectors[found[i].detector].by_rows) continue;
        const PairState* pair = contacts_.find_pair(found[i], near);
        const bool by_impulses = pair && pair->resting;
        if (by_impulses && deepest > contacts_.overlap_tolerance(pair->a, pair->b)) separate(found.subspan(i, end - i));
    }
}

/// Fraction of the overlap left behind by a spring that remains after a step. The overlap d shrinks at a twentieth of the speed of a fall
/// through it,
///   d' = -max(sqrt(a d) / 20, d / 2 s),   a: pressing force over mass, m/s^2,
/// and the remaining depth is never above the actual one. All contacts of a pair shrink by the same factor, so that a face keeps its
/// inclination.
double PositionCorrection::share_of_overlap_left(const PairState& pair, std::span<const Eased> eased) const
{
    const Bodies& bodies = step_.world.host().bodies;
    double deepest = 0, press = 0;
    for (const KnownContact& known : pair.all())
    {
        deepest = std::max(deepest, known.rest_depth);
        press += std::max(0.0, dot(known.impulse, pair.normal)) / step_.frame.step;
    }
    const double a = press * (bodies.inverse_mass[pair.a.index] + bodies.inverse_mass[pair.b.index]);
    const double left = deepest - step_.frame.step * std::max(0.05 * std::sqrt(a * deepest), 0.5 * deepest);
    if (left < contacts_.overlap_tolerance(pair.a, pair.b)) return 0;
    double share = left / deepest;
    for (const Eased& e : eased) share = std::min(share, std::max(0.0, e.found->contact.depth / e.known->rest_depth));
    return share;
}

void PositionCorrection::ease_pair(PairState& pair)
{
    std::vector<Eased>& eased = eased_;
    eased.clear();
    for (KnownContact& known : pair.all())
    {
        if (!(known.rest_depth > 0)) continue;
        const auto is_it = [&](const FoundContact& f) { return contacts_.is_of_pair(f, pair) && f.contact.feature == known.feature; };
        const auto found = std::find_if(contacts_.found().begin(), contacts_.found().end(), is_it);
        if (found == contacts_.found().end())
            known.rest_depth = 0;
        else
            eased.push_back({&known, &*found});
    }
    if (eased.empty()) return;
    const double share = share_of_overlap_left(pair, eased);
    Bodies& bodies = step_.world.host().bodies;
    BodyDisplacement a(bodies, pair.a.index), b(bodies, pair.b.index);
    for (const Eased& e : eased) e.known->rest_depth *= share;
    for (int sweep = 0; sweep < kEasingSweeps; ++sweep)
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
    // The remaining depth counts as zero overlap for this step, so that correct_positions() does not remove it as well.
    for (const Eased& e : eased) e.found->contact.rest_depth = e.found->contact.depth;
}

void PositionCorrection::ease_overlaps()
{
    if (!contacts_.cache().may_have_rest_depth()) return;
    bool any = false;
    for (PairState& pair : contacts_.cache().pairs())
    {
        const std::span<const KnownContact> all = pair.all();
        if (std::none_of(all.begin(), all.end(), [](const KnownContact& k) { return k.rest_depth > 0; })) continue;
        any = true;
        ease_pair(pair);
    }
    if (!any) contacts_.cache().has_no_rest_depth();
}

}  // namespace plab::simulation
