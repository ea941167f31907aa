/// What holds where two surfaces touch, by the rules of the file's format.
#pragma once

#include "import/robot.h"

namespace plab::import
{

/// Friction and restitution of a contact of two surfaces.
SurfaceLaw surface_law(const Surface& a, const Surface& b, SurfaceRule rule);

/// MuJoCo's contacts are springs with damping, which solref gives: a time constant (s) and a damping ratio, both positive; or stiffness and
/// damping for 1 kg, with the opposite sign.
struct ContactSpring
{
    double frequency = 0;  ///< rad/s, without damping
    double ratio = 1;      ///< of the damping to the critical one
};
ContactSpring spring_of(const Solref& solref);
/// The part of its speed with which a body leaves such a spring, which cannot pull. 0 from critical damping on.
double rebound_of(const ContactSpring& spring);

}  // namespace plab::import
