/// How two frames lie to one another, and the relations that rules ask for.
///
///   d = p_B - p_A,  along = d . z_A,  radial = |d - along z_A|,  angle = acos |z_A . z_B|
///
///   near       |d| <= reach
///   touching   |d| - (r_A + r_B) <= tolerance
///   coaxial    radial <= tolerance
///   meshing    |radial - (r_A + r_B)| <= tolerance
///   inside     |radial - |r_A - r_B|| <= tolerance
/// All of them also ask for |d| <= reach, |along| <= the bound on it, and angle <= the bound on it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plab/vector.h"

namespace plab::rules
{

enum class Kind : std::uint8_t
{
    Near,
    Touching,
    Coaxial,
    Meshing,
    Inside,
};

/// In the order of Kind.
const std::vector<std::string>& relation_names();
Kind relation_of(const std::string& name);

/// A frame in W.
struct Place
{
    Pose X;
    double radius = 0;  ///< m
};

struct Measures
{
    double distance = 0, along = 0, radial = 0;  ///< m
    double angle = 0;                            ///< rad, 0 to pi / 2
};
Measures measure(const Place& a, const Place& b);

struct Bounds
{
    Kind kind = Kind::Near;
    double reach = 0, tolerance = 0, along = 0;  ///< m
    double angle = 0;                            ///< rad
};
/// Whether the relation holds with all bounds multiplied by `slack`.
bool holds(const Bounds& bounds, const Measures& m, double radius_a, double radius_b, double slack = 1);

}  // namespace plab::rules
