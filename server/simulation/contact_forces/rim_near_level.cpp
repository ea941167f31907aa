#include "simulation/contact_forces/rim_near_level.h"

#include <cmath>

namespace plab::simulation
{

void round_rim_near_level(Contact& contact)
{
    const Pivot& pivot = contact.pivot;
    if (pivot.of == Pivot::Of::Neither || pivot.kind != Pivot::Arm::OnRim) return;
    const double radius = length(pivot.arm);
    if (!(radius > 0)) return;
    const double sine = std::fabs(dot(pivot.arm, contact.normal)) / radius;
    const double t = sine / kNearlyLevel;
    if (!(t < 1)) return;
    const double left = 1 - t, h = sine * (1 - left * left * left), slope = 1 - left * left * left + 3 * t * left * left;
    // Of the support function's derivative with respect to the angle, that along the normal moves no force's line of action.
    const double arm = h * sine + slope * (1 - sine * sine);
    contact.point += (arm - 1) * pivot.arm;
    contact.depth -= radius * (sine - h);
}

}  // namespace plab::simulation
