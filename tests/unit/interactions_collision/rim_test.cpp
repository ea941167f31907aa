// Cylinders whose end is nearly level: the moving point of the rim, beside the fixed ones, on floors of every kind.
#include <doctest/doctest.h>

#include <numbers>
#include <vector>

#include "bodies.h"
#include "detection/narrow.h"
#include "detection/solid.h"
#include "plab/surface.h"

using namespace plab;
using namespace plab::detection;
using namespace plab::test;

namespace
{

const Vec3 kPuck{0.1, 0.1, 0.05};  // m

Collider level_mesh()
{
    Geometry g;
    g.kind = GeometryKind::Mesh;
    set_surface(g, Surface::Triangles);
    g.vertices = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}}, g.triangles = {0, 1, 2, 0, 2, 3};
    return Collider(g);
}

Quat turned(const Vec3& axis, double angle)
{
    const Vec3 v = std::sin(angle / 2) * axis;
    return {std::cos(angle / 2), v.x, v.y, v.z};
}

struct Level
{
    Collider floor;
    Pose X;
};
std::vector<Level> level_floors()
{
    return {{collider(GeometryKind::Plane), {}},
            {collider(GeometryKind::Box, {5, 5, 0.5}), {{0, 0, -0.5}, {}}},
            {collider(GeometryKind::Cylinder, {5, 5, 0.5}), {{0, 0, -0.5}, {}}},
            {level_mesh(), {}}};
}

}  // namespace

TEST_CASE("the points of a nearly level rim are in its plane to the last bit, and none is lost where the moving one passes another")
{
    const Collider puck = collider(GeometryKind::Cylinder, kPuck);
    for (const Level& level : level_floors())
        for (const double tilt : {1e-10, 1e-8, 1e-6, 1e-4})
            for (const double azimuth : {0.0, 1e-9, 0.3, 0.5 * std::numbers::pi, 2.0})
            {
                CAPTURE(tilt);
                CAPTURE(azimuth);
                // The end is lowest in the direction of the azimuth.
                const double sine = std::sin(tilt / 2);
                const Pose X{{0.3, 0.2, 0.05 - 1e-4}, {std::cos(tilt / 2), -std::sin(azimuth) * sine, std::cos(azimuth) * sine, 0}};
                ContactPoints out(1e-3);
                collide(puck, X, level.floor, level.X, out);
                REQUIRE(out.all().size() == 5);
                double deepest = 0;
                for (const ContactPoint& p : out.all())
                {
                    const double along = (p.point.x - 0.3) * std::cos(azimuth) + (p.point.y - 0.2) * std::sin(azimuth);
                    CHECK(std::fabs(p.depth - (1e-4 + 0.05 * (1 - std::cos(tilt)) + along * std::tan(tilt))) < 1e-15 + tilt * tilt * 0.2);
                    deepest = std::max(deepest, p.depth);
                }
                CHECK(std::fabs(deepest - (1e-4 + 0.1 * std::sin(tilt))) < 1e-15 + 0.05 * tilt * tilt);
            }
}

TEST_CASE("a core over a flat face: the gap is that of its lowest point, on whichever side, and the normal is the face's to the last bit")
{
    const Collider solids[] = {collider(GeometryKind::Cylinder, kPuck), collider(GeometryKind::Capsule, {0.05, 0, 0.1}),
                               collider(GeometryKind::Box, {0.1, 0.07, 0.05})};
    const Collider box = collider(GeometryKind::Box, {0.5, 0.5, 0.5});
    std::uint64_t seed = 7;
    for (int i = 0; i < 300; ++i)
        for (const Collider& core : solids)
        {
            Pose X{{}, random_rotation(seed)};
            const double gap = (i % 3 - 1) * 1e-3,
                         low = -detection::Solid(core, X).support({0, 0, -1}).z + detection::Solid(core, X).radius();
            X.p = {0.2, -0.1, 0.5 + low + gap};
            const Separation s = separation(core, X, box, {});
            CHECK(std::fabs(s.gap - gap) < 1e-15);
            CHECK(s.normal == Vec3{0, 0, -1});
            const Separation t = separation(box, {}, core, X);
            CHECK(std::fabs(t.gap - gap) < 1e-15);
            CHECK(t.normal == Vec3{0, 0, 1});
        }
}

TEST_CASE(
    "solids meet a large box as they meet a plane, at any tilt and as deep as springs let them: the same points, for any corner or end")
{
    const Collider box = collider(GeometryKind::Box, {5, 5, 0.5}), plane = collider(GeometryKind::Plane);
    const Collider solids[] = {collider(GeometryKind::Cylinder, kPuck), collider(GeometryKind::Cylinder, {0.1, 0.1, 0.01}),
                               collider(GeometryKind::Cylinder, {0.03, 0.03, 0.15}), collider(GeometryKind::Capsule, {0.05, 0, 0.1}),
                               collider(GeometryKind::Box, {0.1, 0.07, 0.05})};
    std::uint64_t seed = 1;
    for (int i = 0; i < 2000; ++i)
        for (const Collider& core : solids)
        {
            Pose X{{}, random_rotation(seed)};
            const double depth = uniform(seed, 0, 0.02);
            X.p = {0.3, 0.1, detection::Solid(core, X).radius() - detection::Solid(core, X).support({0, 0, -1}).z - depth};
            // Of springs as stiff as 1 N/m.
            const auto push = [&](const Collider& floor, const Pose& at)
            {
                ContactPoints out;
                collide(core, X, floor, at, out);
                std::pair<Vec3, Vec3> sum;
                for (const ContactPoint& p : out.all())
                    sum.first += p.depth * p.normal, sum.second += cross(p.point - X.p, p.depth * p.normal);
                return sum;
            };
            const auto [force, torque] = push(plane, {});
            const auto [force_of_box, torque_of_box] = push(box, {{0, 0, -0.5}, {}});
            CHECK(length(force - force_of_box) < 1e-15);
            CHECK(length(torque - torque_of_box) < 1e-15);
        }
}

TEST_CASE("a spring at each point of a leaning rim has a potential: its moment is the derivative of its depth")
{
    const Collider puck = collider(GeometryKind::Cylinder, kPuck), plane = collider(GeometryKind::Plane);
    std::uint64_t seed = 2;
    for (int i = 0; i < 2000; ++i)
    {
        const Quat q = random_rotation(seed);
        const Vec3 axis = normalized(random_vector(seed, 1));
        // The sum of squares of the depths of all points, 1 m in the ground: none vanishes.
        const auto at = [&](double angle, double& energy, double& moment)
        {
            ContactPoints out;
            const Pose X{{0, 0, -1}, turned(axis, angle) * q};
            collide(puck, X, plane, {}, out);
            energy = moment = 0;
            for (const ContactPoint& p : out.all())
            {
                energy += 0.5 * p.depth * p.depth;
                moment += p.depth * dot(axis, cross(p.point - X.p, p.normal));
            }
            return out.all().size();
        };
        constexpr double kStep = 1e-5;
        double energy[2], moment[3];
        double unused = 0;
        const std::size_t count = at(0, unused, moment[2]);
        if (at(-kStep, energy[0], moment[0]) != count || at(kStep, energy[1], moment[1]) != count) continue;
        CHECK(std::fabs((energy[1] - energy[0]) / (2 * kStep) - moment[2]) < 1e-7);
    }
}
