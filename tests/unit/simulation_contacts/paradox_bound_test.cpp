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
    /// A box of mass m with half extents that differ by up to `slender`.
    Vec3 inertia_of_box(double m, double slender)
    {
        const Vec3 h{(*this)(1, slender), (*this)(1, slender), (*this)(1, slender)};
        return Vec3{h.y * h.y + h.z * h.z, h.z * h.z + h.x * h.x, h.x * h.x + h.y * h.y} * (m / 3);
    }
};

double reach_of(const Bodies& b, const Contact& c)
{
    return std::max(wedging(b, c.a.index) * length_squared(c.point - b.position[c.a.index]),
                    wedging(b, c.b.index) * length_squared(c.point - b.position[c.b.index]));
}

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
        add_body(b, n, draw.inertia_of_box(n, 8), draw.turn());
        add_body(b, m, draw.inertia_of_box(m, 8), draw.turn());
        b.position[0] = draw.direction() * draw(0, 8), b.position[1] = draw.direction() * draw(0, 8);
        b.velocity[1] = draw.direction() * 10;
        Contact c;
        c.a = {Facet::Body, 0}, c.b = {Facet::Body, 1};
        c.normal = draw.direction(), c.friction = draw(0, 4);
        const double share = pressing_share(b, c, 1);
        if (excludes_paradox(c.friction, reach_of(b, c)))
            ++excluded, least = std::min(least, share);
        else if (share <= 0)
            ++paradoxes;
    }
    CHECK(excluded > 1000);
    CHECK(paradoxes > 1000);
    CHECK(least > 0);
    CHECK(least < 0.5);  // the bound was put to the test
}

TEST_CASE("a cube is excluded up to a friction of 0.94, a slender rod of a length of 20 widths is not")
{
    Bodies b;
    add_body(b, 0, {}, {}), add_body(b, 3, Vec3{2, 2, 2}, {});  // a cube with half extents of 1 m: I = 2/3 m h^2
    Contact c;
    c.a = {Facet::Body, 0}, c.b = {Facet::Body, 1};
    c.point = {1, 1, 1};
    CHECK(excludes_paradox(0.93, reach_of(b, c)));
    CHECK_FALSE(excludes_paradox(0.95, reach_of(b, c)));
    const double long_one = 401.0, thin = 2.0;  // h^2 + w^2 of half extents 20, 1, 1
    b.inverse_inertia_B[1] = Mat3::diagonal(1 / thin, 1 / long_one, 1 / long_one);
    c.point = {20, 1, 1};
    CHECK_FALSE(excludes_paradox(0.3, reach_of(b, c)));
}
