#include "lagrangian.h"

#include <algorithm>
#include <cmath>

#include "contact_law.h"

namespace plab::managers
{

void Lagrangian::start(const Problem& problem, double kappa)
{
    rho_.clear(), bias_.clear(), line_rho_.clear();
    for (const Point& p : problem.points)
    {
        rho_.push_back(p.K(2, 2) > 0 ? kappa / p.K(2, 2) : 0.0);
        const Vec3 u = p.frictional() ? problem.relative_velocity(p) : Vec3{};
        bias_.push_back(p.friction * std::hypot(u.x, u.y));
    }
    for (const Line& line : problem.lines) line_rho_.push_back(line.count > 0 ? line.stiffness(kappa) : 0.0);
    velocities_.resize(problem.points.size()), velocity_steps_.resize(problem.points.size());
    gaps_.resize(problem.lines.size()), rate_steps_.resize(problem.lines.size());
    step_.resize(problem.movers.size());
}

Vec3 Lagrangian::tau_of(const Problem& problem, std::size_t i, const Vec3& u) const
{
    const Point& p = problem.points[i];
    return p.impulse - (u + Vec3{0, 0, bias_[i] - p.least}) * rho_[i];
}

Vec3 Lagrangian::project(const Problem& problem, std::size_t i, const Vec3& tau, Mat3* G) const
{
    return within_cone(tau, problem.points[i].friction, rho_[i], G);
}

double Lagrangian::project_line(const Line& line, double tau, double rho, double* g) const
{
    if (g) *g = tau >= line.least && tau <= line.most ? rho : 0.0;
    return std::clamp(tau, line.least, line.most);
}

/// Sets step_ to minus the gradient at the present v and, if a matrix is given, fills it with the Hessian; returns the largest
/// |gradient| as a speed, m/s.
double Lagrangian::gradient(const Problem& problem, IslandMatrix* matrix)
{
    for (std::size_t i = 0; i < problem.movers.size(); ++i)
    {
        const Anchor& m = problem.anchors[i];
        step_[i] = {};
        add(step_[i], (m.v - problem.movers[i].v) * m.mass, m.inertia * (m.w - problem.movers[i].w));
    }
    if (matrix) matrix->start(problem);
    for (std::size_t i = 0; i < problem.points.size(); ++i)
    {
        if (rho_[i] == 0) continue;
        velocities_[i] = problem.relative_velocity(problem.points[i]);
        Mat3 G;
        add_push(step_, problem.points[i], project(problem, i, tau_of(problem, i, velocities_[i]), &G));
        if (matrix && (G(2, 2) != 0 || G(0, 0) != 0 || G(1, 1) != 0)) matrix->add(problem, i, G);
    }
    for (std::size_t i = 0; i < problem.lines.size(); ++i)
    {
        const Line& line = problem.lines[i];
        if (line.count == 0) continue;
        gaps_[i] = problem.gap(line);
        double g = 0;
        add_push(step_, line, project_line(line, line.impulse - line_rho_[i] * gaps_[i], line_rho_[i], &g));
        if (matrix && g != 0) matrix->add(problem, i, g);
    }
    double largest = 0;
    for (std::size_t i = 0; i < problem.movers.size(); ++i)
        largest = std::max({largest, length(first(step_[i])) * problem.movers[i].inverse_mass,
                            length(problem.movers[i].inverse_inertia * last(step_[i]))});
    return largest;
}

/// Solves with all touching contacts sticking. This shows how loads pass through the island, which makes it a better start than
/// zero impulses.
void Lagrangian::weld(Problem& problem, IslandMatrix& matrix)
{
    matrix.start(problem);
    for (auto& c : step_) c = {};
    for (std::size_t i = 0; i < problem.points.size(); ++i)
    {
        const Point& p = problem.points[i];
        const Vec3 u = problem.relative_velocity(p);
        // Gaps that open, or would not close, are left out.
        if (rho_[i] == 0 || (p.impulse.z <= 0 && u.z - p.least > 1e-6 * (std::fabs(u.z) + std::fabs(p.least)))) continue;
        const double grip = p.frictional() ? rho_[i] : 0.0;
        matrix.add(problem, i, Mat3::diagonal(grip, grip, rho_[i]));
        add_push(step_, p, Vec3{-grip * u.x, -grip * u.y, -rho_[i] * (u.z - p.least)});
    }
    for (std::size_t i = 0; i < problem.lines.size(); ++i)
    {
        const Line& line = problem.lines[i];
        if (line.count == 0) continue;
        const double gap = problem.gap(line);
        if (line.least == 0 && line.impulse <= 0 && gap > 0) continue;
        matrix.add(problem, i, line_rho_[i]);
        add_push(step_, line, -line_rho_[i] * gap);
    }
    if (!matrix.solve(step_)) return;
    move(problem, 1);
}

/// Derivative of the minimised function along the step, at v + t step.
double Lagrangian::slope(const Problem& problem, double t)
{
    double sum = 0;
    for (std::size_t i = 0; i < problem.movers.size(); ++i)
    {
        const Anchor& m = problem.anchors[i];
        const Vec3 dv = first(step_[i]), dw = last(step_[i]);
        sum += m.mass * dot(problem.movers[i].v + dv * t - m.v, dv);
        sum += dot(m.inertia * (problem.movers[i].w + dw * t - m.w), dw);
    }
    for (std::size_t i = 0; i < problem.points.size(); ++i)
        if (rho_[i] != 0)
            sum -= dot(project(problem, i, tau_of(problem, i, velocities_[i] + velocity_steps_[i] * t), nullptr), velocity_steps_[i]);
    for (std::size_t i = 0; i < problem.lines.size(); ++i)
    {
        const Line& line = problem.lines[i];
        if (line.count == 0) continue;
        const double tau = line.impulse - line_rho_[i] * (gaps_[i] + rate_steps_[i] * t);
        sum -= project_line(line, tau, line_rho_[i], nullptr) * rate_steps_[i];
    }
    return sum;
}

void Lagrangian::move(Problem& problem, double t)
{
    for (std::size_t i = 0; i < problem.movers.size(); ++i)
        problem.movers[i].v += first(step_[i]) * t, problem.movers[i].w += last(step_[i]) * t;
}

void Lagrangian::take_impulses(Problem& problem)
{
    for (std::size_t i = 0; i < problem.points.size(); ++i)
        if (rho_[i] != 0)
            problem.points[i].impulse = project(problem, i, tau_of(problem, i, problem.relative_velocity(problem.points[i])), nullptr);
    for (std::size_t i = 0; i < problem.lines.size(); ++i)
    {
        Line& line = problem.lines[i];
        if (line.count > 0) line.impulse = project_line(line, line.impulse - line_rho_[i] * problem.gap(line), 0, nullptr);
    }
    problem.apply_impulses();
}

bool Lagrangian::round(Problem& problem, IslandMatrix& matrix, double kappa, bool from_welded, double tolerance, int& steps)
{
    const int most_steps = from_welded ? 4 : 25;
    constexpr double kEnough = 1e-3;
    start(problem, kappa);
    if (from_welded) weld(problem, matrix);
    double before = 0, size = 0;
    for (int step = 0; step < most_steps; ++step, ++steps)
    {
        size = gradient(problem, &matrix);
        if (step == 0) before = size;
        if (size <= std::max(tolerance, kEnough * before / kappa)) break;
        force_ = step_;
        if (!matrix.solve(step_)) break;
        double at_zero = 0;
        for (std::size_t i = 0; i < step_.size(); ++i)
            for (std::size_t k = 0; k < 6; ++k) at_zero -= force_[i][k] * step_[i][k];
        for (std::size_t i = 0; i < problem.points.size(); ++i) velocity_steps_[i] = relative_velocity_of(step_, problem.points[i]);
        for (std::size_t i = 0; i < problem.lines.size(); ++i) rate_steps_[i] = rate_of(step_, problem.lines[i]);
        if (!(at_zero < 0)) break;
        move(problem, least_along([&](double t) { return slope(problem, t); }, at_zero));
    }
    if (from_welded || size <= std::max(tolerance, 10 * kEnough * before / kappa)) take_impulses(problem);
    return size <= std::max(tolerance, 10 * kEnough * before / kappa);
}

}  // namespace plab::managers
