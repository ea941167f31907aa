/// Solves the contact law of a whole island exactly: a semismooth Newton method on the law's fixed-point equation.
///
/// Let tau = j - rho (u - least), and let P be the projection of the law: tau_n is clamped to >= 0, then tau_t is projected onto
/// the disc of radius mu P_n. This is Coulomb's cone itself, neither a polyhedral nor a convexified approximation. The contact
/// law is then equivalent to j = P(tau). P is only piecewise smooth: its pieces are the states separated, sticking and sliding.
/// A semismooth Newton method linearises the piece in which each point currently is. One step solves
///
///   (M + J^T G J) dv = J^T (P(tau) - j),    dj = P(tau) - j - G J dv,    G = rho P'(tau)
///
/// over the 6-vectors of the movers. The matrix (island_matrix.h) has the sparsity of the contact graph, so a stack costs O(n).
/// Masses are added and never subtracted from one another, so mass ratios of 1e8 keep their digits. rho is kappa / K of each
/// point.
///
/// How contacts share a load may be undetermined (a table with four legs). The term in rho then acts as a proximal
/// regularisation and picks, of all solutions, the one nearest to the initial guess in the norm weighted by 1/rho: the split
/// stays as it was, and is equal where there was no guess.
///
/// Rows that contradict one another have no solution: the proximal term then leads to the least violation in the same norm, with
/// impulses that grow from step to step. newton() ends where a larger stiffness gains nothing.
///
/// Many joints are solved in the impulses of contacts alone (delassus.h), as are fewer where (3) and (4) end without a solution. Otherwise:
/// Newton's method converges only near a solution. solve() therefore takes the cheapest method that works: (1) nothing, if the
/// last impulses still satisfy the law; (2) some sweeps, for a large island that has only drifted by rounding; (3) Newton's
/// method from the last impulses, and for mechanisms also from none (README, "For mechanisms"); (4) rounds of the augmented Lagrangian
/// (lagrangian.h), each followed by Newton's method; (5) Gauss-Seidel sweeps alternating with Newton's method, reported as
/// `fell_back`. Sweeps would let a chain of light links under a heavy load stretch, so the joints are then solved exactly, with the
/// impulses of all others as they are: contacts may be left violated, joints that do not contradict one another are not.
/// Sources: Alart, Curnier, CMAME 92 (1991), eq. 3.6; Rockafellar (1976) for the proximal term; Acary, Bourrich, Siconos (2018),
/// section 5, for the Newton method applied to it.
#pragma once

#include <cstdint>

#include "contact_law.h"
#include "delassus.h"
#include "joint_solver.h"
#include "lagrangian.h"
#include "sequential.h"

namespace plab::managers
{

struct Solving
{
    double tolerance = 1e-12;  ///< m/s
    int most_steps = 80;       ///< Newton steps, those of the augmented Lagrangian included
    int most_sweeps = 100;     ///< Gauss-Seidel sweeps where Newton's method does not converge
    double finest = 1e-12;     ///< m/s: the tolerance that was asked for; rounding may raise `tolerance`
    int rounds = 4;            ///< of sweeps, each followed by Newton's method; 0: the impulses are left where Newton's method ends
    /// m/s: the violation that is left where Newton's method gets no further: points that barely press open and close, and rows may
    /// contradict one another by rounding, as where both feet of a mechanism stand.
    double enough = 0;
    /// m/s: the violation up to which a solution that shares loads evenly is taken, where Newton's method finds none that is exact.
    double close = 0;
    double locked = 1e-11;                 ///< DelassusSolver::Bounds
    std::size_t most_products = SIZE_MAX;  ///< of blocks, in all factorisations: about 0.1 us each
};
struct Solved
{
    int steps = 0, sweeps = 0;
    double residual = 0;  ///< m/s, see violation()
    bool ended = false;   ///< nothing more was tried: converged, or close enough
    bool converged = false;
    bool fell_back = false;  ///< Gauss-Seidel sweeps were needed
};

class NewtonSolver
{
public:
    /// Changes the present impulses to those of the contact law. The velocities of the movers agree with the impulses before and
    /// afterwards.
    Solved solve(Problem& problem, const Solving& how);

private:
    bool find_step(const Problem& problem, double kappa);
    void go(Problem& problem, double share);
    double advance(Problem& problem, double now);
    /// Whether a point or row is in another piece of the law than when this was last asked.
    bool changes_pieces(const Problem& problem);
    bool newton(Problem& problem, const Solving& how, Solved& out);
    bool solve_mechanism(Problem& problem, const Solving& how, bool or_nothing, Solved& out);
    void polish(Problem& problem, double best, double kappa, const Solving& how, Solved& out);
    void keep_guess(const Problem& problem);
    void recall_guess(Problem& problem);
    bool hold_joints(Problem& problem, double tolerance);
    bool start_anew(Problem& problem, const Solving& how, Solved& out);
    void approach(Problem& problem, const Solving& how, Solved& out);
    bool settles_by_sweeps(Problem& problem, double guess, const Solving& how, Solved& out);
    void finish_by_sweeps(Problem& problem, const Solving& how, Solved& out);
    void remember(const Problem& problem);
    void recall(Problem& problem) const;

    IslandMatrix matrix_;
    JointSolver joints_;
    DelassusSolver mechanism_;
    Lagrangian lagrangian_;
    std::vector<PointLaw> laws_;
    std::vector<LineLaw> line_laws_;
    std::vector<Column6> step_;
    std::vector<char> pieces_;
    std::vector<Vec3> point_steps_, best_points_, guess_points_;
    std::vector<double> line_steps_, best_lines_, guess_lines_;
};

}  // namespace plab::managers
