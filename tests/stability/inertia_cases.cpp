// Spin and degenerate inertia.
#include "case.h"
#include "pieces.h"
#include "trial.h"

namespace plab::stability
{

namespace
{

std::string inertia_settings(const std::string& solver) { return dt(1.0 / 60) + attribute("solver", "Solver/" + solver); }

/// Largest relative change of kinetic energy and angular momentum of the freely rotating bodies.
double drift(Trial& t, double until)
{
    double worst = 0, energy = 0;
    Vec3 momentum;
    const auto now = [&](double& e, Vec3& l)
    {
        const auto totals = t.simulation().totals();
        e = totals.kinetic, l = totals.angular_momentum;
    };
    if (t.loaded()) now(energy, momentum);
    t.run(until,
          [&]
          {
              double e = 0;
              Vec3 l;
              now(e, l);
              worst = std::fmax(worst, std::fmax(std::fabs(e - energy) / energy, length(l - momentum) / length(momentum)));
              if (!std::isfinite(e)) worst = e;
          });
    return worst;
}

Case spin()
{
    const auto solvers = algorithms_of("Solver");
    const std::vector<double> speeds{1, 10, 1e2, 1e3, 1e4};
    Case c{"spin",
           "A free body that spins fast",
           "Inertia 1, 2, 2.5 kg m^2, spin about the middle axis with 1 % across it; 2 s at 1/60 s. "
           "With its angular momentum, the energy is at least 0.8 and at most 2 times the initial one. "
           "Error: largest relative change of energy and angular momentum. "
           "Stable to 1e-3, bounded to 1.01.",
           "solver",
           "spin, rad/s",
           solvers,
           brief(speeds),
           {},
           {}};
    c.run = [solvers, speeds](std::size_t r, std::size_t v)
    {
        Trial t(body("top", 1, {1, 2, 2.5}, {}, attribute("angular_velocity", Vec3{0.01, 1, 0.01} * speeds[v])),
                inertia_settings(solvers[r]), kManyEvaluations);
        return t.judge(drift(t, 2), {1e-3, 1.01});
    };
    c.quick = [](std::size_t, std::size_t v) { return v == 0 || v == 4; };
    return c;
}

Case gyroscope()
{
    const auto solvers = algorithms_of("Solver");
    const std::vector<double> speeds{10, 1e2, 1e3, 1e4};
    Case c{"gyroscope",
           "A fast wheel in a hinge",
           "A disc of 1 kg rotates in a hinge on an arm, whose other end is in a ball joint, under its weight; 1 s at 1/240 s. "
           "Error: the larger of the drift of energy, relative to the wheel's, and the gaps in the joints, m. "
           "Stable to 1e-3, bounded to 1.",
           "solver",
           "spin, rad/s",
           solvers,
           brief(speeds),
           {},
           {}};
    c.run = [solvers, speeds](std::size_t r, std::size_t v)
    {
        Trial t(gravity() + body("arm", 0.1, {0.001, 0.01, 0.01}, {0.25, 0, 0}) +
                    body("wheel", 1, {0.02, 0.01, 0.01}, {0.5, 0, 0}, attribute("angular_velocity", Vec3{speeds[v], 0, 0})) +
                    component("foot", "Constraint/Ball", attribute("b", "arm") + attribute("anchor", Vec3{})) +
                    component("axle", "Constraint/Hinge",
                              attribute("a", "arm") + attribute("b", "wheel") + attribute("anchor", Vec3{0.5, 0, 0}) +
                                  attribute("axis", Vec3{1, 0, 0})),
                dt(1.0 / 240) + attribute("solver", "Solver/" + solvers[r]));
        double worst = 0;
        const auto energy = [&]
        {
            const Bodies& bodies = t.simulation().world().host().bodies;
            double sum = 0;
            for (std::uint32_t b = 0; b < bodies.size(); ++b) sum += bodies.kinetic_energy(b) + bodies.mass[b] * kG * bodies.position[b].z;
            return sum;
        };
        const double scale = 0.01 * speeds[v] * speeds[v] + 1.025 * kG * 0.5, start = t.loaded() ? energy() : 0;
        t.run(1,
              [&]
              {
                  worst = std::fmax(worst, std::fabs(energy() - start) / scale);
                  worst = std::fmax(worst, std::fmax(t.real("foot", "position_error"), t.real("axle", "position_error")));
                  if (!std::isfinite(energy())) worst = energy();
              });
        return t.judge(worst, {1e-3, 1});
    };
    c.quick = [solvers](std::size_t r, std::size_t v) { return v == 1 && solvers[r] == "RungeKutta4"; };
    return c;
}

struct Inertia
{
    const char* name;
    const char* value;
};

Case degenerate()
{
    const auto solvers = algorithms_of("Solver");
    static const std::vector<Inertia> kinds{{"needle", "1e-12 1 1"},
                                            {"disc", "1 1 2"},
                                            {"thin disc, 1e-12", "1e-12 1e-12 2e-12"},
                                            {"zero about one axis", "0 1 1"},
                                            {"zero", "0 0 0"},
                                            {"negative", "-1 1 1"},
                                            {"nan", "nan 1 1"},
                                            {"against the triangle", "1 1 3"},
                                            {"triangle by 1e-3", "1 1 2.002"}};
    std::vector<std::string> names;
    for (const Inertia& i : kinds) names.emplace_back(i.name);
    Case c{"inertia",
           "Degenerate inertia",
           "A free body that spins with 10 rad/s mostly about its third axis; 2 s at 1/60 s. "
           "An inertia that no body can have is refused with its name. The energy of a disc differs by a factor of 2 from axis to axis. "
           "Error: largest relative change of energy and angular momentum. "
           "Stable to 1e-3, bounded to 1.",
           "solver",
           "inertia",
           solvers,
           names,
           {},
           {}};
    c.run = [solvers](std::size_t r, std::size_t v)
    {
        Trial t(component("top", "State/RigidBody",
                          attribute("mass", 1) + attribute("inertia", std::string(kinds[v].value)) +
                              attribute("angular_velocity", Vec3{0.1, 0.1, 10})),
                inertia_settings(solvers[r]), kManyEvaluations);
        return t.judge(drift(t, 2), {1e-3, 1});
    };
    c.quick = [solvers](std::size_t r, std::size_t) { return solvers[r] == "RungeKutta4" || solvers[r] == "Exact"; };
    return c;
}

Case denormal()
{
    const auto solvers = algorithms_of("Solver");
    const std::vector<double> sizes{1e-100, 1e-160, 1e-300, 1e-310};
    Case c{"denormal",
           "Denormal numbers",
           "A spring as above, k = 100 N/m, stretched by the given length about 0, its anchor, and a slow spin of that many rad/s; 1 s at "
           "1/60 s. "
           "Below 1e-154 m the square of a length is 0: the spring has no direction and no force, and the body stays where it is. "
           "Speeds below 1e-150 m/s count as 0. "
           "Error: of the position at the end, relative to the amplitude. "
           "Stable to 1e-1, because a denormal number has few digits; bounded to 3.",
           "solver",
           "amplitude, m",
           solvers,
           brief(sizes),
           {},
           {}};
    c.run = [solvers, sizes](std::size_t r, std::size_t v)
    {
        Trial t(body("mass", 1, {1, 1, 1}, {sizes[v], 0, 0}, attribute("angular_velocity", Vec3{0, 0, sizes[v]})) +
                    component("spring", "Constraint/SpringDamper",
                              attribute("b", "mass") + attribute("anchor_a", Vec3{}) + attribute("anchor_b", Vec3{}) +
                                  attribute("length", 0) + attribute("stiffness", 100)),
                inertia_settings(solvers[r]), kManyEvaluations);
        t.run(1);
        if (!t.loaded()) return t.judge(0, {});
        return t.judge(std::fabs(t.vec("mass", "position").x / sizes[v] - std::cos(10 * t.simulation().time())), {0.1, 3});
    };
    c.quick = [](std::size_t, std::size_t v) { return v == 3; };
    return c;
}

}  // namespace

std::vector<Case> inertia_cases() { return {spin(), gyroscope(), degenerate(), denormal()}; }

}  // namespace plab::stability
