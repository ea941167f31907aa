// Rounds of the augmented Lagrangian in the impulses of a mechanism's contacts: lagrangian.h, with v = v_free + A^-1 J_c^T y. The function
// that it minimises has the gradient W (y - P(tau(u))) in y, where u = q + W y, and Newton's step is (1 + G W) dy = P(tau(u)) - y.
#include <algorithm>
#include <cmath>

#include "delassus.h"
#include "lagrangian.h"

namespace plab::managers
{

void DelassusSolver::start_round(double kappa)
{
    rho_.resize(places_.size()), bias_.resize(places_.size());
    for (std::size_t k = 0; k < places_.size(); ++k)
    {
        const Vec3 u = places_[k].line ? Vec3{} : velocity(places_[k]);
        rho_[k] = !places_[k].line ? kappa / points_[k].K(2, 2) : lines_[k].count > 0 ? lines_[k].stiffness(kappa) : 0.0;
        bias_[k] = places_[k].line ? 0.0 : points_[k].friction * std::hypot(u.x, u.y);
    }
}

/// P(tau) of a place at the velocities `u`, and rho P'.
Vec3 DelassusSolver::held(std::size_t k, std::span<const double> u, Mat3* G) const
{
    const Place& place = places_[k];
    if (place.line)
    {
        const Line& line = lines_[k];
        const double tau = line.impulse - rho_[k] * (u[place.first] + line.compliance * line.impulse - line.target);
        if (G) *G = {}, (*G)(2, 2) = tau >= line.least && tau <= line.most ? rho_[k] : 0.0;
        return {0, 0, std::clamp(tau, line.least, line.most)};
    }
    const Point& p = points_[k];
    const Vec3 at = place.count == 1 ? Vec3{0, 0, u[place.first]} : Vec3{u[place.first], u[place.first + 1], u[place.first + 2]};
    return within_cone(p.impulse - (at + Vec3{0, 0, bias_[k] - p.least}) * rho_[k], p.friction, rho_[k], G);
}

/// Sets step_ to P(tau) - y at u_, and, if asked to, the matrix 1 + G W. Returns the largest |P(tau) - y| as a speed, m/s.
double DelassusSolver::find_pull(bool with_matrix)
{
    linear::SquareMatrix<double>& A = factors_.matrix();
    if (with_matrix) A.resize(size_), std::ranges::fill(A.all(), 0.0);
    step_.resize(size_);
    double largest = 0;
    for (std::size_t k = 0; k < places_.size(); ++k)
    {
        const Place& place = places_[k];
        Mat3 G;
        const Vec3 wanted = held(k, u_, with_matrix ? &G : nullptr);
        const std::uint32_t skip = 3 - place.count;
        for (std::uint32_t i = skip; i < 3; ++i)
        {
            const std::uint32_t row = place.first + i - skip;
            step_[row] = wanted[i] - y_[row];
            largest = std::max(largest, std::fabs(step_[row]) * W(row, row));
            for (std::uint32_t j = skip; with_matrix && j < 3; ++j) add_row(row, place.first + j - skip, G(i, j));
        }
    }
    for (std::size_t i = 0; with_matrix && i < size_; ++i) A(i, i) += 1;
    return largest;
}

/// The derivative of the function along the step, at y + t step.
double DelassusSolver::slope(double t)
{
    trial_.resize(size_);
    for (std::size_t i = 0; i < size_; ++i) trial_[i] = u_[i] + t * rates_[i];
    double sum = 0;
    for (std::size_t k = 0; k < places_.size(); ++k)
    {
        const Place& place = places_[k];
        const Vec3 wanted = held(k, trial_, nullptr);
        const std::uint32_t skip = 3 - place.count;
        for (std::uint32_t i = skip; i < 3; ++i)
        {
            const std::uint32_t row = place.first + i - skip;
            sum += rates_[row] * (y_[row] + t * step_[row] - wanted[i]);
        }
    }
    return sum;
}

bool DelassusSolver::round(double kappa, double tolerance, Found& out)
{
    constexpr int kSteps = 25;
    constexpr double kEnough = 1e-3;
    start_round(kappa);
    y_ = r_;
    double before = 0, size = HUGE_VAL;
    for (int i = 0; i < kSteps && !is_spent(); ++i, ++out.steps)
    {
        velocities_with(y_, u_);
        size = find_pull(true);
        if (i == 0) before = size;
        if (size <= std::max(tolerance, kEnough * before / kappa)) break;
        pull_ = step_;
        if (!factorise()) break;
        factors_.solve(step_);
        rates_.resize(size_);
        std::ranges::fill(rates_, 0.0);
        add_responses(step_, rates_);
        double at_zero = 0;
        for (std::size_t c = 0; c < size_; ++c) at_zero -= rates_[c] * pull_[c];
        if (!(at_zero < 0)) break;
        const double t = least_along([this](double at) { return slope(at); }, at_zero);
        for (std::size_t c = 0; c < size_; ++c) y_[c] += t * step_[c];
    }
    if (!(size <= std::max(tolerance, 10 * kEnough * before / kappa)))
    {
        find_velocities();
        return false;
    }
    for (std::size_t k = 0; k < places_.size(); ++k)
    {
        const Vec3 wanted = held(k, u_, nullptr);
        const std::uint32_t skip = 3 - places_[k].count;
        for (std::uint32_t i = skip; i < 3; ++i) r_[places_[k].first + i - skip] = wanted[i];
    }
    find_velocities();
    return true;
}

}  // namespace plab::managers
