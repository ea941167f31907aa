// Many steps: what creeps in.
#include "case.h"
#include "pieces.h"
#include "trial.h"

namespace plab::stability
{

namespace
{

constexpr double kStep = 1.0 / 240;
constexpr std::uint64_t kNoLimit = 1'000'000'000;  // of evaluations: time is the limit here
const std::vector<double> kCounts{1e4, 1e6, 1e7};

/// Those whose step costs about a microsecond; what the others do in 1e7 steps nobody waits for.
std::vector<std::string> quick_solvers() { return {"Exact", "RotationSplitting", "RungeKutta4", "SemiImplicitEuler", "StoermerVerlet"}; }

Case oscillator()
{
    const auto solvers = quick_solvers();
    Case c{"long_spring",
           "An oscillator for ten million steps",
           "1 kg on a spring of 100 N/m, pulled by 0.1 m, steps of 1/240 s. Error: of the energy at the end, relative (a phase is lost "
           "sooner, by the method's "
           "order). Stable to 1e-2, bounded to 1.",
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
                dt(kStep) + attribute("solver", "Solver/" + solvers[r]), kNoLimit);
        t.run(kCounts[v] * kStep);
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
           "Inertia 1, 2, 2.5 kg m^2, spin 1, 2, 3 rad/s, steps of 1/240 s. Error: of energy and angular momentum at the end, relative. "
           "Stable to 1e-2, "
           "bounded to 3.",
           "solver",
           "steps",
           solvers,
           brief(kCounts),
           {},
           {}};
    c.run = [solvers](std::size_t r, std::size_t v)
    {
        Trial t(body("top", 1, {1, 2, 2.5}, {}, attribute("angular_velocity", Vec3{1, 2, 3})),
                dt(kStep) + attribute("solver", "Solver/" + solvers[r]), kNoLimit);
        const auto start = t.loaded() ? t.simulation().totals() : simulation::Totals{};
        t.run(kCounts[v] * kStep);
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

}  // namespace

std::vector<Case> long_cases() { return {oscillator(), free_body()}; }

}  // namespace plab::stability
