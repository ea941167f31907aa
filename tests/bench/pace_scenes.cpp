#include "bench/pace_scenes.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/random_poses.h"
#include "support/text.h"

namespace plab::bench
{

using test::random_rotation;
using test::text;

std::string component(const std::string& id, const std::string& type, const std::string& more)
{
    return "<component id=\"" + id + "\" type=\"" + type + "\" " + more + "/>\n";
}

std::string scene(const std::string& dt, const std::string& parts)
{
    return "<plab version=\"1\"><scene dt=\"" + dt + "\"/>\n" + parts + "</plab>";
}

std::string numbered(const char* name, int i) { return name + std::to_string(i); }

std::string body(int i, const Vec3& at, const std::string& more)
{
    return component(numbered("b", i), "State/RigidBody", more + " position=\"" + text(at) + "\"");
}

const std::string kGravity = component("gravity", "Field/Gravity", "between=\"*\"");
const std::string kGround = component("plane", "Shape/Plane", "") + component("ground", "State/Static", "shape=\"plane\"");

std::string heap_contact(double friction)
{
    return component("manager", "Manager/SoftStep", "substeps=\"4\"") +
           component(
               "contact", "CDetection/ODE",
               "between=\"*\" resolution=\"Resolution/None\" response=\"Response/Rows\" response.manager=\"manager\" response.friction=\"" +
                   text(friction) + "\"");
}

std::string free_bodies(int n)
{
    std::string out = kGravity + component("s", "Shape/Box", "half_extents=\"0.2 0.3 0.4\"");
    for (int i = 0; i < n; ++i) out += body(i, {2.0 * (i % 100), 2.0 * (i / 100), 0}, "shape=\"s\" mass=\"1\" angular_velocity=\"1 2 3\"");
    return scene("1/60", out);
}

std::string wall(int columns, int rows)
{
    std::string out = kGravity + kGround + component("s", "Shape/Box", "half_extents=\"0.5 0.25 0.25\"");
    for (int k = 0; k < rows; ++k)
        for (int i = 0; i < columns; ++i) out += body(k * columns + i, {i + (k % 2 == 1 ? 0.5 : 0.0), 0, 0.25 + 0.5 * k});
    return scene("1/60", out + heap_contact(0.8));
}

std::string pile(int n)
{
    std::string out = kGravity + kGround + component("s", "Shape/Box", "half_extents=\"0.25 0.25 0.25\"");
    std::uint64_t random = 2;
    const auto jitter = [&] { return 0.02 * (2 * next_uniform(random) - 1); };
    const int side = std::max(1, static_cast<int>(std::lround(std::sqrt(n / 10.0))));
    for (int i = 0; i < n; ++i)
    {
        const int column = i / 10;
        const double x = jitter(), y = jitter();
        out += body(i, {0.55 * (column % side) + x, 0.55 * (column / side) + y, 0.27 + 0.52 * (i % 10)});
    }
    return scene("1/60", out + heap_contact(0.8));
}

std::string balls(int n)
{
    std::string out = kGravity + kGround + component("s", "Shape/Sphere", "radius=\"0.1\"");
    std::uint64_t random = 3;
    const int side = std::max(1, static_cast<int>(std::lround(std::sqrt(n / 16.0))));
    const auto jitter = [&] { return 0.004 * (2 * next_uniform(random) - 1); };
    const std::string w = text(0.108 * side);
    const char* const sides[4][2] = {
        {"-1 0 0", "axis 0 1 0 90 deg"}, {"1 0 0", "axis 0 1 0 -90 deg"}, {"0 -1 0", "axis 1 0 0 -90 deg"}, {"0 1 0", "axis 1 0 0 90 deg"}};
    for (int i = 0; i < 4; ++i)
    {
        std::string at = sides[i][0];
        at.replace(at.find('1'), 1, w);
        out +=
            component(numbered("side", i), "State/Static", "shape=\"plane\" position=\"" + at + "\" orientation=\"" + sides[i][1] + "\"");
    }
    for (int i = 0; i < n; ++i)
    {
        const int column = i / 16;
        const double x = jitter(), y = jitter(), z = jitter();
        out += body(i, {0.211 * (column % side - 0.5 * (side - 1)) + x, 0.211 * (column / side - 0.5 * (side - 1)) + y,
                        0.12 + 0.211 * (i % 16) + z});
    }
    return scene("1/60", out + heap_contact(0.8));
}

std::string newcomers_heap(int n)
{
    std::string out =
        kGravity + kGround + component("s", "Shape/Sphere", "radius=\"0.1\"") + component("q", "Shape/Box", "half_extents=\"0.1 0.1 0.1\"");
    std::uint64_t random = 4;
    const auto jitter = [&] { return 0.03 * (2 * next_uniform(random) - 1); };
    for (int i = 0; i < n; ++i)
    {
        const double x = jitter(), y = jitter(), z = jitter();
        out += body(i, {0.3 * (i % 5) + x, 0.3 * (i / 5 % 5) + y, 0.3 + 0.3 * (i / 25) + z},
                    i % 2 == 0 ? "shape=\"s\" mass=\"1\"" : "shape=\"q\" mass=\"1\"");
    }
    return scene("1/240", out + component("contact", "CDetection/ODE", "between=\"*\" response.friction=\"0.5\""));
}

namespace
{

/// Cubes of 0.5 m where they stand. With a manager impacts are not located.
std::string standing(const std::vector<Vec3>& places, const std::string& manager)
{
    std::string out = kGravity + kGround + component("s", "Shape/Box", "half_extents=\"0.25 0.25 0.25\"");
    for (std::size_t i = 0; i < places.size(); ++i) out += body(static_cast<int>(i), places[i]);
    if (!manager.empty()) out += component("manager", "Manager/" + manager, "");
    return scene("1/60", out + component("contact", "CDetection/ODE",
                                         manager.empty() ? "between=\"*\" response.friction=\"0.5\""
                                                         : "between=\"*\" resolution=\"Resolution/None\" response=\"Response/Rows\" "
                                                           "response.manager=\"manager\" response.friction=\"0.5\""));
}

}  // namespace

std::string tower(int high, const std::string& manager)
{
    std::vector<Vec3> places;
    for (int k = 0; k < high; ++k) places.push_back({0, 0, 0.25 + 0.5 * k});
    return standing(places, manager);
}

std::string pyramid(int wide, const std::string& manager)
{
    std::vector<Vec3> places;
    for (int k = 0; k < wide; ++k)
        for (int i = 0; i < wide - k; ++i) places.push_back({0.52 * i + 0.26 * k, 0, 0.25 + 0.5 * k});
    return standing(places, manager);
}

std::string stacks_on_springs(int n)
{
    std::string out = kGravity + kGround + component("s", "Shape/Box", "half_extents=\"0.25 0.25 0.25\"");
    for (int i = 0; i < n; ++i) out += body(i, {1.0 * (i / 3 % 100), 1.0 * (i / 300), 0.25 + 0.5 * (i % 3)});
    return scene("1/240",
                 out + component("contact", "CDetection/ODE", "between=\"*\" response=\"Response/Penalty\" response.friction=\"0.5\""));
}

std::string cubes_apart(int n)
{
    std::vector<Vec3> places;
    for (int i = 0; i < n; ++i) places.push_back({1.0 * (i % 100), 1.0 * (i / 100), 0.25});
    return standing(places, "");
}

std::string tumbled(const char* type, const std::string& parameters, int n)
{
    std::string out = kGravity + kGround + component("s", type, parameters);
    std::uint64_t random = 6;
    const int side = std::max(3, static_cast<int>(std::lround(std::sqrt(n / 10.0))));
    const auto jitter = [&] { return 0.02 * (2 * next_uniform(random) - 1); };
    for (int i = 0; i < n; ++i)
    {
        const double x = jitter(), y = jitter();
        const Quat q = random_rotation(random);
        out += body(i, {0.32 * (i % side) + x, 0.32 * (i / side % side) + y, 0.3 + 0.32 * (i / (side * side))},
                    "shape=\"s\" mass=\"1\" orientation=\"" + text(q) + "\"");
    }
    return scene("1/60", out + heap_contact(0.5));
}

std::string chains_in_a_heap(int n)
{
    constexpr int kLinks = 5;
    std::string out = kGravity + kGround + component("s", "Shape/Box", "half_extents=\"0.1 0.05 0.05\"");
    std::uint64_t random = 8;
    for (int c = 0; c < n; ++c)
    {
        const Vec3 first{0.5 * (c % 3), 0.5 * (c / 3 % 3), 0.3 + 0.25 * (c / 9)};
        for (int k = 0; k < kLinks; ++k)
        {
            const int b = kLinks * c + k;
            out += body(b, first + Vec3{0.21 * k, 0.02 * next_uniform(random), 0});
            if (k > 0)
                out += component(numbered("j", b), "Constraint/Ball",
                                 "a=\"" + numbered("b", b - 1) + "\" b=\"" + numbered("b", b) + "\" anchor=\"" +
                                     text(first + Vec3{0.21 * k - 0.105, 0, 0}) + "\"");
        }
    }
    return scene("1/240",
                 out + component("contact", "CDetection/ODE", "between=\"*\" resolution=\"Resolution/None\" response.friction=\"0.5\""));
}

namespace
{

std::string part(const std::string& id, const char* shape, double mass, const Vec3& at)
{
    return component(id, "State/RigidBody",
                     std::string("shape=\"") + shape + "\" mass=\"" + text(mass) + "\" position=\"" + text(at) + "\"");
}

/// A hinge with a servo that turns it to `angle`.
std::string servo(const std::string& id, const std::string& a, const std::string& b, const Vec3& at, double angle)
{
    const std::string between = "axis=\"0 1 0\" a=\"" + a + "\" b=\"" + b + "\" anchor=\"" + text(at) + "\"";
    return component("h" + id, "Constraint/Hinge", between) +
           component("m" + id, "Constraint/Actuator",
                     between + " gain=\"60\" bias=\"0 -60 -2\" force_lower=\"-40\" force_upper=\"40\" control=\"" + text(angle) + "\"");
}

}  // namespace

std::string four_legged(int n)
{
    std::string out = kGravity + kGround + component("trunk", "Shape/Box", "half_extents=\"0.3 0.15 0.08\"") +
                      component("thigh", "Shape/Capsule", "radius=\"0.03\" length=\"0.2\"") +
                      component("shin", "Shape/Capsule", "radius=\"0.025\" length=\"0.22\"");
    const int side = std::max(1, static_cast<int>(std::ceil(std::sqrt(n))));
    for (int i = 0; i < n; ++i)
    {
        const std::string t = numbered("t", i);
        const Vec3 at{1.5 * (i % side), 1.5 * (i / side), 0.75};
        out += part(t, "trunk", 8, at);
        for (int leg = 0; leg < 4; ++leg)
        {
            const std::string id = numbered("", 4 * i + leg);
            const Vec3 hip = at + Vec3{leg < 2 ? 0.25 : -0.25, leg % 2 == 0 ? -0.2 : 0.2, 0};
            out += part("u" + id, "thigh", 1, hip - Vec3{0, 0, 0.15}) + part("l" + id, "shin", 0.5, hip - Vec3{0, 0, 0.45});
            out += servo("u" + id, t, "u" + id, hip, 0.4) + servo("l" + id, "u" + id, "l" + id, hip - Vec3{0, 0, 0.3}, -0.8);
        }
    }
    return scene("1/240", out + component("contact", "CDetection/ODE", "between=\"*\" response.friction=\"0.8\""));
}

std::string heavy_chain(int links)
{
    std::string out =
        kGravity + component("s", "Shape/Capsule", "radius=\"0.02\" length=\"0.05\"") + component("ball", "Shape/Sphere", "radius=\"0.5\"");
    for (int i = 0; i <= links; ++i)
    {
        const std::string pin = (i > 0 ? "a=\"" + numbered("b", i - 1) + "\" " : "") + ("anchor=\"" + text(Vec3{0.1 * i, 0, 0}) + "\"");
        out += i < links ? body(i, {0.1 * (i + 0.5), 0, 0}, "shape=\"s\" mass=\"0.1\" orientation=\"axis 0 1 0 90 deg\"")
                         : body(i, {0.1 * i + 0.5, 0, 0}, "shape=\"ball\" mass=\"1000\"");
        out += component(numbered("j", i), "Constraint/Ball", pin + " b=\"" + numbered("b", i) + "\"");
    }
    return scene("1/240", out);
}

std::string twenty_corners()
{
    std::string out;
    std::uint64_t random = 7;
    for (int i = 0; i < 20; ++i) out += (i > 0 ? " " : "") + text(rotate(random_rotation(random), {0.13, 0, 0}));
    return out;
}

}  // namespace plab::bench
