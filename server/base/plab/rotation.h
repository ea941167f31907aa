/// The exponential map of rotations and its differential: how solvers turn a rotation vector into an orientation.
///
/// Sources: Iserles, Munthe-Kaas, Norsett, Zanna, "Lie-group methods", Acta Numerica 9 (2000), sections 2.3 and B;
/// Rodrigues' formula. Small angles use series (no library call), larger ones the host's sin and cos.
#pragma once

#include "plab/vector.h"

namespace plab
{

/// The unit quaternion of the rotation by |u| rad about u. u in rad.
inline Quat exp_rotation(const Vec3& u)
{
    const double t2 = length_squared(u);
    if (t2 < 0.25)
    {
        const double a = 0.25 * t2;  // (|u|/2)^2; series to below one ulp at |u| = 0.5
        const double c = 1 - a / 2 * (1 - a / 12 * (1 - a / 30 * (1 - a / 56 * (1 - a / 90))));
        const double s = 0.5 * (1 - a / 6 * (1 - a / 20 * (1 - a / 42 * (1 - a / 72 * (1 - a / 110)))));
        return {c, s * u.x, s * u.y, s * u.z};
    }
    const double t = std::sqrt(t2);
    const double s = std::sin(0.5 * t) / t;
    return {std::cos(0.5 * t), s * u.x, s * u.y, s * u.z};
}

/// The rotation vector of q, |u| <= pi. The inverse of exp_rotation.
inline Vec3 log_rotation(const Quat& q)
{
    const double sign = q.w < 0 ? -1.0 : 1.0;
    const Vec3 v{sign * q.x, sign * q.y, sign * q.z};
    const double s = length(v);
    return s < 1e-9 ? 2.0 * v : v * (2.0 * std::atan2(s, sign * q.w) / s);
}

/// The rate of the rotation vector u of q = q0 exp(u) when the body turns at w_B (rad/s, in the body frame):
///   u' = w + u x w / 2 + c u x (u x w),   c = (1 - t/2 cot(t/2)) / t^2,  t = |u|.
/// Valid for |u| < 2 pi; solvers restart the chart at each step, so |u| stays far below that.
inline Vec3 rotation_vector_rate(const Vec3& u, const Vec3& w_B)
{
    const double t2 = length_squared(u);
    double c = 0;
    if (t2 < 0.25)
        c = 1.0 / 12 + t2 * (1.0 / 720 + t2 * (1.0 / 30240 + t2 * (1.0 / 1209600 + t2 / 47900160.0)));
    else
    {
        const double half = 0.5 * std::sqrt(t2);
        c = (1 - half * std::cos(half) / std::sin(half)) / t2;
    }
    const Vec3 uw = cross(u, w_B);
    return w_B + 0.5 * uw + c * cross(u, uw);
}

}  // namespace plab
