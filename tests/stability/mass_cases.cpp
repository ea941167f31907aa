// Mass ratios and heights: heavy on light, head on, a chain that carries a heavy body, stacks.
#include "case.h"
#include "pieces.h"
#include "trial.h"

namespace plab::stability
{

namespace
{

const std::vector<double> kRatios{1, 1e2, 1e4, 1e6, 1e8};

/// Friction for all; springs that a mass compresses by about 1e-5 m, with as few sub-steps as they need.
std::string law(const ContactAlgorithm& algorithm, double mass)
{
    const std::string friction = attribute("response.friction", 0.5);
    if (!algorithm.spring()) return friction;
    return friction + attribute("response.stiffness", (algorithm.response == "Penalty" ? 1e6 : 1e8) * mass) +
           attribute("response.restitution", 0.2) + attribute("response.steps_per_contact", 20);
}

/// Force evaluations of a cell, times bodies: with springs, each evaluation queries all contacts.
constexpr std::uint64_t kManyBodies = 500'000;

std::string cube_name(int i) { return "cube" + std::to_string(100 + i); }

/// Unit cubes on the floor, masses from below, for 1 s; springs for `load`, kg. Returns the largest displacement, m.
Outcome tower(const ContactAlgorithm& algorithm, const std::vector<double>& masses, double load)
{
    std::string parts = ground() + gravity();
    for (std::size_t i = 0; i < masses.size(); ++i)
        parts += box(cube_name(static_cast<int>(i)), {0.5, 0.5, 0.5}, masses[i], {0, 0, static_cast<double>(i) + 0.5});
    Trial t(parts + contact(algorithm, law(algorithm, load)), dt(1.0 / 60), kManyBodies / masses.size());
    t.run(1);
    if (!t.loaded()) return t.judge(0, {});
    double worst = 0;
    for (std::size_t i = 0; i < masses.size(); ++i)
    {
        const Vec3 p = t.vec(cube_name(static_cast<int>(i)), "position");
        worst = std::fmax(worst, length(p - Vec3{0, 0, static_cast<double>(i) + 0.5}));
    }
    return t.judge(worst, {1e-3, 0.5});
}

Case heavy_on_light()
{
    Case c{"mass_pair",
           "Heavy on light",
           "A cube of 1 m with the given mass stands on a cube of 1 kg, which stands on the floor; 1 s at 1/60 s. "
           "Springs are as stiff as the load requires, 1e6 N/m per kg. "
           "Error: distance of a cube from where it should be, m. "
           "Stable to 1e-3, bounded to half a cube.",
           "contact",
           "mass ratio",
           names_of(contact_algorithms()),
           brief(kRatios),
           {},
           {}};
    c.run = [](std::size_t r, std::size_t v) { return tower(contact_algorithms()[r], {1, kRatios[v]}, kRatios[v]); };
    c.quick = [](std::size_t r, std::size_t v) { return r >= 3 && (v == 0 || v == 4); };
    return c;
}

Case head_on()
{
    Case c{"mass_head_on",
           "Head-on impact of unequal masses",
           "A ball of the given mass hits a ball of 1 kg at rest with 1 m/s; 0.5 s at 1/60 s. "
           "Restitution 1, no friction, no weight. "
           "Error: of the speeds after the impact, relative to 1 m/s. "
           "Stable to 1e-6, bounded to 1.",
           "contact",
           "mass ratio",
           names_of(contact_algorithms()),
           brief(kRatios),
           {},
           {}};
    c.run = [](std::size_t r, std::size_t v)
    {
        const ContactAlgorithm& algorithm = contact_algorithms()[r];
        const double m = kRatios[v];
        Trial t(
            ball("light", 0.1, 1, {0, 0, 0}) + ball("heavy", 0.1, m, {-0.25, 0, 0}, "linear_velocity=\"1 0 0\"") +
                contact(algorithm, attribute("response.restitution", 1) + (algorithm.spring() ? attribute("response.stiffness", 1e6) : "")),
            dt(1.0 / 60));
        t.run(0.5);
        if (!t.loaded()) return t.judge(0, {});
        const double light = t.vec("light", "linear_velocity").x - 2 * m / (1 + m);
        const double heavy = t.vec("heavy", "linear_velocity").x - (m - 1) / (m + 1);
        return t.judge(std::fmax(std::fabs(light), std::fabs(heavy)), {1e-6, 1});
    };
    c.quick = [](std::size_t, std::size_t v) { return v == 0 || v == 4; };
    return c;
}

constexpr int kLinks = 5;

std::string chain(double heavy)
{
    std::string parts = gravity();
    for (int i = 0; i < kLinks; ++i)
    {
        const double x = i;
        parts += body(cube_name(i), i + 1 == kLinks ? heavy : 1, Vec3{0.01, 0.1, 0.1} * (i + 1 == kLinks ? heavy : 1), {x + 0.5, 0, 0});
        parts +=
            component("joint" + std::to_string(i), "Constraint/Ball",
                      (i == 0 ? "" : attribute("a", cube_name(i - 1))) + attribute("b", cube_name(i)) + attribute("anchor", Vec3{x, 0, 0}));
    }
    return parts;
}

Case heavy_chain()
{
    const auto solvers = algorithms_of("Solver");
    Case c{"mass_chain",
           "A chain that carries a heavy body",
           "Five links of 1 m in ball joints are released from the horizontal; 0.5 s at 1/240 s. "
           "The last link has the given mass, the others 1 kg. "
           "Error: the larger of the drift of energy, relative to the work of the weight, and the gap in a joint, m. "
           "Stable to 1e-3, bounded to 1.",
           "solver",
           "mass ratio",
           solvers,
           brief(kRatios),
           {},
           {}};
    c.run = [solvers](std::size_t r, std::size_t v)
    {
        Trial t(chain(kRatios[v]), dt(1.0 / 240) + attribute("solver", "Solver/" + solvers[r]));
        double worst = 0;
        t.run(0.5,
              [&]
              {
                  double energy = 0, scale = 0;
                  const Bodies& bodies = t.simulation().world().host().bodies;
                  for (std::uint32_t b = 0; b < bodies.size(); ++b)
                  {
                      energy += bodies.kinetic_energy(b) + bodies.mass[b] * kG * bodies.position[b].z;
                      scale += bodies.mass[b] * kG;
                  }
                  worst = std::fmax(worst, std::fabs(energy) / scale);
                  for (int i = 0; i < kLinks; ++i) worst = std::fmax(worst, t.real("joint" + std::to_string(i), "position_error"));
              });
        return t.judge(worst, {1e-3, 1});
    };
    c.quick = [solvers](std::size_t r, std::size_t v) { return solvers[r] == "RungeKutta4" && v == 4; };
    return c;
}

Case stack()
{
    const std::vector<int> heights{10, 20, 50, 100};
    Case c{"stack",
           "Stacks",
           "Cubes of 1 m and 1 kg stand on one another; 1 s at 1/60 s. "
           "Springs have 1e6 N/m per contact point; those of Hunt and Crossley have 1e8 N/m^1.5. "
           "Error: distance of a cube from where it should be, m. "
           "Stable to 1e-3, bounded to half a cube.",
           "contact",
           "cubes",
           names_of(contact_algorithms()),
           {"10", "20", "50", "100"},
           {},
           {}};
    c.run = [heights](std::size_t r, std::size_t v)
    { return tower(contact_algorithms()[r], std::vector<double>(static_cast<std::size_t>(heights[v]), 1.0), 1); };
    c.quick = [](std::size_t r, std::size_t v) { return r >= 3 && v == 0; };
    return c;
}

}  // namespace

std::vector<Case> mass_cases() { return {heavy_on_light(), head_on(), heavy_chain(), stack()}; }

}  // namespace plab::stability
