/// Scenes of C14 and C15: bodies that slide on a plane.
#pragma once

#include "impacts.h"
#include "support/gravity.h"

namespace plab::test
{

inline std::string step_of(double h) { return "dt=\"" + text(h) + "\""; }
/// A ramp modelled by a level plane with gravity inclined towards x.
inline Vec3 leaning(double angle) { return {kG * std::sin(angle), 0, -kG * std::cos(angle)}; }
inline std::string brick(const Vec3& v = {}) { return kGround + box("a", {0.5, 0.5, 0.1}, at({0, 0, 0.1}, v)); }
inline std::string held(const Algorithm& algorithm, double friction)
{
    return contact("a ground", algorithm, plastic(algorithm), friction,
                   stiffness(algorithm, 1e5, 1e7, "response.tangential_damping_ratio=\"1\" response.steps_per_contact=\"20\""));
}

}  // namespace plab::test
