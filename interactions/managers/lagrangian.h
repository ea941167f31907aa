/// An augmented Lagrangian method in the movers' velocities. From any starting point it gets close enough to a solution of the
/// contact law for Newton's method (newton.h), which converges only locally, to finish.
///
///   v = argmin 1/2 |v - v0|_M^2 + sum of |P(tau)|^2 / 2 rho,    tau = j - rho (u - least + mu s n)
///
/// P projects onto the friction cone |j_t| <= mu j_n, and s = |u_t| is the slip speed of the previous round. With s fixed, the
/// function to be minimised is convex and smooth, so Newton's method with a line search converges from anywhere. Then the
/// impulses are updated, j = P(tau), the slip speeds too, s = |u_t|, and the next round begins.
///
/// Why the term mu s n: without it the minimum obeys an associated flow rule. A sliding contact would then separate at the speed
/// mu |u_t| instead of sliding along the surface. The shift by mu s cancels exactly that separation. At a fixed point of the
/// rounds the solution therefore satisfies Coulomb's law itself.
/// Sources: Rockafellar, SIAM J. Control 12 (1974); De Saxce, Feng (1998) and Acary, Cadoux, Lemarechal, Malick (2011) for the
/// shift; Castro et al., IEEE T-RO 38 (2022), for Newton's method in velocities with line search.
#pragma once

#include <algorithm>
#include <cmath>

#include "island_matrix.h"

namespace plab::managers
{

/// The step length t in (0, 1] that minimises a convex function along a step: false position on its slope, which increases with t and is
/// `at_zero` < 0 at 0.
template <class Slope>
double least_along(const Slope& slope, double at_zero)
{
    constexpr int kTrials = 12;
    constexpr double kFlat = 0.05;
    double low = 0, high = 1, f_low = at_zero, f_high = slope(1.0);
    if (!(f_high > kFlat * std::fabs(at_zero))) return 1;
    for (int i = 0; i < kTrials; ++i)
    {
        const double guess = low - f_low * (high - low) / (f_high - f_low);
        const double t = std::clamp(guess, low + 0.05 * (high - low), high - 0.05 * (high - low));
        const double f = slope(t);
        if (std::fabs(f) <= kFlat * std::fabs(at_zero)) return t;
        if (f < 0)
            low = t, f_low = f, f_high *= 0.7;
        else
            high = t, f_high = f, f_low *= 0.7;
    }
    return low > 0 ? low : high;
}

class Lagrangian
{
public:
    /// One outer round from the present impulses; rho is kappa / K_nn. `matrix` must have the pattern of the problem already.
    /// With `from_welded` the round starts from the solution in which all contacts stick. Adds the Newton steps taken to
    /// `steps`; returns false if the minimisation did not converge.
    bool round(Problem& problem, IslandMatrix& matrix, double kappa, bool from_welded, double tolerance, int& steps);

private:
    struct Held
    {
        Vec3 impulse;  ///< P(tau)
        Mat3 G;
    };
    void start(const Problem& problem, double kappa);
    Vec3 tau_of(const Problem& problem, std::size_t i, const Vec3& u) const;
    Vec3 project(const Problem& problem, std::size_t i, const Vec3& tau, Mat3* G) const;
    double project_line(const Line& line, double tau, double rho, double* g) const;
    double gradient(const Problem& problem, IslandMatrix* matrix);
    void weld(Problem& problem, IslandMatrix& matrix);
    double slope(const Problem& problem, double t);
    void move(Problem& problem, double t);
    void take_impulses(Problem& problem);

    std::vector<double> rho_, bias_, line_rho_;
    std::vector<Vec3> velocities_, velocity_steps_;  // at the present v, and their change along the step
    std::vector<double> gaps_, rate_steps_;
    std::vector<Column6> step_, force_;
};

}  // namespace plab::managers
