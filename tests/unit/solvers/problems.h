/// Problems with known answers that several solvers are tried on.
#pragma once

#include "unit/solvers/systems.h"

namespace plab::test
{

/// q'' = -q + cos(2 t)/2 from rest at 1.
inline Points driven_oscillator()
{
    return Points({1}, {0}, [](double t, const auto& q, const auto&, auto& a) { a[0] = -q[0] + 0.5 * std::cos(2 * t); });
}
inline double driven_place(double t) { return std::cos(t) - (std::cos(2 * t) - std::cos(t)) / 6; }

/// q'' = -g + c v^2 (falling, quadratic drag c |v| v of mass 1): v = -v_t tanh(g t / v_t).
inline Points falling_with_drag()
{
    return Points({0}, {0}, [](double, const auto&, const auto& v, auto& a) { a[0] = -9.81 - 0.01 * std::fabs(v[0]) * v[0]; });
}
inline constexpr double kDragSpeedAt5 = -28.7023194557054083, kDragPlaceAt5 = -91.5600402510837169;

/// m = 1 on a spring k with the damping ratio zeta, from rest at 1.
inline Points damped_spring(double k, double zeta)
{
    const double c = 2 * zeta * std::sqrt(k);
    return Points({1}, {0}, [k, c](double, const auto& q, const auto& v, auto& a) { a[0] = -k * q[0] - c * v[0]; });
}
inline double damped_place(double k, double zeta, double t)
{
    const double w = std::sqrt(k), root = std::sqrt(1 - zeta * zeta);
    return std::exp(-zeta * w * t) * (std::cos(w * root * t) + zeta / root * std::sin(w * root * t));
}

/// A planet on an ellipse of eccentricity 0.9 and semi-axis 1 about a sun of strength 1, from the near end.
inline Points planet()
{
    return Points({0.1, 0}, {0, std::sqrt(1.9 / 0.1)},
                  [](double, const auto& q, const auto&, auto& a)
                  {
                      const double r2 = q[0] * q[0] + q[1] * q[1], r3 = r2 * std::sqrt(r2);
                      a[0] = -q[0] / r3, a[1] = -q[1] / r3;
                  });
}
/// At t = 10, from Kepler's equation in 30 digits.
inline constexpr double kPlanetAt10[2] = {-1.8538537094055792, -0.130885404839925551};

/// A solid box, half extents 0.1, 0.2, 0.3, 1 kg. References: Jacobi elliptic functions in extended precision, checked
/// against an extrapolation method in quadruple precision.
inline const Vec3 kBoxInertia{0.13 / 3, 0.10 / 3, 0.05 / 3};
inline const Vec3 kBoxSpin{1, 2, 3};
inline const Quat kBoxAt5{-0.36486374298686260041, 0.02356335734258868336, 0.02126200105200739735, -0.93051982491273477482};
inline const Vec3 kBoxSpinAt5{0.28086194081460047257, -2.4322669397127980927, 2.7501014800339831926};
inline const Quat kBoxAt100{-0.25530488095953154536, -0.51834919319232768729, -0.09806435894574611863, -0.81025731294426601932};
inline const Vec3 kBoxSpinAt100{1.3720842116810150604, -1.4711086382031171752, 3.2213164282561760733};

}  // namespace plab::test
