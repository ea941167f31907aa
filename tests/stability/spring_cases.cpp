// Stiffness: springs, dampers, spring contacts and drag, from soft to far beyond what a step resolves.
#include "case.h"
#include "pieces.h"
#include "trial.h"

namespace plab::stability
{

namespace
{

constexpr double kStep = 1.0 / 60;
const std::vector<double> kStiffness{1e2, 1e4, 1e6, 1e8, 1e10, 1e12};

std::string settings(const std::string& solver) { return dt(kStep) + attribute("solver", "Solver/" + solver); }

/// 1 kg on a spring of 1 m, pulled by 0.1 m.
std::string oscillator(double k, double c)
{
    return body("mass", 1, {1, 1, 1}, {1.1, 0, 0}) +
           component("spring", "Constraint/SpringDamper",
                     attribute("b", "mass") + attribute("anchor_a", Vec3{}) + attribute("anchor_b", Vec3{}) + attribute("length", 1) +
                         attribute("stiffness", k) + attribute("damping", c));
}

Case spring()
{
    const auto solvers = algorithms_of("Solver");
    Case c{"spring",
           "A spring of any stiffness",
           "1 kg on a spring that is stretched by 0.1 m at the start; 1 s at 1/60 s. "
           "A stiffness of 1e4 N/m makes the product of frequency and step 1.7. "
           "Error: largest distance from the closed form, relative to the amplitude. Where it is at most 2, the phase is lost and the "
           "amplitude is not. "
           "Stable to 1e-3, bounded to 3.",
           "solver",
           "k, N/m",
           solvers,
           brief(kStiffness),
           {},
           {}};
    c.run = [solvers](std::size_t r, std::size_t v)
    {
        const double k = kStiffness[v];
        Trial t(oscillator(k, 0), settings(solvers[r]), kManyEvaluations);
        double worst = 0;
        t.run(1,
              [&]
              {
                  const double exact = 1 + 0.1 * std::cos(std::sqrt(k) * t.simulation().time());
                  worst = std::fmax(worst, std::fabs(t.vec("mass", "position").x - exact) / 0.1);
              });
        return t.judge(worst, {1e-3, 3});
    };
    c.quick = [](std::size_t, std::size_t v) { return v == 0 || v == 2; };
    return c;
}

Case damped_spring()
{
    const auto solvers = algorithms_of("Solver");
    Case c{"spring_damped",
           "A spring with its critical damper",
           "As before, with c = 2 sqrt(k m): the motion dies out within a step where k is large. "
           "Error: as before. "
           "Stable to 1e-3, bounded to 3.",
           "solver",
           "k, N/m",
           solvers,
           brief(kStiffness),
           {},
           {}};
    c.run = [solvers](std::size_t r, std::size_t v)
    {
        const double w = std::sqrt(kStiffness[v]);
        Trial t(oscillator(w * w, 2 * w), settings(solvers[r]), kManyEvaluations);
        double worst = 0;
        t.run(1,
              [&]
              {
                  const double wt = w * t.simulation().time();
                  worst = std::fmax(worst, std::fabs(t.vec("mass", "position").x - 1 - 0.1 * (1 + wt) * std::exp(-wt)) / 0.1);
              });
        return t.judge(worst, {1e-3, 3});
    };
    c.quick = [](std::size_t, std::size_t v) { return v == 5; };
    return c;
}

Case drag()
{
    const auto solvers = algorithms_of("Solver");
    const std::vector<double> drags{1e-2, 1, 1e2, 1e4, 1e8, 1e12};
    Case c{"drag",
           "Drag that stops at once",
           "1 kg at 1 m/s in a medium with linear drag c; 1 s at 1/60 s. "
           "Error: largest deviation of the speed from exp(-c t / m), m/s. "
           "Stable to 1e-3, bounded to 2.",
           "solver",
           "c, kg/s",
           solvers,
           brief(drags),
           {},
           {}};
    c.run = [solvers, drags](std::size_t r, std::size_t v)
    {
        Trial t(body("mass", 1, {1, 1, 1}, {}, attribute("linear_velocity", Vec3{1, 0, 0})) +
                    component("medium", "Field/Drag", attribute("between", "mass") + attribute("linear", drags[v])),
                settings(solvers[r]), kManyEvaluations);
        double worst = 0;
        t.run(1, [&]
              { worst = std::fmax(worst, std::fabs(t.vec("mass", "linear_velocity").x - std::exp(-drags[v] * t.simulation().time()))); });
        return t.judge(worst, {1e-3, 2});
    };
    c.quick = [](std::size_t, std::size_t v) { return v == 3; };
    return c;
}

Case penalty()
{
    const auto solvers = algorithms_of("Solver");
    Case c{"penalty",
           "Spring contacts of any stiffness",
           "A ball of 1 kg hits a floor with Response/Penalty at 1 m/s, without weight and without loss; 0.5 s at 1/60 s. "
           "A soft floor holds it for longer than that; then the closed form is that of the spring. "
           "Error: of speed and position at the end, relative to 1 m/s and 1 m. "
           "Stable to 1e-6, bounded to 1.",
           "solver",
           "k, N/m",
           solvers,
           brief(kStiffness),
           {},
           {}};
    c.run = [solvers](std::size_t r, std::size_t v)
    {
        const double k = kStiffness[v], w = std::sqrt(k), gap = 1.37 * kStep;
        Trial t(ground() + ball("ball", 0.1, 1, {0, 0, 0.1 + gap}, attribute("linear_velocity", Vec3{0, 0, -1})) +
                    contact({"", "Penalty", "", ""}, attribute("response.stiffness", k) + attribute("response.restitution", 1)),
                settings(solvers[r]), kManyEvaluations);
        t.run(0.5);
        if (!t.loaded()) return t.judge(0, {});
        const double since = t.simulation().time() - gap, half = 3.14159265358979323846 / w;
        const bool off = since > half;
        const double speed = off ? 1 : -std::cos(w * since), place = off ? since - half : -std::sin(w * since) / w;
        return t.judge(
            std::fmax(std::fabs(t.vec("ball", "linear_velocity").z - speed), std::fabs(t.vec("ball", "position").z - 0.1 - place)),
            {1e-6, 1});
    };
    c.quick = [](std::size_t, std::size_t v) { return v == 3; };
    return c;
}

}  // namespace

std::vector<Case> spring_cases() { return {spring(), damped_spring(), drag(), penalty()}; }

}  // namespace plab::stability
