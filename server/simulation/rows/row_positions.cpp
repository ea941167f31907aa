// Projection of positions onto the rows in the norm of M: q += M^-1 J^T mu with J M^-1 J^T mu = -phi, a Newton method, repeated until phi
// is at rounding level. If rows contradict one another, it ends at the nearest minimum of
//
//   F(q) = sum phi_i^2 / m_i       m_i = J_i M^-1 J_i^T, the row's own mobility at the start; all rows that may depend on one another
//
// With the compliance C = c diag(m) of row_equations.h, a Newton step is Gauss and Newton's step for F, damped in the norm of M:
//
//   dq = argmin |phi + J dq|^2 + c |dq|_M^2                        (rows weighted by 1/m)
//
// It knows nothing of the curvature of phi, which is as large as J where errors remain. Take a body between two rods that are too short:
// in the middle both rods are in line, and only their curvature pulls the body back from a distance z off that line. The undamped step is
// of length 1/z, so that rounding would decide where the body ends. Therefore a step that raises F is taken back and repeated with
// more damping; with enough of it, a step follows the gradient of F.
//
// Rows of trees have no compliance and are always satisfied: no row contradicts them. They may raise F when they are brought back.
// Sources: J. Nocedal, S. Wright, Numerical Optimization, section 10.3 (Levenberg-Marquardt); H. B. Nielsen, Damping parameter in
// Marquardt's method, IMM-REP-1999-05 (the rule for c).
#include <algorithm>
#include <cmath>
#include <limits>

#include "plab/rotation.h"
#include "simulation/rows/projection_limits.h"
#include "simulation/rows/row_system.h"

namespace plab::simulation
{
namespace
{

constexpr int kMostIterations = 40;
/// rad per Newton step: for larger rotations the linearisation is not valid.
constexpr double kMostTurn = 0.5;
/// A fit has settled when a step is this share of the remaining errors, both in the norm of M.
constexpr double kSettledStep = 1e-10;
/// With this damping only rows of trees move anything.
constexpr double kMostDamping = 1e6;

}  // namespace

/// Moves by the last solution; returns the share of it that was used.
double RowSystem::move_members(const StepContext& context)
{
    const auto members = equations_.members();
    double turn = 0;
    for (std::size_t i = 0; i < members.size(); ++i)
    {
        const double* x = equations_.result(i);
        if (members[i].participant.facet == Facet::Body) turn = std::fmax(turn, length(Vec3{x[3], x[4], x[5]}));
    }
    const double share = turn > kMostTurn ? kMostTurn / turn : 1.0;
    bool any_shaft = false;
    for (std::size_t i = 0; i < members.size(); ++i)
    {
        const double* x = equations_.result(i);
        const std::uint32_t index = members[i].participant.index;
        if (members[i].participant.facet == Facet::Shaft)
        {
            host_->shafts.angle[index] += share * x[0];
            any_shaft = true;
            continue;
        }
        Bodies& bodies = host_->bodies;
        bodies.position[index] += share * Vec3{x[0], x[1], x[2]};
        bodies.orientation[index] = normalized(bodies.orientation[index] * exp_rotation(share * Vec3{x[3], x[4], x[5]}));
        bodies.refresh_spin(index);
    }
    if (any_shaft) graph_->derive(host_->shafts, context.active_shafts);
    return share;
}

void RowSystem::save_poses()
{
    const auto members = equations_.members();
    poses_.resize(members.size());
    for (std::size_t i = 0; i < members.size(); ++i)
    {
        const std::uint32_t index = members[i].participant.index;
        if (members[i].participant.facet == Facet::Shaft)
            poses_[i].angle = host_->shafts.angle[index];
        else
            poses_[i].position = host_->bodies.position[index], poses_[i].orientation = host_->bodies.orientation[index];
    }
}

void RowSystem::restore_poses(const StepContext& context)
{
    const auto members = equations_.members();
    bool any_shaft = false;
    for (std::size_t i = 0; i < members.size(); ++i)
    {
        const std::uint32_t index = members[i].participant.index;
        if (members[i].participant.facet == Facet::Shaft)
        {
            host_->shafts.angle[index] = poses_[i].angle;
            any_shaft = true;
            continue;
        }
        host_->bodies.position[index] = poses_[i].position, host_->bodies.orientation[index] = poses_[i].orientation;
        host_->bodies.refresh_spin(index);
    }
    if (any_shaft) graph_->derive(host_->shafts, context.active_shafts);
    (void)measure_rows(context);
}

/// collect(), and the errors of positions.
double RowSystem::measure_rows(const StepContext& context)
{
    collect(context);
    equations_.set_rows(rows_, pieces_);
    return measure_positions();
}

/// Solves for one correction at the present state, with the last factorisation or, if `compliance` is given, a new one.
bool RowSystem::solve_positions(double compliance)
{
    if (compliance > 0) equations_.factor(compliance);
    equations_.clear_right_hand_side();
    const auto slots = equations_.slots();
    for (std::size_t s = 0; s < slots.size(); ++s)
        if (rows_[slots[s].row].kind == RowKind::Equality) equations_.wanted(s) = -rows_[slots[s].row].error;
    return equations_.solve();
}

/// Newton's method, which keeps the same factorisation while the error still contracts well. The compliance is not refined away here:
/// above rounding level the iteration removes its effect, and at rounding level the compliance keeps rounding errors from being amplified
/// into directions that hardly change any row. If the iteration stalls before the rows are satisfied, it continues as least squares.
void RowSystem::relax_positions(const StepContext& context, ProjectionReport& report)
{
    double before = std::numeric_limits<double>::infinity();
    bool stalled = false, fresh = true;
    for (;; ++report.iterations)
    {
        const double error = measure_rows(context);
        if (!(error > kProjectionRounding) || report.iterations == kMostIterations) break;
        const bool stagnates = fresh && error > 0.5 * before;
        if (stagnates && error < kContradiction) break;
        if (stalled && std::fabs(error - before) < 1e-10 * error) break;
        stalled = stalled || stagnates;
        if (stalled && equations_.compliant()) return fit_positions(context, report);
        fresh = !factored_ || stalled || error > kGoodContraction * before;
        if (fresh && equations_.compliant()) save_poses();
        if (solve_positions(fresh ? RowEquations::kCompliance : 0)) (void)move_members(context);
        factored_ = true;
        before = error;
    }
}

/// F of the file's head after `share` of the last solution, to first order. 0: at the present state.
double RowSystem::square_of_errors(double share) const
{
    double sum = 0;
    const auto slots = equations_.slots();
    for (std::size_t s = 0; s < slots.size(); ++s)
    {
        if (weights_[s] == 0) continue;
        const double error = position_error_[slots[s].row] + (share == 0 ? 0.0 : share * equations_.moved(s));
        sum += weights_[s] * error * error;
    }
    return sum;
}

/// Starts where Newton's last step did, which may have gone far away.
void RowSystem::fit_positions(const StepContext& context, ProjectionReport& report)
{
    restore_poses(context);
    weights_.clear();
    for (const RowEquations::Slot& slot : equations_.slots())
        weights_.push_back(slot.mobility > 0 && rows_[slot.row].kind == RowKind::Equality ? 1 / slot.mobility : 0.0);
    double square = square_of_errors(0), damping = RowEquations::kSoftCompliance, growth = 2;
    for (bool settled = false; !settled && damping < kMostDamping && report.iterations < kMostIterations; ++report.iterations)
    {
        save_poses();
        if (!solve_positions(damping)) break;
        settled = equations_.norms().reactions <= kSettledStep * std::sqrt(square);
        const double share = move_members(context), expected = square_of_errors(share);
        (void)measure_rows(context);
        const double reached = square_of_errors(0);
        if (reached <= (expected > square ? 2 * expected : square))
        {
            const double gain = std::clamp(2 * (square - reached) / (square - expected) - 1, -1.0, 1.0);
            damping = std::fmax(RowEquations::kSoftCompliance, damping * std::fmax(1.0 / 3, 1 - gain * gain * gain));
            growth = 2, square = reached;
        }
        else
        {
            restore_poses(context);
            damping *= growth, growth *= 2;
        }
    }
    satisfy_trees(context);
}

/// Newton's method for the rows of trees alone, after a fit that has moved them.
void RowSystem::satisfy_trees(const StepContext& context)
{
    constexpr int kSteps = 4;
    const auto slots = equations_.slots();
    for (int i = 0; i < kSteps; ++i)
    {
        const auto holds = [this](const RowEquations::Slot& slot)
        {
            const ConstraintRow& row = rows_[slot.row];
            return slot.mobility > 0 || !(std::fabs(position_error_[slot.row]) > kProjectionRounding * position_scale(row));
        };
        if (std::all_of(slots.begin(), slots.end(), holds) || !solve_positions(kMostDamping)) break;
        (void)move_members(context);
        (void)measure_rows(context);
    }
    factored_ = false;
}

}  // namespace plab::simulation
