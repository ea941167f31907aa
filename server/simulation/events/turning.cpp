#include "simulation/events/turning.h"

#include <algorithm>
#include <cmath>

#include "plab/rotation.h"
#include "world/principal_axes.h"

namespace plab::simulation
{
namespace
{

double distance_from_axis(const Vec3& p, const Vec3& axis) { return length(p - dot(p, axis) * axis); }

/// m: the furthest point of a shape's core from an axis through C; the shape's frame is at X, seen from C.
double arm_of(const Geometry& g, const Shapes& shapes, const Pose& X, const Vec3& axis)
{
    double most = 0;
    const auto offer = [&](const Vec3& p_S, double around = 0)
    { most = std::max(most, distance_from_axis(X.p + rotate(X.q, p_S), axis) + around); };
    switch (g.kind)
    {
        case GeometryKind::Box:
            for (const double x : {-1, 1})
                for (const double y : {-1, 1})
                    for (const double z : {-1, 1}) offer({x * g.size.x, y * g.size.y, z * g.size.z});
            break;
        case GeometryKind::Capsule:
        case GeometryKind::Cylinder:
            for (const double z : {-1, 1}) offer({0, 0, z * g.size.z}, g.kind == GeometryKind::Cylinder ? g.size.x : 0.0);
            break;
        case GeometryKind::Mesh:
            for (const Vec3& v : g.vertices) offer(v);
            break;
        case GeometryKind::Compound:
            for (const std::uint32_t part : g.parts)
                most = std::max(most, arm_of(shapes.geometry[part], shapes, X * shapes.geometry[part].pose, axis));
            break;
        case GeometryKind::Plane:
            return HUGE_VAL;
        case GeometryKind::Sphere:
        case GeometryKind::None:
            offer({});
    }
    return most;
}

}  // namespace

PrincipalExtent principal_extent_of(const Bodies& bodies, const Shapes& shapes, std::uint32_t b)
{
    PrincipalExtent out;
    if (!bodies.dynamic(b)) return out;
    const world::PrincipalAxes principal = world::principal_axes(bodies.inertia_B[b]);
    for (int k = 0; k < 3; ++k)
    {
        const auto at = static_cast<std::size_t>(k);
        out.inertia[at] = std::max(0.0, principal.moments[k]);
        const Vec3 axis = rotate(principal.q_BP, Vec3{k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0});
        for (const Ref shape : bodies.shapes[b])
        {
            const Geometry& g = shapes.geometry[shape.index];
            out.arm[at] = std::max(out.arm[at], arm_of(g, shapes, {g.pose.p - bodies.center_B[b], g.pose.q}, axis));
        }
    }
    return out;
}

TurningBound steady_turning(const Vec3& spin, double arm)
{
    TurningBound out;
    out.spin = length(spin);
    if (out.spin == 0 || arm == 0) return out;
    out.sweep = out.spin * arm, out.sweep_up = out.spin * out.sweep;
    return out;
}

TurningBound free_turning(const PrincipalExtent& body, double arm, const std::array<Vec3, 2>& momentum, const std::array<Vec3, 2>& spin,
                          double time, double reserve)
{
    const double ends = std::max(length(spin[0]), length(spin[1]));
    if (!(body.inertia[0] > 0)) return steady_turning(length(spin[0]) > length(spin[1]) ? spin[0] : spin[1], arm);
    const auto& I = body.inertia;
    const std::array<double, 3> u{1 / I[0], 1 / I[1], 1 / I[2]};
    const double both = u[0] + u[2];
    const double turned = length(momentum[1] - momentum[0]);
    const double most_L = std::max(length(momentum[0]), length(momentum[1])) + turned;
    const double least_L = std::max(0.0, std::min(length(momentum[0]), length(momentum[1])) - turned);
    const double energy = 0.5 * std::max(dot(momentum[0], spin[0]), dot(momentum[1], spin[1]));
    // |w|^2 <= 2 (T + turned |w|) (u_1 + u_3) - L^2 u_1 u_3, as torques that change L by `turned` do at most the work turned |w|.
    const double half = turned * both, square = 2 * energy * both - least_L * least_L * u[0] * u[2];
    TurningBound out;
    out.spin = std::max(ends, std::min(half + std::sqrt(std::max(0.0, half * half + square)), most_L * u[0]));
    const double most_energy = energy + turned * out.spin;
    std::array<double, 3> w{}, up{};
    for (std::size_t k = 0; k < 3; ++k) w[k] = std::min({most_L * u[k], std::sqrt(2 * most_energy * u[k]), out.spin});
    double up2 = 0, sweep = 0, sweep_up = 0;
    for (std::size_t k = 0; k < 3; ++k)
    {
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
        // A body with a spherical inertia tensor, up to rounding, rotates steadily.
        const double spread = std::fabs(I[i] - I[j]) > 1e-12 * I[2] ? std::fabs(I[i] - I[j]) : 0.0;
        up[k] = reserve * turned / time * u[k] + spread * u[k] * std::min(w[i] * w[j], 0.5 * out.spin * out.spin);
        up2 += up[k] * up[k], sweep += w[k] * body.arm[k], sweep_up += up[k] * body.arm[k];
    }
    out.spin_up = std::sqrt(up2);
    if (arm == 0) return out;
    out.sweep = std::min(sweep, out.spin * arm);
    out.sweep_up = out.spin * out.sweep + std::min(sweep_up, out.spin_up * arm);
    return out;
}

}  // namespace plab::simulation
