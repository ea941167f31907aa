// Surfaces to collide with: bowls, bores, height fields, meshes (interactions/detection/README.md).
#include <numbers>

#include "exact/motions.h"
#include "impacts.h"
#include "support/gravity.h"

using namespace plab;
using namespace plab::test;

namespace
{

std::string still(const std::string& id, const std::string& type, const std::string& attributes)
{
    return "<component id=\"" + id + ".shape\" type=\"Shape/" + type + "\" " + attributes + "/><component id=\"" + id +
           "\" type=\"State/Static\" shape=\"" + id + ".shape\"/>";
}
/// A field of 40 x 40 squares of 1/8 m at height 0.
std::string flat() { return still("ground", "HeightField", "columns=\"41\" rows=\"41\" spacing=\"0.125\""); }
std::string step_of(double h) { return "dt=\"" + text(h) + "\""; }
std::string cylinder(const std::string& id, double radius, double height, const std::string& attributes)
{
    return "<component id=\"" + id + ".shape\" type=\"Shape/Cylinder\" radius=\"" + text(radius) + "\" height=\"" + text(height) +
           "\"/><component id=\"" + id + "\" type=\"State/RigidBody\" shape=\"" + id + ".shape\" " + attributes + "/>";
}
}  // namespace

TEST_CASE("a ball on a height field at height 0 moves as on a plane, bit for bit, or to rounding")
{
    for (const Algorithm& algorithm : kAlgorithms)
    {
        CAPTURE(algorithm.name());
        const auto scene = [&](const std::string& ground)
        {
            return ground + sphere("a", 0.1, at({-1, 0.3, 0.4}, {2, 0.31, 0}) + " angular_velocity=\"1 2 3\"") + gravity("a") +
                   contact("a ground", algorithm, 0.4, 0.3);
        };
        Scene on_plane(scene(std::string(kGround))), on_field(scene(flat()));
        REQUIRE_MESSAGE(on_field.loaded(), on_field.error());
        for (int i = 0; i < 200; ++i)
        {
            on_plane.step(), on_field.step();
            const double place = distance(on_plane.vec("a", "position"), on_field.vec("a", "position"));
            const double spin = distance(on_plane.vec("a", "angular_velocity"), on_field.vec("a", "angular_velocity"));
            // Certifying resolutions query at other times: a height field is not convex, so its bounds differ.
            CHECK(place <= (algorithm.certifies() ? 1e-9 : 0));
            CHECK(spin <= (algorithm.certifies() ? 1e-8 : 0));
        }
    }
}

TEST_CASE("a ball that slides over inner edges of a flat grid keeps its speed, and begins to roll with friction")
{
    for (const Algorithm& algorithm : kAlgorithms)
    {
        CAPTURE(algorithm.name());
        Scene s(flat() + sphere("a", 0.1, at({-1.3, 0.3, 0.1}, {1.3, 0.17, 0})) +
                box("b", {0.15, 0.1, 0.05}, at({-1.1, -1, 0.05}, {1.1, 0.29, 0})) + gravity("a b") + contact("a b ground", algorithm, 0));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(1.5);
        CHECK(distance(s.vec("a", "linear_velocity"), {1.3, 0.17, 0}) < 1e-12);
        CHECK(distance(s.vec("b", "linear_velocity"), {1.1, 0.29, 0}) < 1e-12);
        CHECK(length(s.vec("b", "angular_velocity")) < 1e-12);
        // It slides until it rolls, at 5/7 of its initial speed.
        Scene rolls(flat() + sphere("a", 0.1, at({-1.3, 0.3, 0.1}, {1.4, 0.14, 0})) + gravity("a") +
                    contact("a ground", algorithm, 0, 0.8));
        rolls.run(1.5);
        CHECK(distance(rolls.vec("a", "linear_velocity"), {1, 0.1, 0}) < 1e-3);
        CHECK(std::fabs(rolls.vec("a", "position").z - 0.1) < 1e-8);
    }
}

TEST_CASE("a ball in a closed shell is a billiard: energy, angular momentum and position are those of the polygon")
{
    const double R = 1, r = 0.1, rho = R - r;
    const Vec3 start{0.3, 0.2, -0.1}, v{2, -1, 3};
    Scene s(still("shell", "Bowl", "radius=\"1\" opening=\"1\"") + sphere("a", r, at(start, v)) + contact("a shell", "LocalRoot", "1"));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(10);
    // The polygon: straight to the sphere of radius rho, then mirrored.
    Vec3 p = start, u = v;
    double left = 10;
    int bounces = 0;
    for (;;)
    {
        const double b = dot(p, u), uu = dot(u, u), t = (-b + std::sqrt(b * b + uu * (rho * rho - dot(p, p)))) / uu;
        if (t > left) break;
        p += t * u, left -= t;
        u = u - (2 * dot(u, p) / dot(p, p)) * p;
        ++bounces;
    }
    p += left * u;
    CAPTURE(bounces);
    CHECK(bounces > 20);
    CHECK(distance(s.vec("a", "position"), p) < 1e-11);
    CHECK(distance(s.vec("a", "linear_velocity"), u) < 1e-11);
    CHECK(distance(cross(s.vec("a", "position"), s.vec("a", "linear_velocity")), cross(start, v)) < 1e-12);
    CHECK(near(length(s.vec("a", "linear_velocity")), length(v), 1e-13));
}

namespace
{
/// A ball of radius 0.1 in a bowl or bore of radius 0.6 after one period: its distance from the start (m), the change of its energy (J),
/// and the numbers of contact events.
struct Swing
{
    double place = 0, energy = 0;
    std::size_t begins = 0, ends = 0;
};
Swing swing(const Algorithm& algorithm, bool rolls, int steps, const std::string& wall)
{
    const double R = 0.6, r = 0.1, start = 0.5;
    const double period = 2 * exact::PendulumMotion(std::sqrt(kG / (R - r) * (rolls ? 5. / 7 : 1.)), start, 0).time_of_turn();
    const Vec3 p = (R - r) * Vec3{std::sin(start), 0, -std::cos(start)};
    Scene s(wall + sphere("a", r, at(p, {})) + gravity("a") + contact("a wall", algorithm, 0, rolls ? 10 : 0), step_of(period / steps));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    const double before = energy(s);
    s.step(steps);
    return {distance(s.vec("a", "position"), p), std::fabs(energy(s) - before), s.count("contact.begin"), s.count("contact.end")};
}
}  // namespace

TEST_CASE("a ball swings in a bowl like a pendulum, and rolls in a bore with 7/5 of its inertia")
{
    const std::string bowl = still("wall", "Bowl", "radius=\"0.6\""),
                      bore = still("wall", "Bore", "radius=\"0.6\" height=\"1\" orientation=\"axis 1 0 0 1.5707963267948966\"");
    for (const Algorithm& algorithm : {Algorithm{"None", "Rows"}, {"Speculative", "Rows"}, {"LocalRoot", "Rows"}, {"LocalRoot", "Impulse"}})
    {
        CAPTURE(algorithm.name());
        for (const bool rolls : {false, true})
        {
            CAPTURE(rolls);
            const Swing coarse = swing(algorithm, rolls, 200, rolls ? bore : bowl),
                        fine = swing(algorithm, rolls, 800, rolls ? bore : bowl);
            MESSAGE(algorithm.name(), std::string(rolls ? " rolls" : " slides"), ": off by ", coarse.place, " m, ", fine.place,
                    " m; order ", std::log2(coarse.place / fine.place) / 2, "; energy ", coarse.energy, " ", fine.energy, " J; begins ",
                    coarse.begins, " ", fine.begins, ", ends ", coarse.ends, " ", fine.ends);
            CHECK(coarse.place < 0.02);
            CHECK(fine.place < 0.005);
            CHECK(coarse.begins == 1);
            CHECK(coarse.ends + fine.ends == 0);
        }
    }
}

TEST_CASE("a ball that slides or rolls over a ball or a cylinder stays in one contact until it leaves")
{
    // It leaves where cos theta = 2/3 (sliding), 10/17 (rolling). Before that, at cos theta = 0.75:
    const double R = 0.5, r = 0.1, start = 0.1;
    for (const Algorithm& algorithm : {Algorithm{"None", "Rows"}, {"Speculative", "Rows"}, {"LocalRoot", "Rows"}, {"LocalRoot", "Impulse"}})
        for (const bool rolls : {false, true})
            for (const std::string& hill :
                 {still("hill", "Sphere", "radius=\"0.5\""),
                  still("hill", "Cylinder", "radius=\"0.5\" height=\"1\" orientation=\"axis 1 0 0 1.5707963267948966\"")})
            {
                CAPTURE(algorithm.name());
                CAPTURE(rolls);
                double off[2] = {0, 0};
                for (int k = 0; k < 2; ++k)
                {
                    Scene s(hill + sphere("a", r, at((R + r) * Vec3{std::sin(start), 0, std::cos(start)})) + gravity("a") +
                                contact("a hill", algorithm, 0, rolls ? 10 : 0),
                            step_of(k == 0 ? 1. / 240 : 1. / 960));
                    s.keep_events = true;
                    const double factor = rolls ? 10. / 7 : 2;  // v^2 = factor g (R + r) (cos start - cos theta)
                    const double before = (R + r) * std::cos(start);
                    double z = before;
                    while (z > (R + r) * 0.75 && s.simulation().time() < 3) s.step(), z = s.vec("a", "position").z;
                    off[k] = std::fabs(length_squared(s.vec("a", "linear_velocity")) / (factor * kG * (before - z)) - 1);
                    CHECK(s.count("contact.begin") == 1);
                    CHECK(s.count("contact.end") == 0);
                    CHECK(std::fabs(length(s.vec("a", "position")) - (R + r)) < 1e-4);
                }
                MESSAGE(algorithm.name(), std::string(rolls ? " rolls" : " slides"), ": v^2 off by ", off[0], ", ", off[1], "; order ",
                        std::log2(off[0] / off[1]) / 2);
            }
}

TEST_CASE("a box lies in a bore on two edges, which carry its weight")
{
    // Edges at 30 degrees from the vertical: each carries m g / (2 cos 30).
    const double half = 0.3, low = 0.1;
    for (const Algorithm& algorithm : {Algorithm{"None", "Rows"}, {"LocalRoot", "Rows"}, {"LocalRoot", "Impulse"}, {"None", "Impulse"}})
    {
        CAPTURE(algorithm.name());
        Scene s(still("wall", "Bore", "radius=\"0.6\" height=\"4\" orientation=\"axis 1 0 0 1.5707963267948966\"") +
                box("b", {half, 0.5, low}, at({0, 0, low - 0.6 * std::sqrt(0.75)}, {}, 3)) + gravity("b") +
                contact("b wall", algorithm, 0, 0.2));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(2);
        CHECK(distance(s.vec("b", "position"), {0, 0, low - 0.6 * std::sqrt(0.75)}) < 1e-7);
        CHECK(length(s.vec("b", "linear_velocity")) < 1e-9);
        CHECK(length(s.vec("b", "angular_velocity")) < 1e-9);
    }
}

TEST_CASE("solids of every kind come to rest on waves, on a mesh and in a bowl")
{
    for (const std::string& ground :
         {still("wall", "HeightField", "columns=\"61\" rows=\"61\" spacing=\"0.1\" wave_height=\"0.15\" wave_length=\"3\""),
          still("wall", "HeightField",
                "columns=\"31\" rows=\"31\" spacing=\"0.2\" roughness=\"0.03\" wave_height=\"0.1\" wave_length=\"4\""),
          still("wall", "Bowl", "radius=\"3\" position=\"0 0 3\"")})
        for (const Algorithm& algorithm : {Algorithm{"Speculative", "Rows"}, {"LocalBisection", "Rows"}, {"LocalRoot", "Impulse"}})
        {
            CAPTURE(ground);
            CAPTURE(algorithm.name());
            Scene s(ground + sphere("a", 0.1, at({0, 0, 0.5})) + box("b", {0.2, 0.15, 0.1}, at({0.6, 0.2, 0.7})) +
                    cylinder("c", 0.1, 0.3, at({-0.6, 0.3, 0.6}) + " orientation=\"axis 1 0 0 1\"") + gravity("a b c") +
                    contact("a b c wall", algorithm, 0, 0.6));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            // Where triangles rise above the plane of contact, the bounds are of first order: resolution.grazing.
            s.warnings_expected = algorithm.certifies();
            const double before = energy(s);
            double most = before;
            for (int i = 0; i < 720; ++i) s.step(), most = std::max(most, energy(s));
            CHECK(most < before * (1 + 1e-6));
            for (const char* id : {"a", "b", "c"})
            {
                CAPTURE(std::string(id));
                CHECK(s.vec(id, "position").z > -0.2);
                CHECK(length(s.vec(id, "linear_velocity")) < 1);
            }
        }
}

TEST_CASE("a surface is only for bodies that do not move, and has no mass")
{
    const auto error = [](const std::string& shape, const std::string& body)
    { return Scene("<component id=\"s\" " + shape + "/><component id=\"b\" shape=\"s\" " + body + "/>").error(); };
    const std::string bowl = "type=\"Shape/Bowl\" radius=\"1\"";
    CHECK(error(bowl, "type=\"State/RigidBody\" density=\"100\"").find("a bowl is a surface and has no volume") != std::string::npos);
    CHECK(error(bowl, "type=\"State/RigidBody\" mass=\"1\" inertia=\"1 1 1\"").find("that are not dynamic") != std::string::npos);
    CHECK(error(bowl, "type=\"State/Static\"").empty());
    CHECK(error("type=\"Shape/Bowl\" radius=\"1\" opening=\"-1\"", "type=\"State/Static\"").find("opening must be above") !=
          std::string::npos);
    CHECK(error("type=\"Shape/HeightField\" columns=\"3\" rows=\"2\" spacing=\"1\" heights=\"0 0 0 0\"", "type=\"State/Static\"")
              .find("heights must be columns x rows = 6 numbers, not 4") != std::string::npos);
    CHECK(error("type=\"Shape/HeightField\" columns=\"3000\" rows=\"2\" spacing=\"1\"", "type=\"State/Static\"").find("1024") !=
          std::string::npos);
}
