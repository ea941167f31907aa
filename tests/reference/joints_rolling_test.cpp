// Rolling without slipping (catalogue: C20), against 113-bit integration of Euler's equations about the contact point in two
// unknown vectors, normal and spin: Gragg-Bulirsch-Stoer of order 20, steps of 10/3000 and 10/6000 s agree to 11 digits or better.
#include <numbers>

#include "support/gravity.h"
#include "support/joints.h"

using namespace plab;
using namespace plab::test;

namespace
{

std::string rolling(const std::string& id, const std::string& b, const std::string& semi_axes, const std::string& more = "")
{
    return "<component id='" + id + "' type='Constraint/Rolling' b='" + b + "' semi_axes='" + semi_axes + "' " + more + "/>";
}

/// C20. The centre of mass is 0.01 below the ellipsoid's; half a degree out of the upright about x.
std::string rattleback(const std::string& solver, double spin)
{
    const double half = std::numbers::pi / 720;
    // Up is (0, sin 0.5 deg, cos 0.5 deg) in the body: it is turned about x.
    const Quat q{std::cos(half), std::sin(half), 0, 0};
    // Its lowest point against the centre of mass, in the body: rolling needs the speed that goes with the spin.
    const Vec3 up = rotate_back(q, {0, 0, 1}), g{.04 * up.x, .0009 * up.y, .0004 * up.z};
    const Vec3 r = rotate(q, Vec3{0, 0, .01} - g / std::sqrt(dot(up, g))), w = rotate(q, {0, 0, spin});
    return solver + gravity() +
           body("stone", "1", "2e-4 1.6e-3 1.7e-3 -2e-5 0 0", "0 0 0",
                "orientation='" + text(q.w) + " " + text(q.x) + " 0 0' angular_velocity='" + text(w) + "' linear_velocity='" +
                    text(cross(r, w)) + "'") +
           rolling("rolls", "stone", "0.2 0.03 0.02", "centre='0 0 0.01'");
}

struct Stone
{
    double spin = 0, drift = 0, slip = 0, energy = 0;
};
Stone rock(const std::string& solver, int per_second, double spin, double t)
{
    Scene s(rattleback(solver, spin), dt(per_second));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const auto energy = [&]
    {
        const Bodies& bodies = s.simulation().world().host().bodies;
        return bodies.kinetic_energy(0) + kG * bodies.position[0].z;
    };
    Stone out;
    s.step();
    const double start = energy();
    while (s.simulation().time() < t - 1e-9)
    {
        s.step();
        out.drift = std::fmax(out.drift, s.real("rolls", "position_error"));
        out.slip = std::fmax(out.slip, s.real("rolls", "speed_error"));
        out.energy = std::fmax(out.energy, std::fabs(energy() - start));
    }
    out.spin = s.vec("stone", "angular_velocity").z;
    return out;
}

}  // namespace

TEST_CASE("C20: a rattleback reverses its spin, in one direction only")
{
    // It pitches at 107 rad/s, and initial errors grow a thousandfold until it reverses: error control.
    const std::string solver =
        "<component id='solver' type='Solver/DormandPrince54' relative_tolerance='1e-12' absolute_tolerance='1e-15'/>";
    for (const auto& [t, spin] : {std::pair{1, -4.973786074188076}, {3, -1.744817329018057}, {5, 1.809295913463068}})
    {
        CAPTURE(t);
        CHECK(std::fabs(rock(solver, 200, -5, t).spin - spin) < 1e-9);
    }
    const Stone back = rock(solver, 200, -5, 10), other = rock(solver, 200, 5, 10);
    MESSAGE("errors ", back.spin - 4.997530506514248, " ", other.spin - 4.881248546071108, ", drift ", back.drift, " ", back.slip,
            ", energy ", back.energy);
    CHECK(std::fabs(back.spin - 4.997530506514248) < 1e-9);
    CHECK(std::fabs(other.spin - 4.881248546071108) < 1e-10);
    CHECK(back.drift < 1e-15);
    CHECK(back.slip < 1e-14);
    CHECK(back.energy < 1e-12);
}

TEST_CASE("C20: solvers keep their order while rolling")
{
    // Compared with the finest run, in the early phase of the pitching.
    const auto spin_at = [](const std::string& solver, int per_second)
    {
        Scene s(rattleback(solver_is(solver), -5), dt(per_second));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(.1);
        return s.vec("stone", "angular_velocity");
    };
    const Vec3 exact = spin_at("RungeKutta4", 16000);
    for (const auto& [solver, order] :
         {std::pair{std::string("SemiImplicitEuler"), 1}, {"StoermerVerlet", 2}, {"ImplicitMidpoint", 2}, {"RungeKutta4", 4}})
    {
        const int n = order == 1 ? 8000 : 1000;
        const double p = std::log2(distance(spin_at(solver, n), exact) / distance(spin_at(solver, 2 * n), exact));
        MESSAGE(solver, " has order ", p);
        CHECK(std::fabs(p - order) < .2);
    }
}

TEST_CASE("C20: the spin after a second, with every solver")
{
    // rad/s at 2000 steps per second, about twice the achieved error; observed order from there to 4000. Contacts are not
    // involved: rolling is a joint, and there is no ellipsoid shape to collide with.
    struct SolverRow
    {
        std::string type, attributes;
        double most, order;
    };
    for (const SolverRow& row : {SolverRow{"SemiImplicitEuler", "", 0.06, 1},
                                 {"StoermerVerlet", "", 8e-4, 2},
                                 {"ImplicitMidpoint", "", 2e-3, 2},
                                 {"RotationSplitting", "order='2'", 9.5e-4, 2},
                                 {"RotationSplitting", "", 1.5e-9, 4},
                                 {"RungeKutta4", "", 6e-7, 4},
                                 {"Exact", "", 6e-7, 4},
                                 {"Automatic", "", 6e-7, 4},
                                 {"Exponential", "", 4.8e-8, 4},
                                 {"DormandPrince54", "", 1.9e-9, 0},
                                 {"Radau5", "", 3e-8, 0}})
    {
        CAPTURE(row.type);
        CAPTURE(row.attributes);
        const std::string solver = "<component id='solver' type='Solver/" + row.type + "' " + row.attributes + "/>";
        const double coarse = std::fabs(rock(solver, 2000, -5, 1).spin + 4.973786074188076);
        CHECK(coarse < row.most);
        if (row.order == 0) continue;
        const double fine = std::fabs(rock(solver, 4000, -5, 1).spin + 4.973786074188076);
        CHECK(std::fabs(std::log2(coarse / fine) - row.order) < .15);
    }
}

TEST_CASE("a ball rolls down an incline with 5/7 g sin a, whatever its solver")
{
    const double a = std::numbers::pi / 6, r = .1;
    const Vec3 n{std::sin(a), 0, std::cos(a)}, down{std::cos(a), 0, -std::sin(a)};
    for (const std::string solver : {"RungeKutta4", "ImplicitMidpoint", "DormandPrince54"})
    {
        CAPTURE(solver);
        Scene s(solver_is(solver) + gravity() + body("ball", "2", "0.008 0.008 0.008", text(r * n)) +
                    rolling("rolls", "ball", "0.1 0.1 0.1", "normal='" + text(n) + "' point='0 0 0'"),
                dt(100));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(2);
        const double method = .5 * 5. / 7 * kG * std::sin(a) * 4;
        CHECK(distance(s.vec("ball", "position"), r * n + method * down) < 1e-12);
        CHECK(near(s.real("rolls", "normal_force"), 2 * kG * std::cos(a), 1e-13));
        // Friction takes 2/7 of the weight component along the slope.
        CHECK(near(-dot(s.vec("rolls", "force"), down), 2 * kG * std::sin(a) * 2 / 7, 1e-13));
    }
}

TEST_CASE("a ball on a turntable moves in circles, at 2/7 of the table's angular velocity")
{
    // v' = 2/7 W x v: the table is kinematic, 3 rad/s.
    const double w = 2. / 7 * 3;
    const Vec3 at{.5, 0, .1}, v{.2, .3, 0};
    // Rolling requires v + s x r = W x p, r = (0, 0, -0.1).
    const Vec3 missing = Vec3{0, 3 * .5, 0} - v;
    const Vec3 spin{missing.y / .1, -missing.x / .1, 0};
    Scene s(
        solver_is("RungeKutta4") + gravity() + "<component id='table' type='State/Kinematic' angular_velocity='0 0 3'/>" +
            body("ball", "1", "0.004 0.004 0.004", text(at), "linear_velocity='" + text(v) + "' angular_velocity='" + text(spin) + "'") +
            rolling("rolls", "ball", "0.1 0.1 0.1", "a='table' point='0 0 0'"),
        dt(500));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(2);
    const double c = std::cos(w * 2), sn = std::sin(w * 2);
    const Vec3 moved{(v.x * sn - v.y * (1 - c)) / w, (v.x * (1 - c) + v.y * sn) / w, 0};
    CHECK(distance(s.vec("ball", "position"), at + moved) < 1e-9);
    CHECK(s.real("rolls", "speed_error") < 1e-14);
}
