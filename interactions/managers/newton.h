/// The contact law of a whole island at once, exactly: semismooth Newton on the law's fixed point equation.
///
/// With tau = j - rho (u - least) and P the law's projection (tau_n to >= 0, then tau_t to the disc mu P_n: Coulomb's
/// cone itself, no polyhedron and no convex stand-in), the law reads j = P(tau). One step solves
///
///   (M + J^T G J) dv = J^T (P(tau) - j),    dj = P(tau) - j - G J dv,    G = rho P'(tau)
///
/// over the movers' 6-vectors: a matrix of blocks over the graph of who touches whom, so stacks cost O(n), and masses
/// are added, never subtracted from one another: ratios of 1e8 keep their digits. rho is kappa / K of each point. What
/// contacts share without being told how (a table with four legs) is split as it was in the guess, and equally where
/// there was none: of all solutions the one nearest to the guess, in the norm that 1/rho weighs.
/// Sources: Alart, Curnier, CMAME 92 (1991), eq. 3.6; Rockafellar (1976) for the proximal term; Acary, Bourrich,
/// Siconos (2018), section 5, for Newton's method on it.
#pragma once

#include "lagrangian.h"
#include "sequential.h"

namespace plab::managers
{

struct Solving
{
    double tolerance = 1e-12;  ///< m/s
    int most_steps = 80;       ///< Newton steps, of both kinds
    int most_sweeps = 100;     ///< Gauss-Seidel where Newton's method does not get there
    double finest = 1e-12;     ///< m/s: what was asked for; rounding may raise `tolerance`
};
struct Solved
{
    int steps = 0, sweeps = 0;
    double residual = 0;  ///< m/s, see violation()
    bool converged = false;
    bool fell_back = false;  ///< sweeps had to finish
};

class NewtonSolver
{
public:
    /// From the present impulses to the law's; movers' speeds agree with them before and afterwards.
    Solved solve(Problem& problem, const Solving& how);

private:
    struct Law
    {
        Vec3 change;  ///< P(tau) - j
        Mat3 G;       ///< contact coordinates
    };
    struct LineLaw
    {
        double change = 0, G = 0;
    };
    bool find_step(const Problem& problem, double kappa);
    void go(Problem& problem, double share);
    double advance(Problem& problem, double now);
    bool newton(Problem& problem, const Solving& how, Solved& out);
    void polish(Problem& problem, double best, double kappa, const Solving& how, Solved& out);
    void approach(Problem& problem, const Solving& how, Solved& out);
    bool settles_by_sweeps(Problem& problem, double guess, const Solving& how, Solved& out);
    void finish_by_sweeps(Problem& problem, const Solving& how, Solved& out);
    void remember(const Problem& problem);
    void recall(Problem& problem) const;

    IslandMatrix matrix_;
    Lagrangian lagrangian_;
    std::vector<Law> laws_;
    std::vector<LineLaw> line_laws_;
    std::vector<Column6> step_;
    std::vector<Vec3> point_steps_, best_points_, guess_points_;
    std::vector<double> line_steps_, best_lines_, guess_lines_;
};

}  // namespace plab::managers
