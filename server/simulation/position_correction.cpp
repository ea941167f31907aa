// What time stepping leaves in overlap is parted again, by moving and turning: speeds stay as they are.
//
// Nonlinear Gauss-Seidel on positions (Mueller et al., Position based dynamics, 2007; Deul et al. for rigid bodies, 2016):
//   lambda = depth / K,  K = 1/ma + 1/mb + (ra x n) . Ia^-1 (ra x n) + (rb x n) . Ib^-1 (rb x n)
// A shift of the whole body by its deepest corner would lift the other corners and feed its rocking for ever.
#include "plab/rotation.h"
#include "simulation/stepper.h"

namespace plab::simulation
{
namespace
{

constexpr int kSweeps = 8;

/// A body's small motion in the correction.
struct Nudge
{
    Vec3 arm_origin;  ///< p_WC
    Mat3 inverse_inertia_W;
    double inverse_mass = 0;
    Vec3 shift;  ///< m
    Vec3 turn;   ///< rad

    Nudge(const Bodies& bodies, std::uint32_t b) : arm_origin(bodies.position[b])
    {
        if (!bodies.dynamic(b)) return;
        inverse_mass = bodies.inverse_mass[b];
        inverse_inertia_W = bodies.inverse_inertia_W(b);
    }
    Vec3 at(const Vec3& p) const { return shift + cross(turn, p - arm_origin); }
    double mobility(const Vec3& p, const Vec3& n) const
    {
        const Vec3 c = cross(p - arm_origin, n);
        return inverse_mass + dot(c, inverse_inertia_W * c);
    }
    void push(const Vec3& p, const Vec3& impulse)
    {
        shift += impulse * inverse_mass;
        turn += inverse_inertia_W * cross(p - arm_origin, impulse);
    }
    void apply(Bodies& bodies, std::uint32_t b) const
    {
        if (!bodies.dynamic(b)) return;
        bodies.position[b] += shift;
        bodies.orientation[b] = normalized(exp_rotation(turn) * bodies.orientation[b]);
        bodies.refresh_spin(b);
    }
};

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
            const double depth = c.depth - dot(b.at(c.point) - a.at(c.point), c.normal);
            const double mobility = a.mobility(c.point, c.normal) + b.mobility(c.point, c.normal);
            if (depth <= 0 || mobility <= 0) continue;
            const Vec3 push = c.normal * (depth / mobility);
            b.push(c.point, push), a.push(c.point, -push);
        }
    a.apply(bodies, ia), b.apply(bodies, ib);
}

void Stepper::correct_positions()
{
    for (std::size_t i = 0; i < found_.size();)
    {
        double deepest = 0;
        std::size_t end = i;
        for (; end < found_.size() && same_pair(found_[end], found_[i]); ++end) deepest = std::max(deepest, found_[end].contact.depth);
        const Contact& c = found_[i].contact;
        const PairState* pair = cache_.find(detectors_[found_[i].detector].component, c.a, c.b, world_);
        if (pair && pair->resting && deepest > kOverlapTolerance) part(i, end);
        i = end;
    }
}

}  // namespace plab::simulation
