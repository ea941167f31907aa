#include "inertia.h"

#include <algorithm>

#include "plab/symmetric.h"

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

std::string moments_text(const std::array<double, 3>& moments)
{
    return number_text(moments[0]) + ", " + number_text(moments[1]) + ", " + number_text(moments[2]) + " kg m^2";
}

}  // namespace

std::array<double, 3> principal_moments(const Mat3& inertia)
{
    const Vec3 values = symmetric_axes(inertia).values;
    std::array<double, 3> moments{values.x, values.y, values.z};
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
