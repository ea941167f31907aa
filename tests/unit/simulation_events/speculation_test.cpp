// The margin within which gaps are searched for: no gap beyond it can close within the step.
#include "simulation/contacts/speculation.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "simulation/contacts/paradox.h"

using namespace plab;
using namespace plab::simulation;

namespace
{

struct Two
{
    Bodies bodies;
    std::vector<double> radius;

    void add(Motion motion, const Vec3& p, const Vec3& v, const Vec3& w, double r, const Mat3& inverse_inertia = Mat3::diagonal(1, 1, 1))
    {
        bodies.motion.push_back(motion), bodies.position.push_back(p), bodies.velocity.push_back(v);
        bodies.orientation.push_back({}), bodies.angular_velocity.push_back(w), bodies.angular_momentum.push_back(w);
        const bool moves = motion == Motion::Dynamic;
        bodies.mass.push_back(moves ? 1 : HUGE_VAL), bodies.inverse_mass.push_back(moves ? 1 : 0);
        bodies.inertia_B.push_back(Mat3::diagonal(1, 1, 1)), bodies.inverse_inertia_B.push_back(inverse_inertia);
        bodies.needle.push_back(0), bodies.center_B.push_back({}), bodies.material.push_back(0), bodies.shapes.push_back({});
        radius.push_back(r);
    }
};

const Ref kA{Facet::Body, 0}, kB{Facet::Body, 1};

Contact gap(double width)
{
    Contact c;
    c.a = kA, c.b = kB, c.normal = {0, 0, 1}, c.depth = -width;
    return c;
}

}  // namespace

TEST_CASE("a margin covers the approach of the two fastest bodies, and what forces add")
{
    Two s;
    s.add(Motion::Static, {}, {100, 0, 0}, {}, HUGE_VAL);
    s.add(Motion::Dynamic, {0, 0, 1}, {0, 3, -4}, {}, 0.5);
    s.add(Motion::Dynamic, {0, 0, 2}, {0, 0, 1}, {0, 2, 0}, 0.5);
    const double h = 0.1;
    CHECK(speculative_margin(s.bodies, s.radius, 0, h) >= (5 + 2) * h);
    CHECK(speculative_margin(s.bodies, s.radius, 0, h) < 3 * (5 + 2) * h);  // a static body has no speed
    CHECK(speculative_margin(s.bodies, s.radius, 20, h) - speculative_margin(s.bodies, s.radius, 0, h) >= 20 * h * h);
}

TEST_CASE("a gap may close if its speed, rotation or forces close it in time")
{
    Two s;
    s.add(Motion::Static, {}, {}, {}, HUGE_VAL);
    s.add(Motion::Dynamic, {0, 0, 1}, {7, 0, -2}, {}, 0.5);
    const double h = 0.01;
    CHECK(may_close(s.bodies, s.radius, gap(0.02), 0, h));
    CHECK_FALSE(may_close(s.bodies, s.radius, gap(0.1), 0, h));
    CHECK(may_close(s.bodies, s.radius, gap(0.1), 1e3, h));
    s.bodies.velocity[1] = {7, 0, 2};  // separates: only overlaps count
    CHECK_FALSE(may_close(s.bodies, s.radius, gap(1e-9), 0, h));
    CHECK(may_close(s.bodies, s.radius, gap(-1e-9), 0, h));
    s.bodies.angular_velocity[1] = {0, 10, 0};
    CHECK(may_close(s.bodies, s.radius, gap(0.05), 0, h));
}

TEST_CASE("persistent pairs are tested as far as their corners move, and no further than useful")
{
    Two s;
    s.add(Motion::Static, {}, {}, {}, HUGE_VAL);
    s.add(Motion::Dynamic, {0, 0, 1}, {5, 0, 0}, {}, 0.5);
    const auto margin = [&](double h) { return closing_margin(s.bodies, s.radius, kA, kB, {0, 0, 1}, h); };
    CHECK(margin(0.01) == 0);  // it slides
    s.bodies.angular_velocity[1] = {0, 4, 0};
    CHECK(margin(0.01) >= 4 * 0.5 * 0.01);
    CHECK(margin(0.01) < 3 * 4 * 0.5 * 0.01);
    CHECK(margin(10) == 0.25);
    // The other way round.
    s.bodies.angular_velocity[1] = {}, s.bodies.velocity[1] = {0, 0, -1};
    CHECK(margin(0.01) >= 0.01);
    CHECK(closing_margin(s.bodies, s.radius, kB, kA, {0, 0, -1}, 0.01) == margin(0.01));
}

TEST_CASE("Painleve's rod: (1 + 3 cos^2 - 3 mu sin cos) / (1 + 3 cos^2) times the value of a point mass")
{
    // A slender rod of 1 kg and 1 m, its end at the origin, which slides ahead of its centre towards -x.
    const double angle = 1.0471975511965976, sin = std::sin(angle), cos = std::cos(angle);
    Two s;
    s.add(Motion::Static, {}, {}, {}, HUGE_VAL);
    s.add(Motion::Dynamic, {0.5 * cos, 0, 0.5 * sin}, {-3, 0, 0}, {}, 0.5, Mat3::diagonal(12, 12, 1e4));
    Contact c = gap(0);
    for (const double mu : {0.5, 1.5})
    {
        c.friction = mu;
        const double p = 1 + 3 * cos * cos - 3 * mu * sin * cos;  // -.1985571585 at mu = 1.5
        CHECK(std::fabs(pressing_share(s.bodies, c, 1.0 / 240) - p / (1 + 3 * cos * cos)) < 1e-14);
        CHECK((pressing_share(s.bodies, c, 1.0 / 240) < 0) == (mu == 1.5));
    }
    s.bodies.velocity[1] = {3, 0, 0};  // dragged the other way there is no paradox
    CHECK(pressing_share(s.bodies, c, 1.0 / 240) > 1);
    s.bodies.velocity[1] = {};
    CHECK(pressing_share(s.bodies, c, 1.0 / 240) == 1);
}
