/// Statics problems for any algorithm (contact_algorithms.h): stacks (D1, D2), a table (D6), a ladder (D7), with the loads that
/// they should carry.
#pragma once

#include "reference/contact_algorithms.h"
#include "statics_scene.h"
#include "support/gravity.h"

namespace plab::test
{

/// Algorithms with rigid contacts. Springs sink by m g / k: penalty_test.cpp; for stacks and mass ratios on springs see
/// tests/stability.
inline std::vector<Algorithm> rigid_algorithms()
{
    std::vector<Algorithm> out = standing_algorithms();
    std::erase_if(out, [](const Algorithm& algorithm) { return algorithm.springs(); });
    return out;
}

/// Unit cubes stacked on one another.
inline std::string stack(const std::vector<double>& masses, const Algorithm& algorithm)
{
    std::string body = kGround, ids;
    for (std::size_t i = 0; i < masses.size(); ++i)
    {
        body += box(name_of_box(i), {0.5, 0.5, 0.5}, masses[i], {0, 0, static_cast<double>(i) + 0.5});
        ids += name_of_box(i) + " ";
    }
    return body + gravity(ids) + contact(ids + "ground", algorithm, 0, 0.8);
}

/// Largest relative error of the load on a face.
inline double worst_load(const Scene& s, const std::vector<double>& masses)
{
    double above = 0, worst = 0;
    for (std::size_t i = masses.size(); i-- > 0;)
    {
        above += masses[i] * kG;
        const Vec3 f = force_between(s, i == 0 ? "ground" : name_of_box(i - 1), name_of_box(i));
        worst = std::max(worst, length(f - Vec3{0, 0, above}) / above);
    }
    return worst;
}

struct Stood
{
    double load = 0;      ///< largest relative error of the load on a face
    double sunk = 0;      ///< m, displacement of the top
    double reported = 0;  ///< number of reports that contacts did not converge, or sink
};
/// `over`: the loads are averaged over this many of the last steps, as unconverged sweeps make them fluctuate from step to step.
inline Stood stand(const Algorithm& algorithm, const std::vector<double>& masses, std::int64_t steps, std::int64_t over = 1)
{
    Scene s(stack(masses, algorithm), "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = s.warnings_expected = true;  // a body that falls through is reported as a warning
    s.step(steps - over);
    double load = 0;
    for (std::int64_t i = 0; i < over; ++i)
    {
        s.step(1);
        load += worst_load(s, masses) / static_cast<double>(over);
    }
    const std::size_t top = masses.size() - 1;
    return {load, distance(s.vec(name_of_box(top), "position"), {0, 0, static_cast<double>(top) + 0.5}),
            static_cast<double>(s.count("manager.not_converged") + s.count("contact.deep"))};
}

// D6: a slab of 10 kg on four feet at (+-a, +-b), with a box of 30 kg at (x, y).
struct FourFeet
{
    static constexpr double a = 0.6, b = 0.4, mass = 10, load = 30, x = 0.25, y = 0.1;
    static constexpr double weight = (mass + load) * kG, cx = load * x / (mass + load), cy = load * y / (mass + load);
    static double x_of(std::size_t foot) { return (foot & 1) != 0 ? a : -a; }
    static double y_of(std::size_t foot) { return (foot & 2) != 0 ? b : -b; }

    static std::string scene(const Algorithm& algorithm);
    /// Relative errors of the forces of the feet: from the split of least norm, which is affine in their positions; from the sum
    /// and the moments.
    static double off_least(const std::vector<double>& f);
    static double off_balance(const std::vector<double>& f);
};

inline std::string FourFeet::scene(const Algorithm& algorithm)
{
    std::string feet, shapes;
    for (std::size_t i = 0; i < 4; ++i)
    {
        const std::string id = "foot" + std::to_string(i);
        shapes +=
            "<component id=\"" + id + "\" type=\"Shape/Sphere\" radius=\"0.05\" position=\"" + text(Vec3{x_of(i), y_of(i), -0.05}) + "\"/>";
        feet += id + " ";
    }
    shapes +=
        "<component id=\"slab\" type=\"Shape/Box\" half_extents=\"0.7 0.5 0.05\"/>"
        "<component id=\"table.shape\" type=\"Shape/Compound\" parts=\"slab " +
        feet +
        "\"/>"
        "<component id=\"table\" type=\"State/RigidBody\" shape=\"table.shape\" mass=\"10\" inertia=\"1 2 3\" "
        "center_of_mass=\"0 0 0\" position=\"0 0 0.1\"/>";
    return kGround + shapes + box("load", {0.1, 0.1, 0.1}, load, {x, y, 0.25}) + gravity("table load") +
           contact("table load ground", algorithm, 0, 0.5);
}
inline double FourFeet::off_least(const std::vector<double>& f)
{
    if (f.size() != 4) return HUGE_VAL;
    double worst = 0;
    for (std::size_t i = 0; i < 4; ++i)
        worst = std::max(worst, std::fabs(f[i] / (weight / 4 * (1 + cx * x_of(i) / (a * a) + cy * y_of(i) / (b * b))) - 1));
    return worst;
}
inline double FourFeet::off_balance(const std::vector<double>& f)
{
    if (f.size() != 4) return HUGE_VAL;
    return std::max({std::fabs((f[0] + f[1] + f[2] + f[3]) / weight - 1), std::fabs(a * (f[1] + f[3] - f[0] - f[2]) / weight - cx),
                     std::fabs(b * (f[2] + f[3] - f[0] - f[1]) / weight - cy)});
}

// D7: a uniform capsule of length L between the centres of its ends (radius r), its foot on a floor with friction, its head at a
// smooth wall. Moments about the centre of the foot: m g L cos / 2 = f (L sin + r), f <= mu m g. It slips if and only if
//   (sin theta + r / L) / cos theta < 1 / (2 mu),     tan theta < 1 / (2 mu) for a thin one.
// Below that, by delta, it slides: with F' = mu L cos + L sin / 2 the angle falls by delta (cosh k t - 1),
//   k^2 = m g F' / (I + m L^2 sin^2 / 4),   I = m L^2 / 12.
struct Ladder
{
    static constexpr double mu = 0.5, L = 2, r = 0.002;

    /// sin + r / L = cos / (2 mu): theta = atan(1 / 2 mu) - asin((r / L) / sqrt(1 + 1 / (4 mu^2))).
    static double limit()
    {
        const double q = 1 / (2 * mu);
        return std::atan(q) - std::asin(r / L / std::sqrt(1 + q * q));
    }
    /// m: the distance that its centre slides in `t`, starting `off` below the limit angle.
    static double slides(double off, double t)
    {
        const double c = std::cos(limit() - off), sn = std::sin(limit() - off);
        const double k = std::sqrt(kG * (mu * L * c + 0.5 * L * sn) / (L * L * (1.0 / 12 + 0.25 * sn * sn)));
        return 0.5 * L * off * (std::cosh(k * t) - 1);
    }
    static std::string scene(const Algorithm& algorithm, double theta);
};

inline std::string Ladder::scene(const Algorithm& algorithm, double theta)
{
    const double c = std::cos(theta), sn = std::sin(theta);
    // The axis of the capsule is z, tilted towards +x, where the wall is.
    const std::string turn = "axis 0 1 0 " + text((1.5707963267948966 - theta) * 57.295779513082321) + " deg";
    return kGround +
           std::string("<component id=\"wall\" type=\"State/Static\" shape=\"floor\" orientation=\"axis 0 1 0 -90 deg\" position=\"") +
           text(Vec3{0.5 * L * c + r, 0, 0}) + "\" material=\"ice\"/><component id=\"rod\" type=\"Shape/Capsule\" radius=\"" + text(r) +
           "\" length=\"" + text(L) +
           "\"/><component id=\"ladder\" type=\"State/RigidBody\" shape=\"rod\" mass=\"3\" material=\"wood\" orientation=\"" + turn +
           "\" position=\"" + text(Vec3{0, 0, 0.5 * L * sn + r}) +
           "\"/><component id=\"smooth\" type=\"Material/Pair\" a=\"ice\" b=\"wood\" friction=\"0\" restitution=\"0\"/>" +
           gravity("ladder") + contact("ladder ground wall", algorithm, 0, mu);
}

}  // namespace plab::test
