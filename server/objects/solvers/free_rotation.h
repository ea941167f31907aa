/// Torque-free rotation of a rigid body in its principal frame, in closed form for any time.
#pragma once

#include "elliptic.h"
#include "plab/dynamics.h"
#include "plab/vector.h"

namespace plab::solvers
{

/// Principal frame P of a body: the columns of `axes` are its axes in B.
struct PrincipalAxes
{
    Mat3 axes;        ///< R_BP, a proper rotation
    Vec3 moment;      ///< kg m^2, in no particular order unless sorted
    Vec3 reciprocal;  ///< 1/(kg m^2)
};

/// By Jacobi's rotations; free for a body whose frame is principal already. Small moments of a needle are taken from the
/// inverse inertia, which knows them to full precision.
PrincipalAxes principal_axes(const RigidMember& member);
/// The same frame with its axes in the order of ascending moments.
PrincipalAxes ascending(const PrincipalAxes& body);

/// Free rotation that starts with the angular momentum m in P.
///
/// Euler's equations m' = m x w, w_i = m_i / I_i: by Jacobi's functions and their addition theorem, written so that no
/// amplitude is divided by: spheres, symmetric tops, rotations about an axis and the separatrix are no special cases.
/// With a > b > c the reciprocal moments, and when the motion circles axis a:
///   l^2 = (a-b) (a-c) m_a^2 + (a-b) (b-c) m_b^2,   l^2 k'^2 = (a-c) ((a-b) m_a^2 - (b-c) m_c^2),   s = sn(l t) / l,
///   m_b(t) = (m_b cn dn + (a-c) m_a m_c s) / D,    D = cn^2 + (a-b) (a-c) m_a^2 s^2,
///   m_c(t) = (m_c cn - (a-b) m_a m_b s dn) / D,    m_a(t) = (m_a dn - (b-c) m_b m_c s cn) / D.
/// Attitude: the shortest turns p(m) that take m to the axis that is circled, and between them a twist about it,
///   Q(t) = p(m(0))^-1 twist(psi) p(m(t)),   psi' = (2 T + |L| w_a) / (|L| + m_a),
/// whose integrand is analytic in a strip of half width pi/2 (in l t) or more about the real axis, so that Gauss'
/// quadrature gets it to rounding with few nodes; whole periods by the trapezoidal rule.
/// Sources: Jacobi, Crelle 39 (1849); van Zon, Schofield, J. Comput. Phys. 225 (2007) 145; Celledoni, Fasso, Saefstroem,
/// Zanna, SIAM J. Sci. Comput. 30 (2008) 2084 (the rotation as two charts and one angle).
class FreeTop
{
public:
    /// m in N m s.
    FreeTop(const PrincipalAxes& body, const Vec3& m);

    /// Angular momentum in P after t seconds, N m s.
    Vec3 momentum(double t) const { return direction_at(t) * size_; }
    /// Takes vectors in P at time t to P at time 0.
    Quat turn(double t) const;

private:
    struct Values
    {
        double s, cn, dn;
        double inverse_divisor;               ///< 1 / D
        bool small;                           ///< a small part of a turn: the differences below are used
        double cn_lack, dn_lack, cn_dn_lack;  ///< D - cn, D - dn, D - cn dn
        /// (own * factor + mixed) / D
        double component(double own, double factor, double lack, double mixed) const
        {
            return small ? own + (mixed - own * lack) * inverse_divisor : (own * factor + mixed) * inverse_divisor;
        }
    };
    Values values_at(double t) const;
    Vec3 direction_at(double t) const;
    double axial_at(double t) const;
    double twist_rate(double t) const;
    double twist(double t) const;
    double twist_over(double begin, double end) const;
    Quat swing(const Vec3& direction) const;

    double size_ = 0;  ///< |L|
    Vec3 n_;           ///< m / |L|
    Vec3 rate_;        ///< |L| / I_i, 1/s
    int circled_ = 0, middle_ = 1, other_ = 2;
    double to_middle_ = 0, to_other_ = 0, to_circled_ = 0;  ///< coefficients of s above, signed by the order of the axes
    double divisor_ = 0;                                    ///< factor of s^2 in D
    double sign_ = 1;                                       ///< of the momentum along the axis that is circled
    double lambda_ = 0;                                     ///< 1/s
    double twice_energy_ = 0;                               ///< 2 T / |L|, 1/s
    EllipticModulus modulus_{1};
    bool steady_ = false;  ///< m_a does not change
};

}  // namespace plab::solvers
