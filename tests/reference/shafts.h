/// Gear trains used by several tests: parts of blueprints, and F2, F7.
#pragma once

#include <string>
#include <vector>

#include "support/scene.h"
#include "support/text.h"

namespace plab::test
{

inline std::string shaft(const std::string& id, double inertia, double speed = 0)
{
    return "<component id=\"" + id + "\" type=\"State/Shaft\" inertia=\"" + text(inertia) + "\" angular_velocity=\"" + text(speed) + "\"/>";
}
/// `type`: Graph, Impulse or Assign; or Gear, whose row the solver satisfies.
inline std::string gear(const std::string& id, const std::string& type, const std::string& a, const std::string& b,
                        const std::string& factor)
{
    return "<component id=\"" + id + "\" type=\"Constraint/" + (type == "Gear" ? "" : "AngularVelocity/") + type + "\" driver=\"" + a +
           "\" driven=\"" + b + "\" velocity_factor=\"" + factor + "\"/>";
}
inline std::string torque(const std::string& on, const std::string& value)
{
    return "<component id=\"torque\" type=\"Script/Lua\" driven=\"" + on +
           "\"><param name=\"code\">function force(t, state) driven:add_torque(" + value + ") end</param></component>";
}

/// F2: seven shafts of 1e-3 kg m^2 and six meshes, a torque of 1 N m on the first.
inline std::string six_meshes(const std::string& type, const std::string& factor)
{
    std::string parts;
    for (int i = 0; i < 7; ++i) parts += shaft("s" + std::to_string(i), 0.001);
    for (int i = 0; i < 6; ++i) parts += gear("g" + std::to_string(i), type, "s" + std::to_string(i), "s" + std::to_string(i + 1), factor);
    return parts + torque("s0", "1");
}
/// The effective inertia at `first` of the shafts from `first` on, kg m^2.
inline double inertia_from(int first, double ratio)
{
    double sum = 0;
    for (int i = 6 - first; i >= 0; --i) sum += std::pow(ratio * ratio, i) * 1e-3;
    return sum;
}

/// F7: a chain of gears with ratios between 1/3 and 3, given by whole numbers of teeth; a torque of 1 N m on the first shaft.
struct GearLine
{
    std::string parts;
    std::vector<double> ratios{1};  ///< speed of each shaft over that of the first

    static std::string id(int i)
    {
        char out[16];
        std::snprintf(out, sizeof out, "s%04d", i);
        return out;
    }
    GearLine(int shafts, const std::string& type)
    {
        std::uint64_t seed = 7;
        for (int i = 0; i < shafts; ++i)
        {
            parts += shaft(id(i), 0.001);
            if (i == 0) continue;
            seed = seed * 6364136223846793005ull + 1442695040888963407ull;
            const int driver = 20 + static_cast<int>((seed >> 33) % 40), driven = 20 + static_cast<int>((seed >> 43) % 40);
            parts += "<component id=\"g" + id(i) + "\" type=\"Constraint/" + (type == "Gear" ? "" : "AngularVelocity/") + type +
                     "\" driver=\"" + id(i - 1) + "\" driven=\"" + id(i) + "\" driver_teeth=\"" + std::to_string(driver) +
                     "\" driven_teeth=\"" + std::to_string(driven) + "\"/>";
            ratios.push_back(-ratios.back() * driver / driven);
        }
        parts += torque(id(0), "1");
    }
    /// The largest |angle_i / (ratio_i angle_0) - 1|.
    double phase(const Scene& s) const
    {
        double worst = 0;
        for (std::size_t i = 0; i < ratios.size(); ++i)
            worst = std::fmax(worst, std::fabs(s.angle(id(static_cast<int>(i))) / (ratios[i] * s.angle(id(0))) - 1));
        return worst;
    }
    /// rad, the largest difference of an angle and the ratio times the angle of the root, as the graph has found them: 0 if angles are
    /// derived.
    static double drift(const Scene& s)
    {
        const auto& shafts = s.simulation().world().host().shafts;
        double worst = 0;
        for (std::size_t k = 0; k < shafts.angle.size(); ++k)
            worst = std::fmax(worst, std::fabs(shafts.angle[k] - shafts.ratio[k] * shafts.angle[shafts.root[k]]));
        return worst;
    }
};

}  // namespace plab::test
