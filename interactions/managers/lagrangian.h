/// From any start to the neighbourhood of the contact law: an augmented Lagrangian in the movers' speeds.
///
///   v = argmin 1/2 |v - v0|_M^2 + sum of |P(tau)|^2 / 2 rho,    tau = j - rho (u - least + mu s n)
///
/// with P onto the cone |j_t| <= mu j_n and s = |u_t| of the round before: convex and smooth, so Newton's method with a
/// line search gets there from anywhere. Then j = P(tau), s = |u_t|, and again; where that stands still the shift mu s
/// has made Coulomb's law of the convex one.
/// Sources: Rockafellar, SIAM J. Control 12 (1974); De Saxce, Feng (1998) and Acary, Cadoux, Lemarechal, Malick (2011)
/// for the shift; Castro et al., IEEE T-RO 38 (2022), for Newton's method in speeds with line search.
#pragma once

#include "island_matrix.h"

namespace plab::managers
{

class Lagrangian
{
public:
    /// One outer round from the present impulses; `matrix` holds the problem's graph already. Adds its Newton steps to
    /// `steps`; false if they did not suffice.
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
    double search(const Problem& problem, double at_zero);
    void move(Problem& problem, double t);
    void take_impulses(Problem& problem);

    std::vector<double> rho_, bias_, line_rho_;
    std::vector<Vec3> velocities_, velocity_steps_;  // at the present v, and along the step
    std::vector<double> rates_, rate_steps_;
    std::vector<Column6> step_, force_;
};

}  // namespace plab::managers
