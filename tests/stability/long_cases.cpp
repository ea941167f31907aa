// Many steps: errors that accumulate slowly.
#include "case.h"
#include "pieces.h"
#include "trial.h"

namespace plab::stability
{

namespace
{

constexpr double kLongStep = 1.0 / 240;
constexpr std::uint64_t kNoLimit = 1'000'000'000;  // of evaluations: time is the limit here
const std::vector<double> kCounts{1e4, 1e6, 1e7};

/// Solvers whose step costs about a microsecond; 1e7 steps of the others would take too long.
std::vector<std::string> quick_solvers() { return {"Exact", "RotationSplitting", "RungeKutta4", "SemiImplicitEuler", "StoermerVerlet"}; }

Case oscillator()
{
    const auto solvers = quick_solvers();
    Case c{"long_spring",
           "An oscillator for ten million steps",
           "1 kg on a spring of 100 N/m that is stretched by 0.1 m at the start, steps of 1/240 s. "
           "Error: of the energy at the end, relative. The phase is lost sooner, depending on the order of the method. "
           "Stable to 1e-2, bounded to 1.",
           "solver",
           "steps",
           solvers,
           brief(kCounts),
           {},
           {}};
    c.run = [solvers](std::size_t r, std::size_t v)
    {
        Trial t(body("mass", 1, {1, 1, 1}, {1.1, 0, 0}) +
                    component("spring", "Constraint/SpringDamper",
                              attribute("b", std::string("mass")) + attribute("anchor_a", Vec3{}) + attribute("anchor_b", Vec3{}) +
                                  attribute("length", 1) + attribute("stiffness", 100)),
                dt(kLongStep) + attribute("solver", "Solver/" + solvers[r]), kNoLimit);
        t.run(kCounts[v] * kLongStep);
        if (!t.loaded()) return t.judge(0, {});
        const double x = t.vec("mass", "position").x - 1, speed = t.vec("mass", "linear_velocity").x;
        return t.judge(std::fabs((100 * x * x + speed * speed) / 1.0 - 1), {1e-2, 1});
    };
    c.cpu_seconds = 200;
    c.quick = [](std::size_t, std::size_t v) { return v == 0; };
    return c;
}

Case free_body()
{
    const auto solvers = quick_solvers();
    Case c{"long_body",
           "A free body for ten million steps",
           "Inertia 1, 2, 2.5 kg m^2, spin 1, 2, 3 rad/s, steps of 1/240 s. "
           "Error: of energy and angular momentum at the end, relative. "
           "Stable to 1e-2, bounded to 3.",
           "solver",
           "steps",
           solvers,
           brief(kCounts),
           {},
           {}};
    c.run = [solvers](std::size_t r, std::size_t v)
    {
        Trial t(body("top", 1, {1, 2, 2.5}, {}, attribute("angular_velocity", Vec3{1, 2, 3})),
                dt(kLongStep) + attribute("solver", "Solver/" + solvers[r]), kNoLimit);
        const auto start = t.loaded() ? t.simulation().totals() : simulation::Totals{};
        t.run(kCounts[v] * kLongStep);
        if (!t.loaded()) return t.judge(0, {});
        const auto end = t.simulation().totals();
        return t.judge(std::fmax(std::fabs(end.kinetic / start.kinetic - 1),
                                 length(end.angular_momentum - start.angular_momentum) / length(start.angular_momentum)),
                       {1e-2, 3});
    };
    c.cpu_seconds = 200;
    c.quick = [](std::size_t, std::size_t v) { return v == 0; };
    return c;
}

Case pendulum()
{
    // With joints Exact is RungeKutta4, and RotationSplitting takes 30 us per step.
    const std::vector<std::string> solvers{"RungeKutta4", "SemiImplicitEuler", "StoermerVerlet"};
    Case c{"long_pendulum",
           "A jointed body for ten million steps",
           "A ball of 1 kg on a ball joint 0.5 m above it, released at 0.5 rad, steps of 1/240 s. "
           "Error: of the energy at the end, relative to that of the swing, or the joint's gap, m. "
           "Stable to 1e-2, bounded to 1.",
           "solver",
           "steps",
           solvers,
           brief(kCounts),
           {},
           {}};
    c.run = [solvers](std::size_t r, std::size_t v)
    {
        constexpr double kLength = 0.5, kTilt = 0.5;  // m, rad
        const Vec3 start{kLength * std::sin(kTilt), 0, -kLength * std::cos(kTilt)};
        Trial t(body("bob", 1, {0.01, 0.01, 0.01}, start) + gravity() +
                    component("joint", "Constraint/Ball", attribute("b", std::string("bob")) + attribute("anchor", Vec3{})),
                dt(kLongStep) + attribute("solver", "Solver/" + solvers[r]), kNoLimit);
        t.run(kCounts[v] * kLongStep);
        if (!t.loaded()) return t.judge(0, {});
        const double swing = kG * kLength * (1 - std::cos(kTilt));
        const double height = t.vec("bob", "position").z - start.z;
        const double gap = std::fabs(length(t.vec("bob", "position")) - kLength);
        return t.judge(std::fmax(std::fabs(t.simulation().totals().kinetic + kG * height) / swing, gap), {1e-2, 1});
    };
    c.cpu_seconds = 300;
    c.quick = [](std::size_t, std::size_t v) { return v == 0; };
    return c;
}

/// Algorithms that hold resting bodies at a cost of some microseconds; springs take thousands of pieces for a step.
std::vector<ContactAlgorithm> quick_contacts()
{
    std::vector<ContactAlgorithm> out;
    for (const ContactAlgorithm& algorithm : contact_algorithms())
        if (!algorithm.spring()) out.push_back(algorithm);
    return out;
}

Case resting_cube()
{
    const auto algorithms = quick_contacts();
    Case c{"long_rest",
           "A cube on a slope for ten million steps",
           "A cube of 1 m and 1 kg stands on a slope of 15 degrees with friction 0.5, steps of 1/240 s: eleven and a half hours. "
           "Error: the displacement of its centre, m. "
           "Stable to 1e-6, bounded to 0.1.",
           "contact",
           "steps",
           names_of(algorithms),
           brief(kCounts),
           {},
           {}};
    c.run = [algorithms](std::size_t r, std::size_t v)
    {
        const double slope = 15 * std::acos(-1.0) / 180;
        const Vec3 weight{kG * std::sin(slope), 0, -kG * std::cos(slope)};
        Trial t(ground() + box("cube", {0.5, 0.5, 0.5}, 1, {0, 0, 0.5}) +
                    component("weight", "Field/Gravity", attribute("between", std::string("*")) + attribute("acceleration", weight)) +
                    contact(algorithms[r], attribute("response.friction", 0.5)),
                dt(kLongStep), kNoLimit);
        t.run(kCounts[v] * kLongStep);
        if (!t.loaded()) return t.judge(0, {});
        return t.judge(length(t.vec("cube", "position") - Vec3{0, 0, 0.5}), {1e-6, 0.1});
    };
    c.cpu_seconds = 300;
    c.quick = [](std::size_t, std::size_t v) { return v == 0; };
    return c;
}

}  // namespace

std::vector<Case> long_cases() { return {oscillator(), free_body(), pendulum(), resting_cube()}; }

}  // namespace plab::stability
