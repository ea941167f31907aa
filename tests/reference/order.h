/// The order of a method on a path that is known: errors at a step of h and of 2 h.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <string>

#include "support/scene.h"
#include "support/text.h"

namespace plab::test
{

/// y' = rates(y) during `duration` (s), by Runge and Kutta's method in 20,000 steps.
template <std::size_t N, class Rates>
std::array<double, N> integrate_all(std::array<double, N> y, double duration, const Rates& rates)
{
    constexpr int kSteps = 20000;
    const double h = duration / kSteps;
    const auto ahead = [](const std::array<double, N>& from, double by, const std::array<double, N>& rate)
    {
        std::array<double, N> out = from;
        for (std::size_t i = 0; i < N; ++i) out[i] += by * rate[i];
        return out;
    };
    for (int i = 0; i < kSteps; ++i)
    {
        const std::array<double, N> k1 = rates(y), k2 = rates(ahead(y, 0.5 * h, k1)), k3 = rates(ahead(y, 0.5 * h, k2)),
                                    k4 = rates(ahead(y, h, k3));
        for (std::size_t n = 0; n < N; ++n) y[n] += h / 6 * (k1[n] + 2 * k2[n] + 2 * k3[n] + k4[n]);
    }
    return y;
}

/// x'' = acceleration(x, x') from x0, v0 during `duration`.
inline std::array<double, 2> integrate(double x, double v, double duration, const std::function<double(double, double)>& acceleration)
{
    return integrate_all(std::array{x, v}, duration,
                         [&](const std::array<double, 2>& y) {
                             return std::array{y[1], acceleration(y[0], y[1])};
                         });
}

/// A position as a function of the time.
using Path = std::function<Vec3(double)>;

/// m: how far the body "body" is from its path, the most at 8 instants until the end.
inline double error(const std::string& scene, double h, double end, const Path& path)
{
    Scene s(scene, "dt='" + text(h) + "'");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    double most = 0;
    for (int k = 1; k <= 8; ++k)
    {
        s.run(end * k / 8);
        most = std::max(most, length(s.vec("body", "position") - path(s.simulation().time())));
    }
    return most;
}

/// The error at a step of h, and that the one at 2 h is at least three times as large.
inline void check_order(const std::string& name, const std::string& scene, double h, double end, const Path& path, double most)
{
    const double coarse = error(scene, 2 * h, end, path), fine = error(scene, h, end, path);
    MESSAGE(name << ": " << coarse << " m at " << 2 * h << " s, " << fine << " m at " << h << " s");
    CHECK(fine < most);
    CHECK(coarse > 3 * fine);
}

}  // namespace plab::test
