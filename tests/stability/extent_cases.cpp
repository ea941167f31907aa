// Steps, sizes and positions far from the usual ones.
#include "case.h"
#include "pieces.h"
#include "trial.h"

namespace plab::stability
{

namespace
{

/// Springs such that the weight presses them in by 1e-4 of the body's radius.
std::string law(const ContactAlgorithm& algorithm, double mass, double g, double radius)
{
    if (!algorithm.spring()) return attribute("response.friction", 0.5);
    const double depth = 1e-4 * radius, power = algorithm.response == "Penalty" ? 1 : 1.5;
    return attribute("response.friction", 0.5) + attribute("response.stiffness", mass * g / std::pow(depth, power)) +
           attribute("response.restitution", 0.2) + attribute("response.steps_per_contact", 20);
}

/// A box dropped from half its height at `at`; everything scaled to `size`, time with it. Returns its final distance from rest, in
/// units of `size`.
double drop(Trial& t, double size, double until)
{
    t.run(until);
    return t.loaded() ? std::fabs(t.vec("box", "position").z / (0.5 * size) - 1) : 0;
}

Case sizes()
{
    const std::vector<double> extents{1e-6, 1e-3, 1, 1e3, 1e6};
    Case c{"size",
           "Sizes from a micrometre to a thousand kilometres",
           "A cube of the given size and a density of 1000 kg/m^3 falls from half its height on the floor, g = 9.81 m/s^2. "
           "4 s at 1/60 s, both multiplied by sqrt(size / m). "
           "Error: distance from its rest at the end, relative to half its size. "
           "Stable to 1e-3, bounded to 1.",
           "contact",
           "size, m",
           names_of(contact_algorithms()),
           brief(extents),
           {},
           {}};
    c.run = [extents](std::size_t r, std::size_t v)
    {
        const ContactAlgorithm& algorithm = contact_algorithms()[r];
        const double size = extents[v], mass = 1000 * size * size * size, time = std::sqrt(size);
        Trial t(ground() + gravity() + box("box", Vec3{0.5, 0.5, 0.5} * size, mass, {0, 0, size}) +
                    contact(algorithm, law(algorithm, mass, kG, size / 2)),
                dt(time / 60));
        const double error = drop(t, size, 4 * time);
        return t.judge(error, {1e-3, 1});
    };
    c.quick = [](std::size_t r, std::size_t v) { return r >= 2 && v != 2; };
    return c;
}

Case places()
{
    const std::vector<double> away{0, 1e3, 1e5, 1e7};
    Case c{"place",
           "Far from the origin",
           "A cube of 1 m falls from half its height on the floor, at the given distance in x and y; 3 s at 1/60 s. "
           "Error: distance from its rest, relative to half its size, or how far it has moved sideways, m. "
           "Stable to 1e-3, bounded to 1.",
           "contact",
           "distance, m",
           names_of(contact_algorithms()),
           brief(away),
           {},
           {}};
    c.run = [away](std::size_t r, std::size_t v)
    {
        const ContactAlgorithm& algorithm = contact_algorithms()[r];
        const Vec3 at{away[v], -away[v], 1};
        Trial t(ground() + gravity() + box("box", {0.5, 0.5, 0.5}, 1000, at) + contact(algorithm, law(algorithm, 1000, kG, 0.5)),
                dt(1.0 / 60));
        const double error = drop(t, 1, 3);
        if (!t.loaded()) return t.judge(0, {});
        const Vec3 p = t.vec("box", "position");
        return t.judge(std::fmax(error, std::hypot(p.x - at.x, p.y - at.y)), {1e-3, 1});
    };
    c.quick = [](std::size_t r, std::size_t v) { return r >= 2 && v == 3; };
    return c;
}

const std::vector<double> kSteps{1e-6, 1e-4, 1e-3, 1.0 / 60, 0.1};
constexpr double kMostSteps = 10000;

/// 1 s, or as far as the most steps reach.
double span(double step) { return std::fmin(1.0, kMostSteps * step); }

Case motion_steps()
{
    const auto solvers = algorithms_of("Solver");
    Case c{"step",
           "Steps from a microsecond to a tenth of a second",
           "1 kg on a spring of 100 N/m that is stretched by 0.1 m at the start and rotates with 3 rad/s; 1 s, at most 10000 steps. "
           "Error: distance from the closed form at the end, relative to the amplitude. "
           "Stable to 1e-3, bounded to 3.",
           "solver",
           "step, s",
           solvers,
           brief(kSteps),
           {},
           {}};
    c.run = [solvers](std::size_t r, std::size_t v)
    {
        Trial t(body("mass", 1, {1, 1, 1}, {1.1, 0, 0}, attribute("angular_velocity", Vec3{3, 0, 0})) +
                    component("spring", "Constraint/SpringDamper",
                              attribute("b", "mass") + attribute("anchor_a", Vec3{}) + attribute("anchor_b", Vec3{}) +
                                  attribute("length", 1) + attribute("stiffness", 100)),
                dt(kSteps[v]) + attribute("solver", "Solver/" + solvers[r]));
        t.run(span(kSteps[v]));
        if (!t.loaded()) return t.judge(0, {});
        return t.judge(std::fabs(t.vec("mass", "position").x - 1 - 0.1 * std::cos(10 * t.simulation().time())) / 0.1, {1e-3, 3});
    };
    c.quick = [](std::size_t, std::size_t v) { return v == 4; };
    return c;
}

Case contact_steps()
{
    Case c{"step_contact",
           "The same steps with contacts",
           "A cube of 1 m rests on the floor, and a ball of 0.5 m radius falls on it from 0.1 m; 1 s, at most 10000 steps. "
           "Error: how far the cube has sunk or moved, m; if there was time to land, also the distance of the ball from its position on "
           "the cube, m. "
           "Stable to 1e-3, bounded to 0.5.",
           "contact",
           "step, s",
           names_of(contact_algorithms()),
           brief(kSteps),
           {},
           {}};
    c.run = [](std::size_t r, std::size_t v)
    {
        const ContactAlgorithm& algorithm = contact_algorithms()[r];
        Trial t(ground() + gravity() + box("box", {0.5, 0.5, 0.5}, 1000, {0, 0, 0.5}) + ball("ball", 0.5, 500, {0, 0, 1.6}) +
                    contact(algorithm, law(algorithm, 1500, kG, 0.5)),
                dt(kSteps[v]));
        t.run(span(kSteps[v]));
        if (!t.loaded()) return t.judge(0, {});
        const double cube = length(t.vec("box", "position") - Vec3{0, 0, 0.5});
        const double high = t.vec("ball", "position").z - 1.5, fallen = 0.1 - 0.5 * kG * std::pow(t.simulation().time(), 2);
        return t.judge(std::fmax(cube, std::fabs(high - std::fmax(0.0, fallen))), {1e-3, 0.5});
    };
    c.quick = [](std::size_t r, std::size_t v) { return r >= 2 && v == 4; };
    return c;
}

}  // namespace

std::vector<Case> extent_cases() { return {motion_steps(), contact_steps(), sizes(), places()}; }

}  // namespace plab::stability
