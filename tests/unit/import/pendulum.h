/// A compound pendulum and its period.
#pragma once

#include <numbers>
#include <tuple>
#include <vector>

#include "support/scene.h"

namespace plab::test
{

/// Complete elliptic integral of the first kind by the arithmetic-geometric mean.
inline double elliptic_k(double k)
{
    double a = 1, b = std::sqrt(1 - k * k);
    while (std::fabs(a - b) > 1e-15) std::tie(a, b) = std::pair((a + b) / 2, std::sqrt(a * b));
    return std::numbers::pi / (2 * a);
}

/// Twice the time between the first two passages of x = 0, each by the tangent of the step that passes.
inline double period_of(Scene& scene, const std::string& body)
{
    std::vector<double> passages;
    const auto angle = [&]
    {
        const Vec3 r = rotate(scene.quat(body, "orientation"), {0, 0, -1});
        return std::atan2(r.x, -r.z);
    };
    for (double before = angle(); passages.size() < 2 && scene.simulation().time() < 10;)
    {
        scene.step();
        const double now = angle(), rate = -scene.vec(body, "angular_velocity").y;
        if (before * now < 0) passages.push_back(scene.simulation().time() - now / rate);
        before = now;
    }
    REQUIRE(passages.size() == 2);
    return 2 * (passages[1] - passages[0]);
}

/// A compound pendulum: m = 2 kg, centre 0.5 m below the hinge, I = 0.1 kg m^2 about y; released at 1 rad.
inline double expected_period()
{
    const double m = 2, l = 0.5, J = 0.1 + m * l * l;
    return 4 * std::sqrt(J / (m * 9.81 * l)) * elliptic_k(std::sin(0.5));
}

}  // namespace plab::test
