// Mechanisms in the impulses of their contacts alone: a column of boxes that are welded to one another across light links, whose contacts
// have the loads and the friction of one rigid body.
#include <cmath>

#include "islands.h"
#include "managers/delassus.h"
#include "managers/newton.h"
#include "support/gravity.h"

using namespace plab;
using namespace plab::managers;
using plab::test::IslandWorld;
using plab::test::kG;
using plab::test::kStep;
using plab::test::problem_of;

namespace
{

constexpr double kGrip = 0.5;  // coefficient of friction
constexpr std::size_t kBoxes = 12;

/// b is welded to a at a point: three rows for the point, three for the turn.
void weld(IslandWorld& w, std::uint32_t a, std::uint32_t b, const Vec3& at)
{
    for (const bool turns : {false, true})
        for (int k = 0; k < 3; ++k)
        {
            Vec3 e;
            e[k] = 1;
            ConstraintRow& row = w.rows.emplace_back();
            row.count = 2;
            row.blocks[0].participant = {Facet::Body, a}, row.blocks[1].participant = {Facet::Body, b};
            if (turns)
                row.blocks[0].angular = -e, row.blocks[1].angular = e;
            else
            {
                row.blocks[0].linear = -e, row.blocks[0].angular = -cross(at - w.bodies.position[a], e);
                row.blocks[1].linear = e, row.blocks[1].angular = cross(at - w.bodies.position[b], e);
            }
        }
}

/// A column that stands on four corners; every second box has `ratio` times the mass and half the size of the others.
IslandWorld column(double ratio)
{
    IslandWorld w;
    const std::uint32_t floor = w.add_box(0, {9, 9, 1}, {0, 0, -1});
    std::uint32_t below = w.add_box(1, {2, 2, 0.1}, {0, 0, 0.1});
    w.add_face(floor, below, {}, 2, 2, kGrip);
    for (std::size_t i = 1; i < kBoxes; ++i)
    {
        const double z = 0.2 * static_cast<double>(i), half = i % 2 == 0 ? 0.1 : 0.05;
        const std::uint32_t box = w.add_box(i % 2 == 0 ? 1 : ratio, {half, half, half}, {0, 0, z + 0.1});
        weld(w, below, box, {0, 0, z});
        below = box;
    }
    return w;
}

Problem mechanism_of(IslandWorld& w)
{
    Problem p = problem_of(w);
    for (Line& line : p.lines) line.least = -HUGE_VAL, line.most = HUGE_VAL, line.impulse = 0;
    return p;
}

double mass_of(const IslandWorld& w)
{
    double sum = 0;
    for (const std::uint32_t b : w.members) sum += w.bodies.mass[b];
    return sum;
}

Vec3 sum_of(const Problem& p)
{
    Vec3 sum;
    for (const Point& point : p.points) sum += to_world(point, point.impulse);
    return sum;
}

double largest_speed(const Problem& p)
{
    double most = 0;
    for (const Mover& m : p.movers) most = std::fmax(most, length(m.v) + length(m.w));
    return most;
}

}  // namespace

TEST_CASE("a mechanism with links of next to no mass carries its weight, whatever the ratio of masses")
{
    for (const double ratio : {1.0, 1e-5, 1e-8})
    {
        CAPTURE(ratio);
        IslandWorld w = column(ratio);
        w.kick({0, 0, -kG * kStep});
        Problem p = mechanism_of(w);
        const auto found = DelassusSolver().solve(p, {});
        CHECK(found.solved);
        CHECK_FALSE(found.fell_back);
        CHECK(found.sweeps == 0);
        CHECK(sum_of(p).z == doctest::Approx(mass_of(w) * kG * kStep).epsilon(1e-12));
        for (const Point& point : p.points) CHECK(point.impulse.z == doctest::Approx(0.25 * mass_of(w) * kG * kStep).epsilon(1e-9));
        // What rounding of the largest impulse does to the lightest link.
        CHECK(largest_speed(p) < 1e-13 * mass_of(w) * kG * kStep / ratio);
    }
}

TEST_CASE("a mechanism that slides has the friction of one body, and a weld that closes a loop changes nothing")
{
    for (const bool loop : {false, true})
    {
        CAPTURE(loop);
        IslandWorld w = column(1e-5);
        if (loop) weld(w, w.members[2], w.members[6], {0, 0, 1});
        w.kick({0.5, 0, -kG * kStep});
        Problem p = mechanism_of(w);
        const auto found = DelassusSolver().solve(p, {});
        CHECK(found.solved);
        CHECK_FALSE(found.fell_back);
        const double weight = mass_of(w) * kG * kStep;
        CHECK(sum_of(p).x == doctest::Approx(-kGrip * weight).epsilon(1e-10));
        CHECK(p.movers.front().v.x == doctest::Approx(0.5 - kGrip * kG * kStep).epsilon(1e-10));
        CHECK(violation(p) < 1e-8);  // rounding of its impulses, over the inertia of a light link
    }
}

TEST_CASE("a solution depends on its problem alone, whatever was solved before")
{
    IslandWorld w = column(1e-5);
    w.kick({0.5, 0, -kG * kStep});
    // In this one a row of a weld says what another one says.
    Problem implied = mechanism_of(w);
    implied.lines[5] = implied.lines[4];
    DelassusSolver used;
    CHECK(used.solve(implied, {}).solved);
    CHECK(std::fabs(implied.gap(implied.lines[5])) < 1e-8);
    Problem later = mechanism_of(w), first = mechanism_of(w);
    CHECK(used.solve(later, {}).solved);
    CHECK(DelassusSolver().solve(first, {}).solved);
    for (std::size_t i = 0; i < first.lines.size(); ++i) CHECK(later.lines[i].impulse == first.lines[i].impulse);
    for (std::size_t i = 0; i < first.points.size(); ++i) CHECK(later.points[i].impulse == first.points[i].impulse);
}

TEST_CASE("what has more impulses than pay, and what has no joints, is left as it was")
{
    IslandWorld w = column(1e-5);
    for (std::uint32_t i = 0; i < 70; ++i) w.add_contact(0, w.members[0], {0.02 * i, 0, 0}, {0, 0, 1}, kGrip);
    w.kick({0, 0, -1});
    Problem p = mechanism_of(w);
    CHECK_FALSE(DelassusSolver().solve(p, {}).solved);
    CHECK(sum_of(p) == Vec3{});
    CHECK(p.movers.front().v.z == -1);
    IslandWorld boxes;
    boxes.add_stack({1, 1}, kGrip);
    boxes.kick({0, 0, -1});
    Problem stack = problem_of(boxes);
    CHECK_FALSE(DelassusSolver().solve(stack, {}).solved);
    CHECK(NewtonSolver().solve(stack, {}).converged);
}
