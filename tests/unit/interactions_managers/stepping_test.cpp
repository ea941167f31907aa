// Whole steps of islands: stops, bounces, overlap, sub-steps.
#include <cmath>

#include "islands.h"
#include "managers/manager_rows.h"
#include "support/gravity.h"
#include "support/one_row.h"

using namespace plab;
using namespace plab::managers;
using plab::test::GravityMotion;
using plab::test::IslandWorld;
using plab::test::kG;
using plab::test::OneRow;

namespace
{

/// Steps with new contacts at the present points of b; contact points go with their bodies.
template <class Table, class Solve>
void run(IslandWorld& w, OneRow<Table>& manager, Solve solve, double h, int steps)
{
    for (int i = 0; i < steps; ++i)
    {
        GravityMotion motion(w, kG);
        Island island = w.island(h);
        island.motion = &motion;
        const std::vector<Vec3> start = w.bodies.position;
        solve(StepContext{}, 0, manager.rows, w.bodies, w.shafts, island);
        motion.refresh_depths();
        for (Contact& c : w.contacts) c.point += w.bodies.position[c.b.index] - start[c.b.index], c.approach = 0;
    }
}

}  // namespace

TEST_CASE("C14: a sliding box stops at the position of the closed form, whatever the step: 1e-12 with Direct, 1e-8 with sweeps")
{
    const double v = 3, mu = 0.4, method = v * v / (2 * mu * kG);
    for (const double h : {1.0 / 60, 1.0 / 30, 0.1})
    {
        CAPTURE(h);
        const int steps = static_cast<int>(1.0 / h);
        for (const bool direct : {true, false})
        {
            IslandWorld w;
            const auto ground = w.add_box(0, {9, 9, 1}, {0, 0, -1}), box = w.add_box(1, {0.25, 0.25, 0.1}, {0, 0, 0.1});
            w.add_face(ground, box, {0, 0, 0}, 0.25, 0.25, mu);
            w.bodies.velocity[box] = Vec3{std::cos(0.5), std::sin(0.5), 0} * v;
            OneRow<DirectRows> exact;
            OneRow<SequentialRows> swept;
            if (direct)
                run(w, exact, solve_direct, h, steps);
            else
                run(w, swept, solve_sequential, h, steps);
            CHECK(std::fabs(std::hypot(w.bodies.position[box].x, w.bodies.position[box].y) / method - 1) < (direct ? 1e-12 : 1e-7));
            CHECK(length(w.bodies.velocity[box]) < (direct ? 1e-12 : 1e-7));
        }
    }
}

TEST_CASE("an elastic impact returns the approach speed, then gravity acts: energy is conserved")
{
    IslandWorld w;
    const auto ground = w.add_box(0, {9, 9, 1}, {0, 0, -1}), box = w.add_box(1, {0.5, 0.5, 0.5}, {0, 0, 0.5});
    w.add_face(ground, box, {0, 0, 0}, 0.5, 0.5, 0);
    for (Contact& c : w.contacts) c.restitution = 1, c.approach = 2;
    w.bodies.velocity[box] = {0, 0, -2};
    OneRow<DirectRows> exact;
    const double h = 1.0 / 60;
    run(w, exact, solve_direct, h, 1);
    const double v = w.bodies.velocity[box].z, rise = w.bodies.position[box].z - 0.5;
    CHECK(v == doctest::Approx(2 - kG * h).epsilon(1e-13));
    CHECK(std::fabs(0.5 * v * v + kG * rise - 2) < 1e-13);
}

TEST_CASE("overlap is corrected without adding speed")
{
    IslandWorld w;
    w.add_stack({1, 1, 1}, 0.5);
    for (std::size_t i = 0; i < w.contacts.size(); ++i) w.contacts[i].depth = 1e-3;
    OneRow<DirectRows> exact;
    run(w, exact, solve_direct, 1.0 / 60, 1);
    for (const Contact& c : w.contacts) CHECK(c.depth == doctest::Approx(0).scale(1).epsilon(1e-9));
    for (const std::uint32_t b : w.members) CHECK(length(w.bodies.velocity[b]) < 1e-12);
    CHECK(w.bodies.position[w.members[2]].z == doctest::Approx(2.5 + 3e-3).epsilon(1e-9));
}

TEST_CASE("sweeps from a bad initial guess add no energy")
{
    IslandWorld w;
    w.add_stack(std::vector<double>(8, 1.0), 0.5);
    // An initial guess that would throw the boxes up.
    for (Contact& c : w.contacts) c.impulse = {0, 0, 30};
    OneRow<SequentialRows> swept;
    run(w, swept, solve_sequential, 1.0 / 60, 1);
    double energy = 0;
    for (const std::uint32_t b : w.members) energy += w.bodies.kinetic_energy(b);
    CHECK(energy <= 8 * 0.5 * std::pow(kG / 60, 2));
}

TEST_CASE("SoftStep: a box sinks by the amount of its stiffness and rests; so does a row of ten")
{
    for (const std::size_t n : {1u, 10u})
    {
        IslandWorld w;
        w.add_stack(std::vector<double>(n, 1.0), 0.6);
        OneRow<SoftStepRows> soft;
        run(w, soft, solve_soft_step, 1.0 / 60, 300);
        const double sink = static_cast<double>(n) - 0.5 - w.bodies.position[w.members.back()].z;
        CHECK(sink > 0);
        CHECK(sink < (n == 1 ? 1e-4 : 0.02));
        CHECK(length(w.bodies.velocity[w.members.back()]) < 1e-3);
    }
}
