// Single impacts, on every rung that takes them: resolution x response. C1, C2, C3, C5 as in the catalogue.
//
// | problem | rung                          | bound (measured is smaller)                                               |
// |---------|-------------------------------|---------------------------------------------------------------------------|
// | C1      | all                           | v1' to 1e-15, v2' to 1e-15 of itself, m2/m1 to 1e9, e = 0, .5, 1           |
// | C2      | certifying; Rows, not located | 1e-13, spread over 8 azimuths 1e-14                                       |
// |         | Bisection, LocalBisection     | 2e-13: the time is known to 1e-15 s, the arm to 4e-15 m                   |
// |         | None + Impulse                | normal part 1e-13; friction acts at an arm that is short by half of the   |
// |         |                               | overlap, up to v h / 2: slip and spin are off by that share of R          |
// | C3      | all                           | 1e-14                                                                     |
// | C5      | certifying                    | rest at the sum of the series to 1e-10 s, gap 1e-12 m                     |
// |         | Bisection, LocalBisection     | rest to 1e-6 s (what `rest_height` leaves out), gap 1e-12 m               |
// |         | None                          | no time of rest: each bounce is late by up to h; at rest in the end, gap  |
// |         |                               | 1e-11 m                                                                   |
#include <algorithm>
#include <numbers>

#include "impacts.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("C1: head-on spheres, mass ratios to 1e9, to rounding")
{
    for (const Rung& rung : kRungs)
        for (const double heavy : {1.0, 1e3, 1e6, 1e9})
            for (const double e : {0.0, 0.5, 1.0})
            {
                CAPTURE(rung.name());
                CAPTURE(heavy);
                CAPTURE(e);
                Scene s(
                    sphere("a", 0.1, at({-0.3, 0, 0}, {1, 0, 0})) + sphere("b", 0.1, at({0.3, 0, 0}, {}, heavy)) + contact("a b", rung, e),
                    "dt=\"1/60\"");
                REQUIRE_MESSAGE(s.loaded(), s.error());
                s.run(1);
                const double v1 = (1 - heavy * e) / (1 + heavy), v2 = (1 + e) / (1 + heavy);
                CHECK(std::fabs(s.vec("a", "linear_velocity").x - v1) < 1e-15);
                CHECK(std::fabs(s.vec("b", "linear_velocity").x / v2 - 1) < 1e-15);
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
Oblique oblique(const Rung& rung, double slip)
{
    const double after = slip == 3 ? 15.0 / 7 : 9.84, spin = slip == 3 ? 150.0 / 7 : 54;
    Oblique out;
    Vec3 first_v, first_w;
    for (int k = 0; k < 8; ++k)
    {
        const double angle = std::numbers::pi / 4 * k;
        const Vec3 t{std::cos(angle), std::sin(angle), 0}, side = cross(Vec3{0, 0, 1}, t);
        Scene s(kGround + sphere("a", 0.1, at({0, 0, 0.5}, t * slip - Vec3{0, 0, 4})) + contact("a ground", rung, 0.8, 0.3), "dt=\"1/60\"");
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
    for (const Rung& rung : kRungs)
        for (const double slip : {3.0, 12.0})
        {
            CAPTURE(rung.name());
            CAPTURE(slip);
            const Oblique o = oblique(rung, slip);
            const bool at_end = rung.is("None") && !rung.rows(), halves = rung.locates() && !rung.certifies();
            const double bound = halves ? 2e-13 : 1e-13;
            CHECK(o.normal < bound);
            CHECK(o.spread < 1e-14);
            if (!at_end)
            {
                CHECK(o.along < bound);
                CHECK(o.spin < bound);
                continue;
            }
            // Overlap up to v h; the point in its middle is nearer to the centre by half of that.
            const double share = 0.5 * 4 / 60 / 0.1;
            CHECK(o.along < share * slip);
            CHECK(o.spin < share * 1.5);
            CHECK(o.spin > 1e-3);
        }
}

TEST_CASE("C3: the end of a rod hits an edge: a quarter of its mass answers")
{
    // J = (1 + e) v m / (1 + 12 (a/L)^2), arm a: 1/4 of (1 + e) v m at a = L/2, where the edge has 1 nm to hit.
    const double arm = 0.499999999;
    for (const Rung& rung : kRungs)
        for (const double e : {0.0, 0.5, 1.0})
        {
            CAPTURE(rung.name());
            CAPTURE(e);
            Scene s(
                "<component id=\"rod.shape\" type=\"Shape/Box\" half_extents=\"0.5 0.001 0.001\"/>"
                "<component id=\"rod\" type=\"State/RigidBody\" inertia=\"1e-3 0.083333333333333333 0.083333333333333333\" "
                "shape=\"rod.shape\" " +
                    at({0, 0, 0.5}, {0, 0, -1}) + "/>" + sphere("edge", 0.1, "position=\"" + text(Vec3{arm, 0, 0}) + "\"", "Static") +
                    contact("rod edge", rung, e),
                "dt=\"1/60\"");
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.warnings_expected = rung.is("ConservativeAdvancement");  // the rod turns close by the edge
            while (s.vec("rod", "linear_velocity").z == -1 && s.simulation().time() < 1) s.step();
            const double J = (1 + e) / (1 + 12 * arm * arm);
            CHECK(std::fabs(J - 0.25 * (1 + e)) < 2e-9);
            CHECK(std::fabs(s.vec("rod", "linear_velocity").z - (J - 1)) < 1e-14);
            CHECK(std::fabs(std::fabs(s.vec("rod", "angular_velocity").y) - 12 * arm * J) < 1e-14);
        }
}

TEST_CASE("C5: bounces that lose speed end at the sum of their series, on each rung as well as it can tell")
{
    // h = 1 m: t = sqrt(2 h / g) (1 + e) / (1 - e).
    for (const Rung& rung : kRungs)
        for (const auto& [e, rest] : {std::pair(0.5, 1.35457092295719271), std::pair(0.9, 8.57894917872888718)})
        {
            CAPTURE(rung.name());
            CAPTURE(e);
            Scene s(kGround + sphere("a", 0.1, at({0, 0, 1.1})) + gravity("a") + contact("a ground", rung, e), "dt=\"1/60\"");
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.keep_events = true;
            s.run(rest + 2);
            const double gap = s.vec("a", "position").z - 0.1;
            CHECK(std::fabs(gap) < (rung.locates() ? 1e-12 : 1e-11));
            CHECK(length(s.vec("a", "linear_velocity")) < 1e-11);
            s.run(rest + 4);
            CHECK(std::fabs(s.vec("a", "position").z - 0.1 - gap) < 1e-12);
            if (!rung.locates()) continue;
            const auto rests = events_of(s, "contact.rest");
            REQUIRE(rests.size() == 1);
            CHECK(std::fabs(rests[0].time - rest) < (rung.certifies() ? 1e-10 : 1e-6));
            CHECK(s.count("contact.zeno") == (rung.certifies() ? 1 : 0));
        }
}
