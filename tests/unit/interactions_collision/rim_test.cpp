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
