#include "inertia.h"

#include <algorithm>

#include "check_positive.h"

namespace plab::bodies
{
namespace
{

constexpr double kTriangleTolerance = 1e-9;
/// Beyond this ratio of moments, the smallest moment of a matrix with products of inertia is only rounding error.
constexpr double kMostCondition = 1e15;

bool is_finite(const Mat3& a)
{
    for (const auto& row : a.m)
        for (const double x : row)
            if (!std::isfinite(x)) return false;
    return true;
}

bool is_symmetric(const Mat3& a) { return a == transposed(a); }
bool is_diagonal(const Mat3& a) { return a(0, 1) == 0 && a(0, 2) == 0 && a(1, 2) == 0 && a(1, 0) == 0 && a(2, 0) == 0 && a(2, 1) == 0; }

/// Makes a(p, q) zero by a rotation in their plane (Golub, Van Loan, Matrix computations, section 8.5.2).
void jacobi_rotate(Mat3& a, int p, int q)
{
    if (a(p, q) == 0) return;
    const double tau = (a(q, q) - a(p, p)) / (2 * a(p, q));
    const double t = (tau >= 0 ? 1.0 : -1.0) / (std::fabs(tau) + std::sqrt(1 + tau * tau));
    const double c = 1 / std::sqrt(1 + t * t), s = t * c;
    const int r = 3 - p - q;
    const double apq = a(p, q), arp = a(r, p), arq = a(r, q);
    a(p, p) -= t * apq;
    a(q, q) += t * apq;
    a(p, q) = a(q, p) = 0;
    a(r, p) = a(p, r) = c * arp - s * arq;
    a(r, q) = a(q, r) = s * arp + c * arq;
}

std::string moments_text(const std::array<double, 3>& moments)
{
    return number_text(moments[0]) + ", " + number_text(moments[1]) + ", " + number_text(moments[2]) + " kg m^2";
}

}  // namespace

std::array<double, 3> principal_moments(const Mat3& inertia)
{
    // Cyclic Jacobi method: small eigenvalues keep their relative accuracy (Demmel, Veselic 1992), which a rod needs. It converges
    // quadratically; 3x3 matrices take about five sweeps.
    Mat3 a = inertia;
    for (int sweep = 0; sweep < 30 && !is_diagonal(a); ++sweep)
    {
        jacobi_rotate(a, 0, 1);
        jacobi_rotate(a, 0, 2);
        jacobi_rotate(a, 1, 2);
    }
    std::array<double, 3> moments{a(0, 0), a(1, 1), a(2, 2)};
    std::sort(moments.begin(), moments.end());
    return moments;
}

Result<void> check_inertia(const Mat3& inertia)
{
    if (!is_finite(inertia)) return reason("inertia must be finite");
    if (!is_symmetric(inertia)) return reason("inertia must be symmetric");
    const auto moments = principal_moments(inertia);
    const std::string text = "; its principal moments are " + moments_text(moments);
    if (!(moments[0] > 0)) return reason("inertia must be positive" + text);
    if (moments[0] + moments[1] < moments[2] * (1 - kTriangleTolerance))
        return reason(
            "inertia violates the triangle inequality: the two smaller moments must add up to the largest or "
            "more" +
            text);
    if (!is_diagonal(inertia) && moments[2] > kMostCondition * moments[0])
        return reason("inertia cannot be inverted: its moments must lie within a factor of 1e15" + text);
    if (!(moments[0] >= kLeastGiven && moments[2] <= kLargestGiven) || !is_finite(inverse_inertia(inertia)))
        return reason("inertia is too small or too large to be inverted" + text);
    return {};
}

Mat3 inverse_inertia(const Mat3& inertia)
{
    if (is_diagonal(inertia)) return Mat3::diagonal(1 / inertia(0, 0), 1 / inertia(1, 1), 1 / inertia(2, 2));
    return inverse(inertia);
}

MassProperties combined(const MassProperties& sum, const MassProperties& part)
{
    // With C the common centre and d = c_part - c_sum:
    //   c = c_sum + d m_part/m,   I = I_sum + I_part + (m_sum m_part / m) (d.d 1 - d d^T).
    if (sum.mass == 0) return part;
    const double mass = sum.mass + part.mass;
    const Vec3 d = part.center - sum.center;
    const double dd = length_squared(d);
    const Mat3 apart = (Mat3::diagonal(dd, dd, dd) - outer(d, d)) * (sum.mass * (part.mass / mass));
    return {mass, sum.center + d * (part.mass / mass), sum.inertia + part.inertia + apart};
}

MassProperties scaled(const MassProperties& solid, double factor) { return {solid.mass * factor, solid.center, solid.inertia * factor}; }

}  // namespace plab::bodies
