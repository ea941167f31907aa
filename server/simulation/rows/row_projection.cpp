// Projection onto the rows in the norm of M: positions (row_positions.cpp), then speeds, v += M^-1 J^T nu with
// J M^-1 J^T nu = rate - J v. If rows contradict one another, both end at a least-squares solution, where each row is weighted by its own
// mobility.
#include <algorithm>
#include <cmath>

#include "plab/row_mobility.h"
#include "simulation/rows/projection_limits.h"
#include "simulation/rows/row_system.h"

namespace plab::simulation
{
namespace
{

/// A speed that changes those numbers by less than this share of their size in one step counts as rounding, too.
constexpr double kShareOfPlace = 1e-3;
constexpr double kSpeedContradiction = 1e-4;
/// Members satisfy their rows if no relative error is above this: the accuracy that a projection achieves.
constexpr double kOnRows = 1e-12;
/// Smaller relative misfits of speeds are left to the projection at the end of the advance.
constexpr double kMisfit = 1e-8;
constexpr int kMostSpeedCorrections = 8;

}  // namespace

/// The magnitude of the numbers whose difference is the row's error, m or rad.
double RowSystem::position_scale(const ConstraintRow& row) const
{
    double scale = 0;
    for (std::uint32_t k = 0; k < row.count; ++k)
    {
        const RowBlock& b = row.blocks[k];
        if (b.participant.facet == Facet::Body)
            scale += length(b.linear) * length(host_->bodies.position[b.participant.index]) + length(b.angular);
        else
            scale += std::fabs(b.angular.x) * std::fmax(1.0, std::fabs(host_->shafts.angle[b.participant.index]));
    }
    return scale;
}

/// The magnitude of the numbers whose sum is the row's speed. The second term covers speeds that move a member within one step by less
/// than a small share (kShareOfPlace) of its coordinates.
double RowSystem::speed_scale(const ConstraintRow& row, double dt) const
{
    double scale = std::fabs(row.rate) + (dt > 0 ? kShareOfPlace * position_scale(row) / dt : 0.0);
    for (std::uint32_t k = 0; k < row.count; ++k)
    {
        const RowBlock& b = row.blocks[k];
        if (b.participant.facet == Facet::Body)
            scale += length(b.linear) * length(host_->bodies.velocity[b.participant.index]) +
                     length(b.angular) * length(host_->bodies.angular_velocity[b.participant.index]);
        else
            scale += std::fabs(b.angular.x * host_->shafts.speed[b.participant.index]);
    }
    return scale;
}

namespace
{

double root_of_mobility(const Bodies& bodies, const RowBlock& b) { return std::sqrt(mobility_of(bodies, b)); }

}  // namespace

/// Reference size for a row's position error that is meaningful even where members are at rest at or rotate about the origin:
/// position_scale() plus the bodies' radii of gyration, sqrt(tr I / 2 m).
double RowSystem::position_at_hand(const ConstraintRow& row) const
{
    double scale = position_scale(row);
    for (std::uint32_t k = 0; k < row.count; ++k)
    {
        const RowBlock& b = row.blocks[k];
        if (b.participant.facet != Facet::Body || !is_mobile(b.participant)) continue;
        const Mat3& I = host_->bodies.inertia_B[b.participant.index];
        scale += length(b.linear) * std::sqrt(0.5 * (I(0, 0) + I(1, 1) + I(2, 2)) * host_->bodies.inverse_mass[b.participant.index]);
    }
    return scale;
}

/// Reference size for a row's speed error. |J v| <= sqrt(J M^-1 J^T) sqrt(v . M v), so rounding of the second factor may appear in J v:
/// rounding of the member's own motion, and of the impulses with which the rows of the same component held it in this step (dt in s).
double RowSystem::speed_at_hand(std::size_t index, double dt) const
{
    const ConstraintRow& row = rows_[index];
    double held = 0;
    std::size_t first = index;  // the rows of one component are adjacent
    while (first > 0 && rows_[first - 1].component == row.component) --first;
    for (std::size_t i = first; i < rows_.size() && i < lambda_.size() && rows_[i].component == row.component; ++i)
    {
        if (lambda_[i] == 0) continue;
        for (std::uint32_t k = 0; k < rows_[i].count; ++k)
            if (const RowBlock& b = rows_[i].blocks[k]; b.participant.facet == Facet::Body && is_mobile(b.participant))
                held = std::fmax(held, std::fabs(lambda_[i]) * root_of_mobility(host_->bodies, b));
    }
    double scale = speed_scale(row, dt);
    for (std::uint32_t k = 0; k < row.count; ++k)
    {
        const RowBlock& b = row.blocks[k];
        if (b.participant.facet == Facet::Body && is_mobile(b.participant))
            scale += root_of_mobility(host_->bodies, b) * (std::sqrt(2 * host_->bodies.kinetic_energy(b.participant.index)) + dt * held);
    }
    return scale;
}

/// Whether errors are a contradiction: larger than kContradiction (kSpeedContradiction) of the reference size.
bool RowSystem::positions_contradict() const
{
    for (std::size_t i = 0; i < rows_.size(); ++i)
        if (position_error_[i] != 0 && !(std::fabs(position_error_[i]) < kContradiction * position_at_hand(rows_[i]))) return true;
    return false;
}

bool RowSystem::speeds_contradict(double dt) const
{
    for (std::size_t i = 0; i < rows_.size(); ++i)
        if (speed_error_[i] != 0 && !(std::fabs(speed_error_[i]) < kSpeedContradiction * speed_at_hand(i, dt))) return true;
    return false;
}

/// Fills position_error_. Returns the largest error of the equality rows relative to position_scale().
double RowSystem::measure_positions()
{
    double worst = 0;
    position_error_.assign(rows_.size(), 0.0);
    for (const RowEquations::Slot& slot : equations_.slots())
    {
        const ConstraintRow& row = rows_[slot.row];
        if (row.kind != RowKind::Equality) continue;
        position_error_[slot.row] = row.error;
        if (row.error != 0) worst = std::fmax(worst, std::fabs(row.error) / position_scale(row));
    }
    return worst;
}

double RowSystem::measure_speeds(double dt)
{
    double worst = 0;
    speed_error_.assign(rows_.size(), 0.0);
    for (const RowEquations::Slot& slot : equations_.slots())
    {
        const ConstraintRow& row = rows_[slot.row];
        const double error = speed_of(row) - row.rate;
        speed_error_[slot.row] = error;
        if (error != 0) worst = std::fmax(worst, std::fabs(error) / speed_scale(row, dt));
    }
    return worst;
}

void RowSystem::change_speeds(const StepContext& context)
{
    const auto members = equations_.members();
    bool any_shaft = false;
    for (std::size_t i = 0; i < members.size(); ++i)
    {
        const double* x = equations_.result(i);
        const std::uint32_t index = members[i].participant.index;
        if (members[i].participant.facet == Facet::Shaft)
        {
            host_->shafts.speed[index] += x[0];
            any_shaft = true;
            continue;
        }
        Bodies& bodies = host_->bodies;
        const Vec3 spin{x[3], x[4], x[5]};
        bodies.velocity[index] += Vec3{x[0], x[1], x[2]};
        if (bodies.needle[index] != 0)
            bodies.angular_velocity[index] += rotate(bodies.orientation[index], spin);
        else
            bodies.angular_momentum[index] += rotate(bodies.orientation[index], bodies.inertia_B[index] * spin);
        bodies.refresh_spin(index);
    }
    if (any_shaft) graph_->derive(host_->shafts, context.active_shafts);
}

/// One correction. A factorisation from a nearby state is usually good enough; if it is not, its result must not be applied to the
/// speeds, so the matrix is factored again first.
void RowSystem::correct_speeds(const StepContext& context, bool least_squares)
{
    equations_.clear_right_hand_side();
    const auto slots = equations_.slots();
    for (std::size_t s = 0; s < slots.size(); ++s) equations_.wanted(s) = -speed_error_[slots[s].row];
    bool done = factored_ && !least_squares && equations_.solve() && equations_.left() < kGoodContraction;
    if (!done)
    {
        equations_.factor(least_squares ? RowEquations::kSoftCompliance : RowEquations::kCompliance);
        factored_ = !least_squares;
        done = equations_.solve();
    }
    if (done) change_speeds(context);
}

void RowSystem::match_speeds(const StepContext& context, ProjectionReport& report)
{
    speed_work_.assign(rows_.size(), 0.0);
    double left = measure_speeds(context.dt);
    bool soft = false;
    for (int i = 0; i < kMostSpeedCorrections && left > kProjectionRounding; ++i)
    {
        correct_speeds(context, soft);
        add_speed_work();
        const double before = left;
        left = measure_speeds(context.dt);
        if (left < 0.5 * before) continue;
        if (soft || left < kSpeedContradiction) break;
        soft = true;  // the rows cannot all hold
    }
    if (!(left >= kSpeedContradiction) || !speeds_contradict(context.dt)) return;
    report.converged = false;
    name_contradictory(speed_error_, report);
}

/// Work of each row's impulse mu: mu J (v + v') / 2, with v before and v' after the change. To be called directly after the speeds were
/// changed.
void RowSystem::add_speed_work()
{
    const auto slots = equations_.slots();
    for (std::size_t s = 0; s < slots.size(); ++s)
    {
        const ConstraintRow& row = rows_[slots[s].row];
        const double after = speed_of(row) - speed_of_others(row);
        speed_work_[slots[s].row] += equations_.multiplier(s) * (after - 0.5 * equations_.moved(s));
    }
}

void RowSystem::book_speed_work(const RowBook& book) const
{
    if (!book.work) return;
    for (std::size_t i = 0; i < rows_.size(); ++i)
        if (speed_work_[i] != 0 && books(rows_[i], book)) (*book.work)[rows_[i].component] += book.sign * speed_work_[i];
}

void RowSystem::count_redundant(ProjectionReport& report)
{
    redundant_.assign(pieces_.size(), 0);
    // From the last factorisation, which belongs to a nearby state; but not from one with a larger compliance, where rows give way.
    if (equations_.compliance() > RowEquations::kCompliance) return;
    const auto slots = equations_.slots();
    for (std::size_t s = 0; s < slots.size(); ++s)
        if (equations_.redundant(s)) ++redundant_[slots[s].piece], ++report.redundant;
}

/// Names the components whose error is at least a thousandth of the largest one.
void RowSystem::name_contradictory(std::span<const double> errors, ProjectionReport& report) const
{
    double worst = 0;
    for (const double e : errors) worst = std::fmax(worst, std::fabs(e));
    for (const RowPiece& piece : pieces_)
    {
        const auto mine = errors.subspan(piece.first, piece.count);
        if (std::any_of(mine.begin(), mine.end(), [worst](double e) { return std::fabs(e) > 1e-3 * worst; }))
            report.contradictory.push_back(piece.component);
    }
}

ProjectionReport RowSystem::project(const StepContext& context, const RowBook& book)
{
    ProjectionReport report;
    keep_reactions();
    factored_ = false;
    relax_positions(context, report);
    // Rows that nothing can satisfy because all participants are prescribed or static cannot be corrected, only reported.
    const auto nothing_moves = [this](const ConstraintRow& row)
    {
        const auto mobile = [this](const RowBlock& b) { return is_mobile(b.participant); };
        return !row.may_yield() && std::none_of(row.blocks.begin(), row.blocks.begin() + row.count, mobile);
    };
    double left = measure_positions();
    for (std::size_t i = 0; i < rows_.size(); ++i)
        if (rows_[i].kind == RowKind::Equality && rows_[i].error != 0 && nothing_moves(rows_[i]))
            position_error_[i] = rows_[i].error, left = std::fmax(left, std::fabs(rows_[i].error) / position_scale(rows_[i]));
    report.places_hold = left < kContradiction || !positions_contradict();
    report.converged = report.places_hold;
    if (!report.converged) name_contradictory(position_error_, report);
    match_speeds(context, report);
    // Energy that consistent rows remove is discretisation error and stays in the ledger's unexplained part; energy that contradictory
    // rows remove is booked as their work.
    if (!report.converged) book_speed_work(book);
    double stuck = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i)
        if (nothing_moves(rows_[i]) && speed_of(rows_[i]) != rows_[i].rate)
            speed_error_[i] = speed_of(rows_[i]) - rows_[i].rate,
            stuck = std::fmax(stuck, std::fabs(speed_error_[i]) / speed_scale(rows_[i], context.dt));
    if (stuck >= kSpeedContradiction) report.converged = false, name_contradictory(speed_error_, report);
    count_redundant(report);
    for (const double e : position_error_) report.position_error = std::fmax(report.position_error, std::fabs(e));
    for (const double e : speed_error_) report.speed_error = std::fmax(report.speed_error, std::fabs(e));
    std::sort(report.contradictory.begin(), report.contradictory.end());
    report.contradictory.erase(std::unique(report.contradictory.begin(), report.contradictory.end()), report.contradictory.end());
    return report;
}

ProjectionReport RowSystem::project_speeds(const StepContext& context, const RowBook& book)
{
    ProjectionReport report;
    factored_ = false;
    collect(context);
    equations_.set_rows(rows_, pieces_);
    measure_positions();
    match_speeds(context, report);
    book_speed_work(book);
    count_redundant(report);
    for (const double e : speed_error_) report.speed_error = std::fmax(report.speed_error, std::fabs(e));
    std::sort(report.contradictory.begin(), report.contradictory.end());
    return report;
}

bool RowSystem::misfits(double dt) const
{
    return std::any_of(rows_.begin(), rows_.end(),
                       [&](const ConstraintRow& row)
                       {
                           if (row.may_yield() || !books(row, {})) return false;
                           const double error = std::fabs(speed_of(row) - row.rate);
                           return error > 0 && !(error <= kMisfit * speed_scale(row, dt));
                       });
}

void RowSystem::join(const StepContext& context, const RowBook& book)
{
    collect(context);
    if (misfits(context.dt)) (void)project_speeds(context, book);
    equations_.forget_implied();
    if (!equations_.analyse(rows_, pieces_)) return;
    equations_.set_rows(rows_, pieces_);
    if (measure_positions() > kOnRows) return;
    equations_.note_implied();
    factored_ = false;
}

}  // namespace plab::simulation
