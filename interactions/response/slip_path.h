/// Integration of the slip during an impact: how its direction and speed change while the normal impulse grows.
///
/// If K couples the directions, friction turns the slip. Its direction then obeys a differential equation, and the impulse
/// depends on the whole path of the slip velocity in the (t1, t2) plane: the slip path. With J_n as the independent variable,
/// that equation is singular where the slip ends. The substitution dJ_n = |u_t| dtau removes the singularity.
#pragma once

#include <utility>

#include "plab/vector.h"

namespace plab::response
{

/// The state of a collision.
struct ImpactState
{
    Vec3 u;           ///< m/s, in contact coordinates
    Vec3 impulse;     ///< N s on b
    double work = 0;  ///< J, of the normal impulse in this phase
    int series = 0;   ///< power series computed so far: nearly all of the work
};

/// Rates per unit of normal impulse while slipping in the direction (c, s).
struct SlipRates
{
    double grow = 0;    ///< of the slip speed
    double turn = 0;    ///< slip speed times the rate of its direction
    double normal = 0;  ///< of u_n
};

/// Coulomb friction at one contact point.
struct SlipLaw
{
    Mat3 K;
    double friction = 0;

    SlipRates rates(double c, double s) const;
    /// The magnitude against which `turn` is compared.
    double scale() const;
    /// The force per unit of normal force that keeps the point from slipping.
    Vec3 holding_force() const;
    /// The direction in which slip starts from rest if friction cannot hold: turn = 0 and grow > 0.
    std::pair<double, double> leaving_direction() const;
};

enum class SlipEnd
{
    Phase,     ///< compression or restitution ended
    Stopped,   ///< slip ended
    Straight,  ///< the direction has become constant; the rest is linear
};

/// Integrates a curved slip path. With dJ_n = slip * dtau the equations are smooth up to the end of the slip, which they
/// approach exponentially:
///   s' = turn(s) s_perp,  slip' = slip * grow(s),  u_n' = slip * normal(s).
/// Taylor series of order 16, tolerance 1e-13; the end of a phase is located on the last series by false position.
/// Source: Jorba, Zou, Exp. Math. 14 (2005) 99, for the coefficients by recurrence and for the step size.
SlipEnd follow_slip(const SlipLaw& law, bool compressing, double goal, ImpactState& state);

}  // namespace plab::response
