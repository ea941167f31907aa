// The bound that spares most contacts the check for Painleve's paradox excludes no contact that has it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "plab/rotation.h"
#include "simulation/contacts/paradox.h"

using namespace plab;
using namespace plab::simulation;

namespace
{

void add_body(Bodies& b, double mass, const Vec3& inertia, const Quat& q)
{
    const bool moves = mass > 0;
    b.motion.push_back(moves ? Motion::Dynamic : Motion::Static);
    b.position.push_back({}), b.orientation.push_back(q), b.velocity.push_back({});
    b.angular_velocity.push_back({}), b.angular_momentum.push_back({});
    b.mass.push_back(mass), b.inverse_mass.push_back(moves ? 1 / mass : 0), b.needle.push_back(0);
    b.inertia_B.push_back(Mat3::diagonal(inertia.x, inertia.y, inertia.z));
    b.inverse_inertia_B.push_back(moves ? Mat3::diagonal(1 / inertia.x, 1 / inertia.y, 1 / inertia.z) : Mat3{});
    b.center_B.push_back({}), b.material.push_back(0), b.shapes.push_back({});
}

struct Draw
{
    std::mt19937 random{7};
    double operator()(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); }
    Vec3 direction() { return normalized(Vec3{(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)}); }
    Quat turn() { return exp_rotation(direction() * (*this)(0, 3)); }
    Vec3 half(double slender) { return {(*this)(1, slender), (*this)(1, slender), (*this)(1, slender)}; }
    Vec3 point_in(const Vec3& h) { return {(*this)(-h.x, h.x), (*this)(-h.y, h.y), (*this)(-h.z, h.z)}; }
};

Vec3 inertia_of_box(double m, const Vec3& h) { return Vec3{h.y * h.y + h.z * h.z, h.z * h.z + h.x * h.x, h.x * h.x + h.y * h.y} * (m / 3); }

}  // namespace

TEST_CASE("no contact that the bound excludes has Painleve's paradox, and some that it keeps have it")
{
    Draw draw;
    int excluded = 0, paradoxes = 0;
    double least = 1;
    for (int i = 0; i < 20000; ++i)
    {
        Bodies b;
        const double m = draw(0.1, 10), n = i % 3 == 0 ? 0 : draw(0.1, 10);
        const double slender = i % 2 == 0 ? 2 : 8;
        const Vec3 ha = draw.half(slender), hb = draw.half(slender);
        add_body(b, n, inertia_of_box(n, ha), draw.turn());
        add_body(b, m, inertia_of_box(m, hb), draw.turn());
        // The contact is at the origin, somewhere in both boxes, mostly at a corner.
        const bool corner = i % 5 != 0;
        b.position[0] = rotate(b.orientation[0], corner ? ha : draw.point_in(ha));
        b.position[1] = rotate(b.orientation[1], corner ? hb : draw.point_in(hb));
        b.velocity[1] = draw.direction() * 10;
        Contact c;
        c.a = {Facet::Body, 0}, c.b = {Facet::Body, 1};
        c.normal = draw.direction(), c.friction = draw(0, 4);
        const double share = pressing_share(b, c, 1);
        if (excludes_paradox(c.friction, std::max(wedging(b, 0, ha, length(ha)), wedging(b, 1, hb, length(hb)))))
            ++excluded, least = std::min(least, share);
        else if (share <= 0)
            ++paradoxes;
    }
    CHECK(excluded > 1000);
    CHECK(paradoxes > 1000);
    CHECK(least > 0);
    CHECK(least < 0.5);  // the bound was put to the test
}

TEST_CASE("up to which friction boxes are excluded")
{
    const auto is_excluded = [](const Vec3& h, double friction, bool knows_extents)
    {
        Bodies b;
        add_body(b, 3, inertia_of_box(3, h), {});
        const Vec3 unknown{HUGE_VAL, HUGE_VAL, HUGE_VAL};
        return excludes_paradox(friction, wedging(b, 0, knows_extents ? h : unknown, length(h)));
    };
    // A cube: m y = 4.5 at its corners, for each direction of sliding. A brick of 2 x 1 x 1: 5.4.
    CHECK(is_excluded({1, 1, 1}, 0.94, true));
    CHECK_FALSE(is_excluded({1, 1, 1}, 0.95, true));
    CHECK(is_excluded({0.5, 0.25, 0.25}, 0.85, true));
    CHECK_FALSE(is_excluded({0.5, 0.25, 0.25}, 0.87, true));
    // By its radius alone: |r|^2 m / I.
    CHECK(is_excluded({0.5, 0.25, 0.25}, 0.66, false));
    CHECK_FALSE(is_excluded({0.5, 0.25, 0.25}, 0.67, false));
    // A rod of 20 x 1 x 1: m y = 6, by its corners.
    CHECK(is_excluded({20, 1, 1}, 0.81, true));
    CHECK_FALSE(is_excluded({20, 1, 1}, 0.82, true));
}
