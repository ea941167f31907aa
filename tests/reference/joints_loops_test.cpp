// Closed loops of joints: singular, redundant and contradictory ones (catalogue: E2, E3, E4, E8).
#include <algorithm>
#include <array>
#include <numbers>

#include "plab/random.h"
#include "support/joints.h"
#include "support/linkages.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("E2: two four-bars pass their singular configuration on the right branch")
{
    Scene s(four_bars(2), dt(2000));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(10);
    const Vec3 at10 = top_of(s);
    MESSAGE("N=2 t=10: ", at10.x - .328458111540815379, " ", at10.z - .944518538178600962);
    CHECK(std::fabs(at10.x - .328458111540815379) < 1e-8);
    CHECK(std::fabs(at10.z - .944518538178600962) < 1e-8);
    for (int i = 0; i < 2; ++i) CHECK(s.real("r" + number(i), "position_error") < 1e-12);
}

TEST_CASE("E2: a stage of a step close to the singular configuration costs no accuracy")
{
    // At t = 3.16 s a stage is 1e-4 rad away from it. If rows were released there, the energy would be wrong by 6e-10, and the
    // position here by 3e-9 m.
    Scene s(four_bars(5), dt(1000));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(4);
    const double error = distance(top_of(s), {0.0883942813348324205, 0, 0.996085564109478748});
    MESSAGE("N=5 t=4: ", error);
    CHECK(error < 1e-10);
}

TEST_CASE("E4: a four-bar follows Freudenstein's equation")
{
    Scene s(FourBar::scene(solver_is("RungeKutta4")), dt(240));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    double worst = 0;
    for (int i = 1; i <= 3 * 240; ++i)
    {
        s.step();
        worst = std::fmax(worst, FourBar::error(s));
    }
    MESSAGE("worst place of the rocker's end: ", worst);
    CHECK(worst < 1e-9);
    CHECK(near(s.real("j1", "angle"), 6 * std::numbers::pi, 1e-9));
    // The loop is planar: three of its rows are redundant.
    double redundant = 0;
    for (const char* j : {"j1", "j2", "j3", "j4", "m"}) redundant += static_cast<double>(std::get<std::int64_t>(s.get(j, "redundant")));
    CHECK(redundant == 3);
}

TEST_CASE("E8: pins too far apart share the error and report it")
{
    Scene s(torn_rod(solver_is("RungeKutta4")), dt(240));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = s.keep_events = true;
    s.run(5);
    CHECK(near(s.real("left", "position_error"), .1, 1e-6));
    CHECK(near(s.real("right", "position_error"), .1, 1e-6));
    CHECK(length(s.vec("rod", "position")) < 1e-6);
    CHECK(length(s.vec("rod", "linear_velocity")) < 1e-6);
    CHECK(s.count("constraint.contradiction") == 2);
    for (const Event& e : s.events)
    {
        const bool left = e.component == s.simulation().world().find("left");
        CHECK(e.message.find(left ? "right" : "left") != std::string::npos);
    }
}

TEST_CASE("E3: Bricard's linkage moves although it has as many rows as degrees of freedom")
{
    const BricardRun coarse = run_bricard(500, 3), fine = run_bricard(1000, 3);
    MESSAGE("drift of energy ", coarse.drift, " ", fine.drift, " of ", fine.kinetic, " J");
    CHECK(fine.kinetic > 4);
    CHECK(fine.drift < 1e-6 * fine.kinetic);
    CHECK(fine.error < 1e-13);
    CHECK(fine.redundant == 1);  // 30 rows, 30 degrees of freedom, and it moves
}

TEST_CASE("E3: Bricard's linkage keeps the solver's order")
{
    // With coarser steps the order is not visible yet, least of all in the largest drift of energy.
    const auto rod_at = [](int per_second)
    {
        Scene s(bricard(), dt(per_second));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(.5);
        return s.vec("rod102", "position");
    };
    const Vec3 coarse = rod_at(500), middle = rod_at(1000), fine = rod_at(2000);
    const double order = std::log2(distance(coarse, middle) / distance(middle, fine));
    MESSAGE("order ", order);
    CHECK(order > 3.8);
    CHECK(order < 4.3);
}

namespace
{

/// A chain of joints in which all centres of mass and all joint points are at the origin. `chance` changes.
std::string centred_chain(std::uint64_t& chance)
{
    const auto draw = [&](double size) { return (2 * next_uniform(chance) - 1) * size; };
    const auto vector = [&](double size)
    {
        const double x = draw(size), y = draw(size), z = draw(size);
        return Vec3{x, y, z};
    };
    const std::array<std::string, 5> solvers{"RungeKutta4", "SemiImplicitEuler", "RotationSplitting", "Automatic", "Radau5"};
    const std::array<std::string, 4> joints{"Ball", "Hinge", "Fixed", "Slider"};
    std::string out = solver_is(solvers[next_random(chance) % solvers.size()]) + gravity(text(vector(10)));
    const std::size_t bodies = 1 + next_random(chance) % 3;
    for (std::size_t i = 0; i < bodies; ++i)
    {
        const Vec3 axis = vector(1), spin = vector(next_random(chance) % 2 == 0 ? 5 : 0);
        const std::string& type = joints[next_random(chance) % joints.size()];
        out += body("b" + number(static_cast<int>(i)), 1, {.1, .2, .25}, {},
                    "orientation='axis " + text(axis) + " 0.7' angular_velocity='" + text(spin) + "'");
        out += joint("j" + number(static_cast<int>(i)), type, i == 0 ? "" : "b" + number(static_cast<int>(i) - 1),
                     "b" + number(static_cast<int>(i)),
                     "anchor='0 0 0'" + (type == "Hinge" || type == "Slider" ? " axis='" + text(vector(1)) + "'" : std::string()));
    }
    return out;
}

}  // namespace

TEST_CASE("joints of bodies centred at the origin do not contradict one another: rounding is not reported as an error")
{
    // Of 60 chains, 5 used to report a remaining 1e-16 m/s or less. Compared with speeds of the size of rounding that is much;
    // compared with the motion of the bodies it is nothing. A speed that does contradict a joint is still found (E8, and
    // contradictory gears).
    std::uint64_t chance = 7;
    for (int i = 0; i < 120; ++i)
    {
        CAPTURE(i);
        Scene s(centred_chain(chance), dt(240));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = s.keep_events = true;
        s.step(60);
        CHECK(s.count("constraint.contradiction") == 0);
    }
}
