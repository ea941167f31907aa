/// References of the cases, each in closed form or in extended precision.
#pragma once

#include <array>
#include <vector>

#include "plab/vector.h"

namespace plab::peers
{

/// Torque-free rotation from attitude 1, by the classical Runge-Kutta method in long double with steps of 2e-5 s: its own
/// error is below 1e-15 rad in 20 s for spins of a few rad/s, as halving the step shows (bench_peers --check).
///   I w' = (I w) x w,   q' = q (0, w) / 2,   w in the body.
class FreeRotation
{
public:
    FreeRotation(const Vec3& inertia, const Vec3& spin, double duration, int steps_per_second = 50000);
    /// q_WB at any time up to the duration.
    Quat attitude(double t) const;

private:
    using State = std::array<long double, 7>;  ///< w (3), q (4)
    State rates(const State& y) const;
    State advanced(const State& y, long double h) const;

    static constexpr int kKept = 100;  ///< states per second that are kept
    std::array<long double, 3> inertia_;
    std::vector<State> kept_;
};

/// Height of a ball dropped from rest at height `drop` above its contact, elastic, about that contact. m, s.
double bouncing_height(double drop, double g, double t);

/// x'' = -(k/m) x - (c/m) x' from x0 at rest, underdamped.
double damped_oscillation(double mass, double stiffness, double damping, double x0, double t);

}  // namespace plab::peers
