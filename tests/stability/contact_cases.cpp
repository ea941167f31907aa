// Contacts without a good solution, or with very many: overlap at the start, Painleve's rod, endless bounces.
#include "case.h"
#include "pieces.h"
#include "trial.h"

namespace plab::stability
{

namespace
{

Case overlap()
{
    const std::vector<double> depths{0.01, 0.1, 0.3, 0.49, 0.9};
    Case c{"overlap",
           "Bodies that overlap at the start",
           "A ball of 0.5 m radius and 1 kg overlaps the floor, and a second ball beside it, by the given depth; 2 s at 1/60 s. "
           "Springs have 1e4 N/m and restitution 0.2, and return the energy that the overlap stored. "
           "Error: the largest kinetic energy, relative to that of a fall from twice its size. "
           "Stable to 1, bounded to 1e3; a ball that has fallen through the floor is beyond all bounds.",
           "contact",
           "depth, m",
           names_of(contact_algorithms()),
           brief(depths),
           {},
           {}};
    c.run = [depths](std::size_t r, std::size_t v)
    {
        const ContactAlgorithm& algorithm = contact_algorithms()[r];
        const double d = depths[v];
        Trial t(ground() + gravity() + ball("ball", 0.5, 1, {0, 0, 0.5 - d}) + ball("other", 0.5, 1, {1 - d, 0, 0.5}) +
                    contact(algorithm,
                            attribute("response.friction", 0.3) +
                                (algorithm.spring() ? attribute("response.stiffness", 1e4) + attribute("response.restitution", 0.2) : "")),
                dt(1.0 / 60));
        double worst = 0;
        t.run(2, [&] { worst = std::fmax(worst, t.simulation().totals().kinetic / (2 * kG)); });
        if (!t.loaded()) return t.judge(0, {});
        const double low = std::fmin(t.vec("ball", "position").z, t.vec("other", "position").z);
        return t.judge(low < -0.5 ? 1e9 * -low : worst, {1, 1e3});
    };
    c.quick = [](std::size_t r, std::size_t v) { return r >= 2 && v == 3; };
    return c;
}

Case painleve()
{
    const std::vector<double> frictions{0.5, 1, 4.0 / 3, 2, 5};
    Case c{"painleve",
           "Painleve's rod",
           "A rod of 2 m and 1 kg at 60 degrees touches the floor with its lower end, which slides ahead with 5 m/s; 1 s at 1/240 s, no "
           "restitution. "
           "With a friction above about 4/3 no finite force solves its equations, and an impulse is necessary. "
           "Error: largest depth of the rod's axis below the floor, m, or the energy that it gains, relative. "
           "Stable to 0.03, the distance that the upper end covers in a step when it lands with 7.1 m/s; bounded to 0.1.",
           "contact",
           "friction",
           names_of(contact_algorithms()),
           brief(frictions),
           {},
           {}};
    c.run = [frictions](std::size_t r, std::size_t v)
    {
        const ContactAlgorithm& algorithm = contact_algorithms()[r];
        const double angle = 3.14159265358979323846 / 3;
        const Vec3 along{std::cos(angle), 0, std::sin(angle)}, middle{along.x, 0, along.z + 0.01};
        const double tilt = 0.5 * (3.14159265358979323846 / 2 - angle);  // a capsule lies along z
        Trial t(ground() + gravity() + component("rod.shape", "Shape/Capsule", attribute("radius", 0.01) + attribute("length", 2)) +
                    component("rod", "State/RigidBody",
                              attribute("shape", std::string("rod.shape")) + attribute("mass", 1) +
                                  attribute("inertia", Vec3{1.0 / 3, 1.0 / 3, 1e-4}) + attribute("position", middle) +
                                  attribute("orientation", text(std::cos(tilt)) + " 0 " + text(std::sin(tilt)) + " 0") +
                                  attribute("linear_velocity", Vec3{-5, 0, 0})) +
                    contact(algorithm,
                            attribute("response.friction", frictions[v]) +
                                (algorithm.spring() ? attribute("response.stiffness", 1e6) + attribute("response.restitution", 0.2) : "")),
                dt(1.0 / 240));
        double worst = 0;
        const auto energy = [&] { return t.simulation().totals().kinetic + kG * t.vec("rod", "position").z; };
        const double start = t.loaded() ? energy() : 0;
        t.run(1,
              [&]
              {
                  const Vec3 p = t.vec("rod", "position"), axis = rotate(t.quat("rod", "orientation"), Vec3{0, 0, 1});
                  worst = std::fmax(worst, std::fabs(axis.z) - p.z);
                  worst = std::fmax(worst, energy() / start - 1);
              });
        return t.judge(worst, {0.03, 0.1});
    };
    c.quick = [](std::size_t r, std::size_t v) { return r >= 3 && v == 4; };
    return c;
}

Case zeno()
{
    std::vector<ContactAlgorithm> algorithms = contact_algorithms();
    for (const char* resolution : {"Bisection", "LocalBisection", "ConservativeAdvancement", "LocalRoot"})
        algorithms.push_back({std::string("Rows, ") + resolution, "Rows", resolution, "Direct"});
    const std::vector<double> restitutions{0, 0.5, 0.9, 0.99, 0.9999};
    Case c{"zeno",
           "Bounces without end",
           "A ball of 0.1 m radius falls from 0.2 m with the given restitution; 8 s at 1/60 s. "
           "Below 0.95, its infinitely many bounces have ended by then. "
           "Error: distance from its rest, m; where it still bounces, the energy that it has gained, J. "
           "Stable to 1e-3, bounded to 0.1.",
           "contact",
           "restitution",
           names_of(algorithms),
           brief(restitutions),
           {},
           {}};
    c.run = [algorithms, restitutions](std::size_t r, std::size_t v)
    {
        const ContactAlgorithm& algorithm = algorithms[r];
        const double e = restitutions[v];
        Trial t(
            ground() + gravity() + ball("ball", 0.1, 1, {0, 0, 0.3}) +
                contact(algorithm, attribute("response.restitution", e) + (algorithm.spring() ? attribute("response.stiffness", 1e6) : "")),
            dt(1.0 / 60));
        t.run(8);
        if (!t.loaded()) return t.judge(0, {});
        const double z = t.vec("ball", "position").z - 0.1, energy = kG * z + t.simulation().totals().kinetic;
        return t.judge(e < 0.95 ? std::fabs(z) : std::fmax(0.0, std::fmax(energy - 0.2 * kG, -z)), {1e-3, 0.1});
    };
    c.quick = [](std::size_t r, std::size_t v) { return r >= 2 && v == 1; };
    return c;
}

}  // namespace

std::vector<Case> contact_cases() { return {overlap(), painleve(), zeno()}; }

}  // namespace plab::stability
