// Reduced coordinates against closed forms (problems F1, F2, F3, F7).
#include <cmath>

#include "plab/random.h"
#include "train.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("F1: a pair has the reflected inertia, and its torques are those of d'Alembert")
{
    for (const bool swapped : {false, true})
    {
        Train t;
        if (swapped) t.shaft_rank = {1, 0};  // the driven shaft is the root
        t.add_shaft(10), t.add_shaft(100);
        const auto g = t.gear(0, 1, exact_ratio(-1, 10));
        t.build();
        const auto a = t.accelerations({6, 0});
        CHECK(relative_error(a[0], 6.0 / 11) < 1e-15);
        CHECK(relative_error(a[1], -0.6 / 11) < 1e-15);
        t.react();
        CHECK(relative_error(t.torque(g), -60.0 / 11) < 1e-15);           // J2 a2
        CHECK(relative_error(6 + 0.1 * t.torque(g), 10 * a[0]) < 1e-15);  // the driver receives -r times it
    }
}

TEST_CASE("F2: six 10:1 meshes, both ways, whichever end is driven and whichever is the root")
{
    for (const std::int64_t up : {1, 10})
        for (const std::uint32_t driven_end : {0u, 6u})
            for (const bool far_root : {false, true})
            {
                CAPTURE(up);
                CAPTURE(driven_end);
                CAPTURE(far_root);
                Train t;
                for (std::uint32_t i = 0; i < 7; ++i) t.add_shaft(1e-3), t.shaft_rank.push_back(far_root ? 6 - i : i);
                for (std::uint32_t i = 0; i < 6; ++i) t.gear(i, i + 1, up == 1 ? exact_ratio(1, 10) : exact_ratio(10, 1));
                t.build();
                std::vector<double> torque(7, 0.0);
                torque[driven_end] = 1;
                const auto a = t.accelerations(torque);
                t.react();
                // 1 + x^2 + ... + x^12 at the shaft that the torque acts on.
                const bool step_down = (up == 1) == (driven_end == 0);
                const double inertia = step_down ? 1.010101010101e-3 : 1.010101010101e9;
                CHECK(relative_error(a[driven_end], 1 / inertia) < 1e-14);
                for (std::uint32_t k = 0; k < 6; ++k)
                {
                    // Back substitution: a mesh carries what the shafts beyond it need.
                    const std::uint32_t near = driven_end == 0 ? k : k + 1;
                    const std::uint32_t beyond = driven_end == 0 ? 6 - k : k + 1;
                    const double step = step_down ? 0.01 : 100;
                    double need = 0;  // reflected to the near shaft
                    for (std::uint32_t j = beyond; j > 0; --j) need = step * (1e-3 + need);
                    const double at_near = -need * a[near];  // torque of the mesh on the near shaft
                    const double f = up == 1 ? 0.1 : 10;
                    const double on_driven = driven_end == 0 ? -at_near / f : at_near;
                    CHECK(relative_error(t.torque(k), on_driven) < 1e-14);
                }
            }
}

TEST_CASE("F3: sudden engagement conserves the momentum of the train and books the energy lost")
{
    Train t;
    t.add_shaft(1, 100), t.add_shaft(2, 0);
    const auto g = t.gear(0, 1, exact_ratio(-1, 2));
    t.build();
    CHECK_FALSE(t.graph.consistent(t.shafts));
    std::vector<double> work(1, 0.0);
    const double change = t.graph.engage(t.shafts, &work);
    CHECK(relative_error(t.shafts.speed[0], 200.0 / 3) < 1e-15);
    CHECK(relative_error(t.shafts.speed[1], -100.0 / 3) < 1e-15);
    CHECK(relative_error(change, -5000.0 / 3) < 1e-15);
    CHECK(relative_error(work[g], -5000.0 / 3) < 1e-15);
    CHECK(t.graph.consistent(t.shafts));
    const Shafts before = t.shafts;
    CHECK(t.graph.engage(t.shafts) == 0);
    CHECK(t.shafts.speed == before.speed);
}

TEST_CASE("engagement books the work of each mesh of a train, and the sum is the change of energy")
{
    Train t;
    std::uint64_t seed = 5;
    for (int i = 0; i < 9; ++i) t.add_shaft(0.1 + next_uniform(seed), 20 * next_uniform(seed) - 10);
    for (std::uint32_t i = 1; i < 9; ++i) t.gear(i / 2, i, 0.3 + next_uniform(seed));
    t.build();
    double momentum = 0, before = 0, after = 0, after_momentum = 0, booked = 0;
    for (std::uint32_t i = 0; i < 9; ++i)
        momentum += t.shafts.ratio[i] * t.shafts.inertia[i] * t.shafts.speed[i], before += t.shafts.kinetic_energy(i);
    std::vector<double> work(8, 0.0);
    const double change = t.graph.engage(t.shafts, &work);
    for (std::uint32_t i = 0; i < 9; ++i)
        after_momentum += t.shafts.ratio[i] * t.shafts.inertia[i] * t.shafts.speed[i], after += t.shafts.kinetic_energy(i);
    for (const double w : work) booked += w;
    CHECK(relative_error(after_momentum, momentum) < 1e-13);
    CHECK(relative_error(change, after - before) < 1e-13);
    CHECK(relative_error(booked, change) < 1e-13);
}

TEST_CASE("F7: angles of 1000 gears are derived from the root's, so they cannot drift")
{
    Train t;
    std::uint64_t seed = 7;
    t.add_shaft(1);
    for (std::uint32_t i = 1; i < 1000; ++i)
    {
        t.add_shaft(1);
        t.gear(i - 1, i, (next_uniform(seed) < 0.5 ? -1 : 1) * std::exp((2 * next_uniform(seed) - 1) * std::log(3.0)));
    }
    t.build();
    const double dt = 1e-3;
    for (int step = 0; step < 100'000; ++step)
    {
        t.shafts.speed[0] += dt * std::sin(step * dt);
        t.shafts.angle[0] += dt * t.shafts.speed[0];
        if (step % 100 == 99) t.graph.derive(t.shafts);
    }
    double angles = 0, speeds = 0;
    for (std::uint32_t i = 0; i < 1000; ++i)
    {
        angles += std::fabs(t.shafts.angle[i] - t.shafts.ratio[i] * t.shafts.angle[0]);
        speeds += std::fabs(t.shafts.speed[i] - t.shafts.ratio[i] * t.shafts.speed[0]);
    }
    CHECK(angles == 0);
    CHECK(speeds == 0);
    CHECK(t.shafts.angle[0] > 50);  // it has turned
    CHECK(t.graph.consistent(t.shafts));
}

TEST_CASE("a prescribed shaft moves its whole train, and its couplings carry the torques for it")
{
    Train t;
    t.add_shaft(2, 5), t.add_shaft(3, -1), t.add_shaft(1, 4, Motion::Kinematic), t.add_shaft(1, 9);
    const auto g0 = t.gear(0, 1, exact_ratio(2, 1));
    const auto g1 = t.gear(1, 2, exact_ratio(1, 2));
    t.build();
    CHECK(t.graph.tree_of(0)->root == 2);
    CHECK(t.graph.tree_of(0)->prescribed);
    CHECK(t.graph.tree_of(3) == nullptr);
    std::vector<double> work(2, 0.0);
    const double before = t.shafts.kinetic_energy(0) + t.shafts.kinetic_energy(1);
    const double change = t.graph.engage(t.shafts, &work);
    CHECK(t.shafts.speed == std::vector<double>{4, 8, 4, 9});
    CHECK(relative_error(change, t.shafts.kinetic_energy(0) + t.shafts.kinetic_energy(1) - before) < 1e-15);
    CHECK(relative_error(work[g0] + work[g1], change) < 1e-15);

    const auto a = t.accelerations({7, 5, 100, 2});
    CHECK(a[0] == 0);
    CHECK(a[1] == 0);
    CHECK(a[3] == 2);
    CHECK(t.coupling.mobility(shaft(1)) == 0);
    t.react();
    CHECK(relative_error(t.torque(g0), 3.5) < 1e-15);   // on s1: it carries the 7 N m on s0, halved
    CHECK(relative_error(t.torque(g1), 17.0) < 1e-15);  // on the motor: 2 (5 + 3.5)
    std::vector<double> power(2, 0.0);
    t.coupling.account(power, 1.0);
    CHECK(relative_error(power[g1], -17.0 * 4) < 1e-15);  // removes all power of the two torques
    CHECK(power[g0] == 0);
}

TEST_CASE("rebuilding keeps ratios and anchors to the last bit; shafts that change are anchored at their present angle")
{
    Train t;
    for (int i = 0; i < 4; ++i) t.add_shaft(1, 0);
    t.shafts.angle = {0.1, 0.7, 123.456, 5};
    t.gear(0, 1, exact_ratio(1, 3)), t.gear(1, 2, -0.7);
    t.build();
    t.shafts.speed[0] = 3;
    for (int i = 0; i < 1000; ++i) t.shafts.angle[0] += 1e-3 * 3, t.graph.derive(t.shafts);
    const Shafts before = t.shafts;
    t.build();
    CHECK(t.shafts.root == before.root);
    CHECK(t.shafts.ratio == before.ratio);
    CHECK(t.shafts.anchor == before.anchor);
    CHECK(t.shafts.root_anchor == before.root_anchor);
    t.graph.derive(t.shafts);
    CHECK(t.shafts.angle == before.angle);

    t.gear(2, 3, 2.0);  // a new member leaves the others' anchors alone
    t.build();
    for (const std::uint32_t i : {0u, 1u, 2u}) CHECK(t.shafts.anchor[i] == before.anchor[i]);
    CHECK(t.shafts.anchor[3] == 5);
    CHECK(t.shafts.root_anchor[3] == t.shafts.angle[0]);

    t.shafts.angle[1] = 42;  // set by a request
    t.build();
    CHECK(t.shafts.anchor[1] == 42);
    CHECK(t.shafts.anchor[2] == before.anchor[2]);
    t.graph.derive(t.shafts);
    CHECK(t.shafts.angle[1] == 42);

    t.graph.clear();  // and separated again
    t.build();
    CHECK(t.shafts.root == std::vector<std::uint32_t>{0, 1, 2, 3});
    CHECK(t.shafts.anchor[1] == t.shafts.angle[1]);
    CHECK(t.graph.trees().empty());
}

TEST_CASE("only active trains are derived")
{
    Train t;
    for (int i = 0; i < 4; ++i) t.add_shaft(1);
    t.gear(0, 1, 2.0), t.gear(2, 3, 2.0);
    t.build();
    t.shafts.angle = {1, 0, 1, 0};
    t.graph.derive(t.shafts, std::vector<std::uint8_t>{0, 0, 1, 1});
    CHECK(t.shafts.angle == std::vector<double>{1, 0, 1, 2});
}

TEST_CASE("the result does not depend on rows: a train written in another order moves by the same bits")
{
    const std::vector<std::uint32_t> row = {3, 0, 4, 1, 2};  // of s0 .. s4
    const std::vector<double> inertia = {0.3, 1.7, 0.9, 2.3, 0.11}, torque = {0.1, -0.7, 1.3, 0.5, 3.1};
    std::vector<double> reference;
    for (const bool shuffled : {false, true})
    {
        Train t;
        t.shaft_rank.resize(5), t.members.clear();
        std::vector<double> by_row(5), torque_by_row(5);
        const auto at = [&](std::uint32_t i) { return shuffled ? row[i] : i; };
        for (std::uint32_t i = 0; i < 5; ++i) t.shaft_rank[at(i)] = i, by_row[at(i)] = inertia[i], torque_by_row[at(i)] = torque[i];
        for (const double j : by_row) t.add_shaft(j);
        t.members = {at(0), at(1), at(2), at(3), at(4)};
        t.component_rank = shuffled ? std::vector<std::uint32_t>{3, 2, 1, 0} : std::vector<std::uint32_t>{0, 1, 2, 3};
        for (std::uint32_t k = 0; k < 4; ++k)
        {
            const std::uint32_t e = shuffled ? 3 - k : k;
            t.gear(at(e / 2), at(e + 1), 0.37 + 0.21 * e);
        }
        t.build();
        const auto a = t.accelerations(torque_by_row);
        if (!shuffled)
            reference = a;
        else
            for (std::uint32_t i = 0; i < 5; ++i) CHECK(a[at(i)] == reference[i]);
    }
}
