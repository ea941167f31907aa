#include "link/appearance.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "plab/rotation.h"

namespace plab::link
{

Vec3 color_of_id(const std::string& id)
{
    static constexpr std::array<Vec3, 10> kPalette{{{0.87, 0.33, 0.28},
                                                    {0.24, 0.52, 0.78},
                                                    {0.93, 0.69, 0.22},
                                                    {0.36, 0.68, 0.42},
                                                    {0.58, 0.42, 0.74},
                                                    {0.91, 0.51, 0.24},
                                                    {0.27, 0.68, 0.71},
                                                    {0.84, 0.44, 0.62},
                                                    {0.61, 0.66, 0.25},
                                                    {0.47, 0.56, 0.69}}};
    std::uint32_t hash = 2166136261u;  // FNV-1a
    for (const char c : id) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
    return kPalette[(hash ^ (hash >> 16)) % kPalette.size()];
}

Vec3 shown_color(const Object& object)
{
    constexpr Vec3 kStaticColor{0.62, 0.63, 0.66};
    const bool is_static = !is_shaft(object) && object.motion == "static";
    return color_of(object).value_or(is_static ? kStaticColor : color_of_id(object.component_id));
}

Axle axle_of_inertia(double inertia)
{
    // A disk of radius r, length r/2 and density 1000: J = rho pi r^4 (r/2) / 2.
    constexpr double kDensity = 1000, kThinnest = 0.05, kThickest = 0.5;
    const double r = inertia > 0 ? std::pow(4 * inertia / (kDensity * std::numbers::pi), 0.2) : kThinnest;
    const double radius = std::clamp(r, kThinnest, kThickest);
    const double half_length = std::clamp(radius / 4, 0.02, 0.1);
    return {radius, half_length, {0.82 * radius, 0, 0}, {0.22 * radius, 0.08 * radius, 1.12 * half_length}};
}

double shaft_angle(const Object& shaft)
{
    double angle = 0;
    for (const Parameter& p : shaft.parameters)
        if (p.name == "angle") (void)std::from_chars(p.text.data(), p.text.data() + p.text.size(), angle);
    return angle;
}

Quat shaft_rotation(double angle) { return exp_rotation({0, 0, angle}); }

}  // namespace plab::link
