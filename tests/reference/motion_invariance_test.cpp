// A11 and A13. A11: two tumbling bodies on a spring, translated by 1e7 m, boosted by 1e3 m/s, rotated: the same relative motion.
// A13: bodies that drag brings to rest, by e^-1500: zeros at the end, never denormal numbers, whose arithmetic takes a hundred
// times as long.
//
// A11, after 2 s       translated 1e7 m   boosted 1e3 m/s   turned
//   explicit, Automatic  1e-7 m           8e-12 m           3e-14 m
//   ImplicitMidpoint     3e-7 m           8e-12 m           6e-13 m   (its iteration ends in the rounding of positions)
//   DormandPrince54      1e-7 m           2e-11 m           4e-12 m   (its tolerance)
//   Radau5               1e-7 m           4e-9 m            2e-10 m   (its tolerance)
//   Exponential          1e-4 m           9e-12 m           2e-13 m   (derivatives are differences of rounded positions)
//
// Positions are rounded to 1.9e-9 m at 1e7 m, to 2e-13 m at the distance that 1e3 m/s reach in 2 s, to 2e-16 m at the origin. In
// 480 steps that adds up like a random walk, sqrt(480) times half of it for each body and component, and the spring doubles it:
// 5e-8, 5e-12, 5e-15 m.
#include <limits>

#include "reference/motion.h"
#include "support/text.h"

using namespace plab;
using namespace plab::test;

namespace
{

struct Frame
{
    Vec3 shift, boost;
    Quat turn;
};

std::string body(const std::string& id, const Frame& f, const Vec3& place, const Vec3& speed, const Vec3& spin)
{
    return "<component id=\"" + id + "\" type=\"State/RigidBody\" mass=\"1\" inertia=\"0.2 0.3 0.4\" position=\"" +
           text(f.shift + rotate(f.turn, place)) + "\" orientation=\"" + text(f.turn) + "\" linear_velocity=\"" +
           text(f.boost + rotate(f.turn, speed)) + "\" angular_velocity=\"" + text(rotate(f.turn, spin)) + "\"/>";
}

struct Relative
{
    Vec3 place;
    Quat attitude;
};

/// State of b, in the frame of the scene, after 2 s.
Relative pair(const SolverAlgorithm& algorithm, const Frame& f)
{
    Scene s(solver(algorithm) + body("a", f, {}, {0, 0.1, 0}, {0.5, 1, 2}) + body("b", f, {1, 0, 0}, {0, -0.3, 0.2}, {2, 0.1, -1}) +
                "<component id=\"spring\" type=\"Constraint/SpringDamper\" a=\"a\" b=\"b\" anchor_a=\"0.1 0 0\" anchor_b=\"-0.2 0.1 0\""
                " stiffness=\"50\" damping=\"0.5\" length=\"0.8\"/>",
            per_second(240));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(2);
    const Quat back = conjugate(f.turn);
    return {rotate(back, s.vec("b", "position") - s.vec("a", "position")), back * s.quat("b", "orientation")};
}

}  // namespace

TEST_CASE("A11: the same relative motion at any place, at any speed and in any orientation")
{
    const Quat turn = normalized(Quat{0.3, -0.5, 0.7, 0.4});
    struct Row
    {
        SolverAlgorithm algorithm;
        double far, fast, turned;
    };
    const Row table[] = {
        {{"SemiImplicitEuler"}, 1e-7, 8e-12, 3e-14}, {{"StoermerVerlet"}, 1e-7, 8e-12, 3e-14}, {{"RungeKutta4"}, 1e-7, 8e-12, 3e-14},
        {{"RotationSplitting"}, 1e-7, 8e-12, 3e-14}, {{"Automatic"}, 1e-7, 8e-12, 3e-14},      {{"ImplicitMidpoint"}, 3e-7, 8e-12, 6e-13},
        {{"DormandPrince54"}, 1e-7, 2e-11, 4e-12},   {{"Radau5"}, 1e-7, 4e-9, 2e-10},          {{"Exponential"}, 1e-4, 9e-12, 2.5e-13}};
    for (const Row& row : table)
    {
        const SolverAlgorithm& algorithm = row.algorithm;
        CAPTURE(algorithm.type);
        const Relative here = pair(algorithm, {});
        const auto apart = [&](const Frame& f)
        {
            const Relative there = pair(algorithm, f);
            return std::fmax(distance(here.place, there.place), attitude_error(here.attitude, there.attitude));
        };
        const double far = apart({{1e7, -1e7, 1e7}, {}, {}}), fast = apart({{}, {1e3, 0, -1e3}, {}}), turned = apart({{}, {}, turn});
        MESSAGE(algorithm.type << ": " << far << " " << fast << " " << turned);
        CHECK(far < row.far);
        CHECK(fast < row.fast);
        CHECK(turned < row.turned);
    }
}

TEST_CASE("A13: motion decays as e^-5t and ends in zeros before numbers become denormal, and steps take no longer")
{
    for (const SolverAlgorithm& algorithm :
         {SolverAlgorithm{"RungeKutta4"}, SolverAlgorithm{"Automatic"}, SolverAlgorithm{"StoermerVerlet"}})
    {
        CAPTURE(algorithm.type);
        Scene s(solver(algorithm) + braked(20), per_second(50));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.step(2);  // Automatic examines the first one twice
        const auto evaluations = s.simulation().stepper().report().evaluations;
        s.run(10);
        const double z = -0.1, second = 1 + z + z * z / 2, fourth = second + z * z * z / 6 + z * z * z * z / 24;
        const double factor = algorithm.type == "StoermerVerlet" ? second : fourth;  // of each of 500 steps; e^-50 to 9 % and to 4e-5
        CHECK(s.vec("b7", "linear_velocity").x / std::pow(factor, 500) == doctest::Approx(1).epsilon(1e-9));
        while (s.simulation().time() < 300)
        {
            s.step();
            const Vec3 v = s.vec("b7", "linear_velocity"), w = s.vec("b7", "angular_velocity");
            for (const double number : {v.x, v.y, v.z, w.x, w.y, w.z})
                REQUIRE((number == 0 || std::fabs(number) > std::numeric_limits<double>::min()));
        }
        CHECK(s.vec("b7", "linear_velocity") == Vec3{});
        CHECK(s.simulation().stepper().report().evaluations == evaluations);
    }
}
