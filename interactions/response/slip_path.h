/// How the slip of a contact turns while its impulse grows.
#pragma once

#include <utility>

#include "plab/vector.h"

namespace plab::response
{

/// What a collision has come to.
struct ImpactState
{
    Vec3 u;           ///< m/s, in contact coordinates
    Vec3 impulse;     ///< N s on b
    double work = 0;  ///< J, of the normal impulse in this phase
};

/// Rates per unit of normal impulse while slipping along (c, s).
struct SlipRates
{
    double grow = 0;    ///< of the slip speed
    double turn = 0;    ///< slip speed times rate of its direction
    double normal = 0;  ///< of u_n
};

/// Coulomb friction at one contact point.
struct SlipLaw
{
    Mat3 K;
    double friction = 0;

    SlipRates rates(double c, double s) const;
    /// What counts as large for `turn`.
    double scale() const;
    /// Force per unit of normal force that keeps the point from slipping.
    Vec3 holding_force() const;
    /// The direction in which slip starts from nothing where friction cannot hold: turn = 0 and grow > 0.
    std::pair<double, double> leaving_direction() const;
};

enum class SlipEnd
{
    Phase,     ///< compression or restitution ended
    Stopped,   ///< slip ended
    Straight,  ///< the direction has settled; the rest is linear
};

/// Integrates a curved slip. With dJ_n = slip * dtau the equations are smooth up to the end of the slip, which they
/// approach exponentially:   s' = turn(s) s_perp,  slip' = slip * grow(s),  u_n' = slip * normal(s).
/// Dormand-Prince 5(4), tolerance 1e-13; phase ends are found on the last step by false position.
SlipEnd follow_slip(const SlipLaw& law, bool compressing, double goal, ImpactState& state);

}  // namespace plab::response
