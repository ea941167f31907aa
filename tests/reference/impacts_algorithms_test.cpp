// Single impacts, with every algorithm (contact_algorithms.h). C1, C2, C3, C5 as in the catalogue. The solver does not matter:
// C1 to C3 are free of forces, and C5 uses the default one, which is exact for constant forces (for C4 with the others see
// impacts_flight_algorithms_test.cpp).
#include <algorithm>
#include <numbers>

#include "impacts.h"

using namespace plab;
using namespace plab::test;

namespace
{
/// Errors of the velocities after a head-on impact of 1 kg with `heavy` and restitution e; that of the second ball is relative.
std::array<double, 2> head_on(const Algorithm& algorithm, double heavy, double e)
{
    Scene s(sphere("a", 0.1, at({-0.3, 0, 0}, {1, 0, 0})) + sphere("b", 0.1, at({0.3, 0, 0}, {}, heavy)) +
                contact("a b", algorithm, e, 0, stiffness(algorithm, 1e6, 1e8)),
            "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1);
    const double v1 = (1 - heavy * e) / (1 + heavy), v2 = (1 + e) / (1 + heavy);
    return {std::fabs(s.vec("a", "linear_velocity").x - v1), std::fabs(s.vec("b", "linear_velocity").x / v2 - 1)};
}
}  // namespace

TEST_CASE("C1: head-on spheres, mass ratios to 1e9, to rounding")
{
    // v1 and v2 for e = .5 and 1; v1 and v2 for e = 0.
    // Springs: errors due to the pieces of a contact. HuntCrossley treats e = 0 as .01, as its damping would otherwise be infinite.
    constexpr Bound<4> table[] = {
        {"*", "Impulse", {1e-15, 1e-15, 1e-15, 1e-15}},
        {"*", "Rows", {1e-15, 1e-15, 1e-15, 1e-15}},
        {"*", "Penalty", {2.2e-9, 1.5e-9, 3e-12, 4e-12}},
        {"*", "HuntCrossley", {1.2e-8, 6e-9, 0.01001, 0.01001}, {0, 0, 0.0099, 0.0099}},
    };
    check_algorithms(every_algorithm(), table,
                     [](const Algorithm& algorithm)
                     {
                         std::array<double, 4> worst{};
                         for (const double heavy : {1.0, 1e3, 1e6, 1e9})
                             for (const double e : {0.0, 0.5, 1.0})
                                 for (std::size_t ball = 0; ball < 2; ++ball)
                                 {
                                     double& off = worst[ball + (e == 0 ? 2 : 0)];
                                     off = std::max(off, head_on(algorithm, heavy, e)[ball]);
                                 }
                         return worst;
                     });
}

TEST_CASE("C1: SoftStep returns all of an elastic impact, to rounding, for any mass ratio")
{
    // The energy limits what is returned; that sums of it differ by rounding must not cost a share of 2^-24.
    for (int i = 0; i <= 90; ++i)
    {
        const double heavy = std::pow(10, 0.1 * i);
        CAPTURE(heavy);
        for (const double error : head_on({"None", "Rows", "SoftStep"}, heavy, 1)) CHECK(error <= 1e-14);
    }
}

namespace
{
struct Oblique
{
    double normal = 0, along = 0, spin = 0;  ///< worst over the azimuths; spin as a share
    double spread = 0;                       ///< between azimuths
};

/// C2 at 8 azimuths, in the frame of the slip.
Oblique oblique(const Algorithm& algorithm, double slip)
{
    const double after = slip == 3 ? 15.0 / 7 : 9.84, spin = slip == 3 ? 150.0 / 7 : 54;
    Oblique out;
    Vec3 first_v, first_w;
    for (int k = 0; k < 8; ++k)
    {
        const double angle = std::numbers::pi / 4 * k;
        const Vec3 t{std::cos(angle), std::sin(angle), 0}, side = cross(Vec3{0, 0, 1}, t);
        Scene s(kGround + sphere("a", 0.1, at({0, 0, 0.5}, t * slip - Vec3{0, 0, 4})) +
                    contact("a ground", algorithm, 0.8, 0.3, stiffness(algorithm, 1e10, 1e13)),
                "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(0.5);
        const Vec3 v = s.vec("a", "linear_velocity"), w = s.vec("a", "angular_velocity");
        const Vec3 v_slip{dot(v, t), dot(v, side), v.z}, w_slip{dot(w, t), dot(w, side), w.z};
        if (k == 0) first_v = v_slip, first_w = w_slip;
        out.normal = std::max(out.normal, std::fabs(v.z - 3.2));
        out.along = std::max(out.along, std::hypot(v_slip.x - after, v_slip.y));
        out.spin = std::max(out.spin, length(w_slip - Vec3{0, spin, 0}) / spin);
        out.spread = std::max({out.spread, length(v_slip - first_v), length(w_slip - first_w) / spin});
    }
    return out;
}
}  // namespace

TEST_CASE("C2: a sphere meets a wall at an angle: stick and slip, the same in all directions")
{
    // None + Impulse: the overlap is up to v h, and the contact point in its middle is nearer to the centre by half of that.
    constexpr double share = 0.5 * 4 / 60 / 0.1;
    // Stick: normal, along, spin; slip: the same; spread over azimuths.
    constexpr Bound<7> table[] = {
        {"None", "Impulse", {1e-13, share * 3, share * 1.5, 1e-13, share * 12, share * 1.5, 1e-14}, {0, 0, 1e-3, 0, 0, 1e-3, 0}},
        // The friction lacks 1.2 = mu (u_n after) m: this manager applies restitution without friction.
        {"None", "Rows/SoftStep", {1e-13, 1e-13, 1e-13, 1e-13, 0.961, 0.445, 1e-14}, {0, 0, 0, 0, 0.959, 0.444, 0}},
        // A contact across a gap acts in the middle of the gap, with a lever arm that is too long.
        {"Speculative", "Rows/SoftStep", {1e-13, 0.32, 0.15, 1e-13, 0.961, 0.27, 1e-14}, {0, 0.3, 0.14, 0, 0.959, 0.25, 0}},
        {"halved", "*", {2e-13, 2e-13, 2e-13, 2e-13, 2e-13, 2e-13, 1e-14}},
        {"*", "Impulse", {1e-13, 1e-13, 1e-13, 1e-13, 1e-13, 1e-13, 1e-14}},
        {"*", "Rows", {1e-13, 1e-13, 1e-13, 1e-13, 1e-13, 1e-13, 1e-14}},
        {"*", "Penalty", {7e-10, 0.08, 0.1, 7e-10, 0.02, 0.009, 1.5e-7}, {0, 0.02, 0.02, 0, 0.005, 0.002, 0}},
        {"*", "HuntCrossley", {8e-9, 0.03, 0.035, 8e-9, 2.4e-9, 1.6e-4, 2e-11}, {0, 0.007, 0.008, 0, 0, 0, 0}},
    };
    check_algorithms(
        every_algorithm(), table,
        [](const Algorithm& algorithm)
        {
            const Oblique stick = oblique(algorithm, 3), slip = oblique(algorithm, 12);
            return std::array{
                stick.normal, stick.along, stick.spin, slip.normal, slip.along, slip.spin, std::max(stick.spread, slip.spread)};
        });
}

namespace
{
/// Linear and angular velocity after the end of a rod has hit an edge.
std::array<double, 2> rod_on_edge(const Algorithm& algorithm, double e)
{
    // J = (1 + e) v m / (1 + 12 (a/L)^2), arm a: 1/4 of (1 + e) v m at a = L/2, where the edge has 1 nm to hit.
    const double arm = 0.499999999;
    // The rod turns after a plastic impact, and the round edge presses on until the end of the step, by about w^2 R h. Springs need time.
    const double h = algorithm.springs() ? 1.0 / 60 : 1e-6, radius = algorithm.springs() ? 0.1 : 1e-3;
    const double gap = algorithm.springs() ? 0.399 : 9.5 * h;
    Scene s(
        "<component id=\"rod.shape\" type=\"Shape/Box\" half_extents=\"0.5 0.001 0.001\"/>"
        "<component id=\"rod\" type=\"State/RigidBody\" inertia=\"1e-3 0.083333333333333333 0.083333333333333333\" "
        "shape=\"rod.shape\" " +
            at({0, 0, radius + 0.001 + gap}, {0, 0, -1}) + "/>" +
            sphere("edge", radius, "position=\"" + text(Vec3{arm, 0, 0}) + "\"", "Static") +
            contact("rod edge", algorithm, e, 0, stiffness(algorithm, 1e9, 1e12)),
        "dt=\"" + text(h) + "\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = algorithm.is("ConservativeAdvancement");  // the rod rotates close to the edge
    while (s.vec("rod", "linear_velocity").z == -1 && s.simulation().time() < 1) s.step();
    const double J = (1 + e) / (1 + 12 * arm * arm);
    CHECK(std::fabs(J - 0.25 * (1 + e)) < 2e-9);
    return {std::fabs(s.vec("rod", "linear_velocity").z - (J - 1)),
            std::fabs(std::fabs(s.vec("rod", "angular_velocity").y) - 12 * arm * J)};
}
}  // namespace

TEST_CASE("C3: the end of a rod hits an edge: the effective mass is a quarter of its mass")
{
    // Speed and spin for e = .5 and 1, and for e = 0.
    constexpr Bound<4> table[] = {{"*", "Impulse", {1e-14, 1e-14, 1e-14, 1e-14}},
                                  {"*", "Rows", {1e-14, 1e-14, 6e-10, 4e-9}},
                                  {"*", "Penalty", {6e-6, 1.6e-5, 1.2e-4, 7e-4}},
                                  {"*", "HuntCrossley", {3e-6, 1.2e-5, 5e-3, 0.03}}};
    check_algorithms(every_algorithm(), table,
                     [](const Algorithm& algorithm)
                     {
                         std::array<double, 4> worst{};
                         for (const double e : {0.0, 0.5, 1.0})
                             for (std::size_t i = 0; i < 2; ++i)
                             {
                                 double& off = worst[i + (e == 0 ? 2 : 0)];
                                 off = std::max(off, rod_on_edge(algorithm, e)[i]);
                             }
                         return worst;
                     });
}

namespace
{
constexpr double kStiff = 1e8;

/// A ball of 1 kg falls 1 m and bounces until it rests. Measures: gap, speed and creep afterwards; the delay with which its last
/// bounce or rest is reported; the event that ends Zeno's sequence.
std::array<double, 5> bounce_out(const Algorithm& algorithm, double e, double rest)
{
    Scene s(kGround + sphere("a", 0.1, at({0, 0, 1.1})) + gravity("a") +
                contact("a ground", algorithm, e, 0, stiffness(algorithm, kStiff, 1e10)),
            "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    s.run(rest + 2);
    // Springs yield: m g / k, (m g / k)^(2/3).
    const double deep = !algorithm.springs() ? 0 : algorithm.law() == "Penalty" ? 9.81 / kStiff : std::pow(9.81 / 1e10, 2. / 3);
    const double gap = s.vec("a", "position").z - 0.1, speed = length(s.vec("a", "linear_velocity"));
    double last = 0;
    for (const Event& event : s.events)
        if (event.kind == "contact.begin" || event.kind == "contact.rest") last = std::max(last, event.time);
    s.run(rest + 4);
    const double late = 2.0 / 60 * std::log(std::sqrt(2 * 9.81) / (9.81 / 120)) / -std::log(e);
    return {std::fabs(gap + deep), speed, std::fabs(s.vec("a", "position").z - 0.1 - gap),
            std::fabs(last - rest) / (algorithm.locates() ? 1 : late), static_cast<double>(s.count("contact.zeno"))};
}
}  // namespace

TEST_CASE("C5: bounces that lose speed end at the sum of their series, with the accuracy of each algorithm")
{
    // h = 1 m: t = sqrt(2 h / g) (1 + e) / (1 - e).
    // If bounces are not located, all bounces that last longer than a step are up to 2 h late; the fourth value is in units of
    // that.
    constexpr Bound<5> table[] = {
        {"certified", "Rows/SoftStep", {3.5e-5, 1e-15, 1e-15, 1e-13, 1}, {0, 0, 0, 0, 1}},
        {"certified", "*", {3e-13, 2e-13, 4e-13, 1e-13, 1}, {0, 0, 0, 0, 1}},
        // Suppressed by `rest_height`: sqrt(8 rest_height / g) / (1 - e) s.
        {"halved", "Rows/SoftStep", {3.5e-5, 1e-15, 1e-15, 1e-6, 0}},
        {"halved", "*", {3e-13, 2e-13, 4e-13, 1e-6, 0}},
        {"at ends", "Impulse", {1e-14, 1e-14, 1e-14, 1, 0}},
        {"at ends", "Rows/Direct", {3e-13, 2e-13, 4e-13, 1, 0}},
        {"at ends", "Rows/SequentialImpulse", {6e-5, 1e-15, 1e-15, 1, 0}},
        {"at ends", "Rows/SoftStep", {9, 9, 9, 9, 0}},
        {"*", "springs", {1e-15, 1e-12, 1e-15, 1, 0}},
    };
    for (const auto& [e, rest] : {std::pair(0.5, 1.35457092295719271), std::pair(0.9, 8.57894917872888718)})
    {
        CAPTURE(e);
        check_algorithms(every_algorithm(), table,
                         [e = e, rest = rest](const Algorithm& algorithm) { return bounce_out(algorithm, e, rest); });
    }
}
