/// Torque-free rotation of a rigid body in its principal frame, in closed form for any time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "plab/dynamics.h"
#include "plab/elliptic.h"
#include "plab/rotation.h"
#include "plab/symmetric.h"

namespace plab
{

/// Principal frame P of a body: the columns of `axes` are its axes in B.
struct PrincipalAxes
{
    Mat3 axes;        ///< R_BP, a proper rotation
    Vec3 moment;      ///< kg m^2, in no particular order unless sorted
    Vec3 reciprocal;  ///< 1/(kg m^2)
};

/// Computed by Jacobi rotations (plab/symmetric.h), which costs nothing if the body's frame is principal already. The small moments of a
/// needle are taken from the inverse inertia, which has them to full precision.
PrincipalAxes principal_axes(const RigidMember& member);
/// The same frame with its axes in the order of ascending moments.
PrincipalAxes ascending(const PrincipalAxes& body);

/// Free rotation that starts with the angular momentum m in P.
///
/// The solution of Euler's equations m' = m x w, w_i = m_i / I_i in Jacobi's elliptic functions, by their addition theorem. It is written
/// without dividing by an amplitude, so spheres, symmetric tops, rotations about an axis and the separatrix are not special cases. With a
/// > b > c the reciprocal moments, and for a motion that circles axis a:
///   l^2 = (a-b) (a-c) m_a^2 + (a-b) (b-c) m_b^2,   l^2 k'^2 = (a-c) ((a-b) m_a^2 - (b-c) m_c^2),   s = sn(l t) / l,
///   m_b(t) = (m_b cn dn + (a-c) m_a m_c s) / D,    D = cn^2 + (a-b) (a-c) m_a^2 s^2,
///   m_c(t) = (m_c cn - (a-b) m_a m_b s dn) / D,    m_a(t) = (m_a dn - (b-c) m_b m_c s cn) / D.
/// The attitude is composed of the shortest rotations p(m) that take m to the circled axis, and a twist about that axis between them,
///   Q(t) = p(m(0))^-1 twist(psi) p(m(t)),   psi' = (2 T + |L| w_a) / (|L| + m_a).
/// The integrand psi' is analytic in a strip about the real axis of half width pi/2 or more (in l t), so Gaussian quadrature is exact to
/// rounding with few nodes; whole periods use the trapezoidal rule.
/// Sources: Jacobi, Crelle 39 (1849); van Zon, Schofield, J. Comput. Phys. 225 (2007) 145; Celledoni, Fasso, Saefstroem, Zanna, SIAM J.
/// Sci. Comput. 30 (2008) 2084 (the rotation as two charts and one angle).
class FreeTop
{
public:
    /// m in N m s.
    FreeTop(const PrincipalAxes& body, const Vec3& m);

    /// Angular momentum in P after t seconds, N m s.
    Vec3 momentum(double t) const { return direction_at(t) * size_; }
    /// The rotation that takes vectors in P at time t to P at time 0.
    Quat turn(double t) const;

private:
    struct Values
    {
        double s, cn, dn;
        double inverse_divisor;               ///< 1 / D
        bool small;                           ///< a small part of a revolution: the differences below are used
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

/// Whether the body turns by so little in t seconds that slow_turn() is exact to rounding: |L| t / I_min at most 2^-11. A body near rest
/// does.
inline bool turns_slowly(const Mat3& inverse_inertia_B, const Vec3& m, double t)
{
    const double most = inverse_inertia_B(0, 0) + inverse_inertia_B(1, 1) + inverse_inertia_B(2, 2);  // at least 1 / I_min
    const double bound = most * t;
    return length_squared(m) * (bound * bound) <= 0x1p-22;
}

/// FreeTop::turn() in B for a slow rotation, at a tenth of the cost: the Taylor series of the rotation vector up to t^4. With w_k the k-th
/// derivative of the angular velocity, from Euler's equations, Bortz's equation gives
///   f(t) = t w_0 + t^2/2 w_1 + t^3/6 (w_2 + w_0 x w_1 / 2) + t^4/24 (w_3 + w_0 x w_2) + O(t^5).
/// Source: Bortz, IEEE Trans. Aerosp. Electron. Syst. 7 (1971) 61.
inline Quat slow_turn(const Mat3& inverse_inertia_B, const Vec3& m, double t)
{
    const Vec3 w0 = inverse_inertia_B * m, m1 = cross(m, w0);
    const Vec3 w1 = inverse_inertia_B * m1, m2 = cross(m1, w0) + cross(m, w1);
    const Vec3 w2 = inverse_inertia_B * m2, m3 = cross(m2, w0) + 2 * cross(m1, w1) + cross(m, w2);
    const Vec3 w3 = inverse_inertia_B * m3;
    const Vec3 third = w2 + 0.5 * cross(w0, w1), fourth = w3 + cross(w0, w2);
    return exp_rotation(t * (w0 + (0.5 * t) * (w1 + (t / 3) * (third + (0.25 * t) * fourth))));
}

namespace free_rotation
{

inline double off_diagonal(const Mat3& a) { return std::fabs(a(0, 1)) + std::fabs(a(0, 2)) + std::fabs(a(1, 2)); }

inline Vec3 column(const Mat3& a, int j) { return {a(0, j), a(1, j), a(2, j)}; }

struct GaussRule
{
    std::span<const double> node, weight;  ///< the positive half, on [-1, 1]
};

// Gauss-Legendre, Abramowitz and Stegun, table 25.4.
inline constexpr std::array<double, 2> kNode4{0.339981043584856264802666, 0.861136311594052575223946};
inline constexpr std::array<double, 2> kWeight4{0.652145154862546142626936, 0.347854845137453857373064};
inline constexpr std::array<double, 3> kNode6{0.238619186083196908630502, 0.661209386466264513661400, 0.932469514203152027812302};
inline constexpr std::array<double, 3> kWeight6{0.467913934572691047389870, 0.360761573048138607569834, 0.171324492379170345040296};
inline constexpr std::array<double, 5> kNode10{0.148874338981631210884826, 0.433395394129247190799266, 0.679409568299024406234327,
                                               0.865063366688984510732097, 0.973906528517171720077964};
inline constexpr std::array<double, 5> kWeight10{0.295524224714752870173815, 0.269266719309996355091227, 0.219086362515982043995535,
                                                 0.149451349150580593145863, 0.066671344308688137593569};

/// The rule for an interval of the given length in l t: the error decreases as rho^-2n, with rho from the ellipse through pi/2 i.
inline GaussRule rule_for(double length)
{
    if (length <= 0.05) return {kNode4, kWeight4};
    if (length <= 0.25) return {kNode6, kWeight6};
    return {kNode10, kWeight10};
}

}  // namespace free_rotation

inline PrincipalAxes principal_axes(const RigidMember& member)
{
    const SymmetricAxes found = symmetric_axes(member.inertia_B);
    const Vec3& a = found.values;
    PrincipalAxes out;
    out.axes = found.axes;
    if (free_rotation::off_diagonal(member.inertia_B) == 0)
    {
        out.moment = a;
        for (int i = 0; i < 3; ++i) out.reciprocal[i] = member.inverse_inertia_B(i, i);
        return out;
    }
    const double largest = std::max({a.x, a.y, a.z}), smallest = std::min({a.x, a.y, a.z});
    for (int i = 0; i < 3; ++i)
    {
        const Vec3 e = free_rotation::column(out.axes, i);
        const bool small = a[i] * a[i] < largest * std::fabs(smallest);
        out.reciprocal[i] = small ? dot(e, member.inverse_inertia_B * e) : 1 / dot(e, member.inertia_B * e);
        out.moment[i] = 1 / out.reciprocal[i];
    }
    return out;
}

inline PrincipalAxes ascending(const PrincipalAxes& body)
{
    std::array<int, 3> order{0, 1, 2};
    bool even = true;
    for (const auto& [p, q] : {std::pair<std::size_t, std::size_t>{0, 1}, {1, 2}, {0, 1}})
        if (body.moment[order[q]] < body.moment[order[p]]) std::swap(order[p], order[q]), even = !even;
    PrincipalAxes out;
    for (int k = 0; k < 3; ++k)
    {
        const int i = order[static_cast<std::size_t>(k)];
        const double sign = k == 2 && !even ? -1 : 1;
        for (int r = 0; r < 3; ++r) out.axes(r, k) = sign * body.axes(r, i);
        out.moment[k] = body.moment[i], out.reciprocal[k] = body.reciprocal[i];
    }
    return out;
}

inline FreeTop::FreeTop(const PrincipalAxes& body, const Vec3& m)
{
    // The motion depends only on the direction of m and on the rates |L| / I. With this scaling nothing overflows or underflows.
    const double largest = std::max({std::fabs(m.x), std::fabs(m.y), std::fabs(m.z)});
    if (!(largest > 0)) return;
    const Vec3 scaled = m / largest;
    size_ = largest * length(scaled);
    n_ = scaled / length(scaled);
    rate_ = body.reciprocal * size_;
    int a = 0, b = 1, c = 2;
    double order = 1;
    const auto sort = [&](int& p, int& q)
    {
        if (rate_[p] < rate_[q]) std::swap(p, q), order = -order;
    };
    sort(a, b), sort(b, c), sort(a, b);
    const double ab = rate_[a] - rate_[b], bc = rate_[b] - rate_[c], ac = rate_[a] - rate_[c];
    const double fast = std::sqrt(ab) * std::fabs(n_[a]), slow = std::sqrt(bc) * std::fabs(n_[c]);
    const bool circles_fast = fast >= slow;
    circled_ = circles_fast ? a : c, middle_ = b, other_ = circles_fast ? c : a;
    const double near = circles_fast ? ab : bc, far = circles_fast ? bc : ab;  // gaps of the middle axis to both sides
    const double axial = n_[circled_];
    const double lambda2 = near * ac * axial * axial + near * far * n_[b] * n_[b];
    lambda_ = std::sqrt(lambda2);
    const double complement = lambda2 > 0 ? ac * std::fabs(fast - slow) * (fast + slow) / lambda2 : 1;
    modulus_ = EllipticModulus(complement);
    to_middle_ = order * ac, to_other_ = -order * near, to_circled_ = -order * far;
    divisor_ = near * ac * axial * axial;
    sign_ = axial < 0 ? -1 : 1;
    twice_energy_ = rate_.x * n_.x * n_.x + rate_.y * n_.y * n_.y + rate_.z * n_.z * n_.z;
    const double k2_lambda2 = far * (ac * n_[other_] * n_[other_] + near * n_[b] * n_[b]);
    steady_ = !(k2_lambda2 > 1e-18 * lambda2);
}

// For a small part of a revolution the new components are computed as the old ones plus differences. The rounding errors of sn, cn, dn
// are the same in each step of a run, and would accumulate in one direction if they were not multiplied by something small. For a large
// part D may be small and must not be computed as a difference.
inline FreeTop::Values FreeTop::values_at(double t) const
{
    const double u = lambda_ * t;
    const bool tiny = std::fabs(u) < 1e-150;
    const JacobiValues j = tiny ? JacobiValues{} : modulus_.at(u);
    const double s = tiny ? t : j.sn / lambda_, square = divisor_ * s * s;
    const double c = j.cn_defect, d = j.dn_defect;
    Values v{};
    v.s = s, v.cn = j.cn, v.dn = j.dn, v.small = std::fabs(u) < 0.3;
    const double excess = c * (c - 2) + square;  // D - 1
    v.inverse_divisor = 1 / (v.small ? 1 + excess : j.cn * j.cn + square);
    v.cn_lack = excess + c, v.dn_lack = excess + d, v.cn_dn_lack = excess + c + d - c * d;
    return v;
}

inline double FreeTop::axial_at(double t) const
{
    const Values v = values_at(t);
    return v.component(n_[circled_], v.dn, v.dn_lack, to_circled_ * n_[middle_] * n_[other_] * v.s * v.cn);
}

inline Vec3 FreeTop::direction_at(double t) const
{
    if (size_ == 0) return {};
    const Values v = values_at(t);
    const double a = n_[circled_], b = n_[middle_], c = n_[other_];
    Vec3 out;
    out[circled_] = v.component(a, v.dn, v.dn_lack, to_circled_ * b * c * v.s * v.cn);
    out[middle_] = v.component(b, v.cn * v.dn, v.cn_dn_lack, to_middle_ * a * c * v.s);
    out[other_] = v.component(c, v.cn, v.cn_lack, to_other_ * a * b * v.s * v.dn);
    return out;
}

inline double FreeTop::twist_rate(double t) const
{
    const double axial = sign_ * axial_at(t);
    return (twice_energy_ + rate_[circled_] * axial) / (1 + axial);
}

inline double FreeTop::twist_over(double begin, double end) const
{
    const double length = lambda_ * (end - begin);
    const int panels = std::max(1, static_cast<int>(std::ceil(std::min(length, 1e3))));
    const free_rotation::GaussRule rule = free_rotation::rule_for(length / panels);
    const double half = 0.5 * (end - begin) / panels;
    double sum = 0;
    for (int p = 0; p < panels; ++p)
    {
        const double middle = begin + (2 * p + 1) * half;
        for (std::size_t i = 0; i < rule.node.size(); ++i)
        {
            const double d = half * rule.node[i];
            sum += half * rule.weight[i] * (twist_rate(middle - d) + twist_rate(middle + d));
        }
    }
    return sum;
}

inline double FreeTop::twist(double t) const
{
    if (steady_) return twist_rate(0) * t;
    const double period = 2 * modulus_.quarter_period() / lambda_;
    const double periods = std::isfinite(period) ? std::floor(std::fabs(t) / period) : 0.0;
    const double rest = periods > 0 ? std::fabs(t) - periods * period : std::fabs(t);
    double whole = 0;
    if (periods > 0)
    {
        const int points = 8 + static_cast<int>(8.2 * modulus_.quarter_period());
        for (int i = 0; i < points; ++i) whole += twist_rate(period * i / points);
        whole *= periods * (period / points);
    }
    return t < 0 ? -whole - twist_over(-rest, 0) : whole + twist_over(0, rest);
}

inline Quat FreeTop::swing(const Vec3& n) const
{
    Vec3 axis;
    axis[circled_] = sign_;
    const Vec3 v = cross(n, axis);
    return normalized(Quat{1 + sign_ * n[circled_], v.x, v.y, v.z});
}

inline Quat FreeTop::turn(double t) const
{
    if (size_ == 0) return {};
    const double half = 0.5 * twist(t);
    Vec3 v;
    v[circled_] = sign_ * std::sin(half);
    const Quat about{std::cos(half), v.x, v.y, v.z};
    return normalized(conjugate(swing(n_)) * about * swing(direction_at(t)));
}

}  // namespace plab
