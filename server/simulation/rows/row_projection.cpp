// Projection onto rows, weighted by M: q += M^-1 J^T mu with J M^-1 J^T mu = -phi until phi is rounding, then the same for
// speeds with rate - J v. Rows that contradict one another end at least squares of phi, with each row in units of its own
// mobility.
#include <algorithm>
#include <cmath>
#include <limits>

#include "plab/rotation.h"
#include "simulation/rows/row_system.h"

namespace plab::simulation
{
namespace
{

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
/// Errors below this share of the numbers that they come from are rounding.
constexpr double kRounding = 16 * kEpsilon;
/// Speeds that move this share of such numbers' digits in a step are rounding, too.
constexpr double kShareOfPlace = 1e-3;
/// What iteration cannot bring below this share is a contradiction.
constexpr double kContradiction = 1e-8;
constexpr double kSpeedContradiction = 1e-4;
/// Members stand on their rows if no error is above this share: what a projection leaves, and no more.
constexpr double kOnRows = 1e-12;
/// Speeds that miss their rows by less than this share are left to the projection at the end of the advance.
constexpr double kMisfit = 1e-8;
constexpr int kMostIterations = 40;
constexpr int kMostSpeedCorrections = 8;
/// What a factorisation of a state nearby may leave, and each correction after it.
constexpr double kGoodContraction = 1e-3;
/// rad, for one Newton step: beyond, the linear model says nothing.
constexpr double kMostTurn = 0.5;

}  // namespace

/// The size of the numbers that a row's error is a difference of, m or rad.
double RowSystem::position_scale(const ConstraintRow& row) const
{
    double scale = 0;
    for (std::uint32_t k = 0; k < row.count; ++k)
    {
        const RowBlock& b = row.blocks[k];
        if (b.who.facet == Facet::Body)
            scale += length(b.linear) * length(host_->bodies.position[b.who.index]) + length(b.angular);
        else
            scale += std::fabs(b.angular.x) * std::fmax(1.0, std::fabs(host_->shafts.angle[b.who.index]));
    }
    return scale;
}

/// The size of the numbers that a row's speed is a sum of; and what moves less than a digit of a place in a step is nothing.
double RowSystem::speed_scale(const ConstraintRow& row, double dt) const
{
    double scale = std::fabs(row.rate) + (dt > 0 ? kShareOfPlace * position_scale(row) / dt : 0.0);
    for (std::uint32_t k = 0; k < row.count; ++k)
    {
        const RowBlock& b = row.blocks[k];
        if (b.who.facet == Facet::Body)
            scale += length(b.linear) * length(host_->bodies.velocity[b.who.index]) +
                     length(b.angular) * length(host_->bodies.angular_velocity[b.who.index]);
        else
            scale += std::fabs(b.angular.x * host_->shafts.speed[b.who.index]);
    }
    return scale;
}

namespace
{

/// sqrt(J M^-1 J^T) of one block on a body that moves.
double root_of_mobility(const Bodies& bodies, const RowBlock& b)
{
    const Vec3 angular_B = rotate_back(bodies.orientation[b.who.index], b.angular);
    return std::sqrt(length_squared(b.linear) * bodies.inverse_mass[b.who.index] +
                     dot(angular_B, bodies.inverse_inertia_B[b.who.index] * angular_B));
}

}  // namespace

/// What a row's error is small or large beside, also where its members stand or turn about the origin: with the lengths at hand,
/// the arms of the bodies' mass about their centres, sqrt(tr I / 2 m).
double RowSystem::position_at_hand(const ConstraintRow& row) const
{
    double scale = position_scale(row);
    for (std::uint32_t k = 0; k < row.count; ++k)
    {
        const RowBlock& b = row.blocks[k];
        if (b.who.facet != Facet::Body || !is_mobile(b.who)) continue;
        const Mat3& I = host_->bodies.inertia_B[b.who.index];
        scale += length(b.linear) * std::sqrt(0.5 * (I(0, 0) + I(1, 1) + I(2, 2)) * host_->bodies.inverse_mass[b.who.index]);
    }
    return scale;
}

/// The same of its speed. |J v| <= sqrt(J M^-1 J^T) sqrt(v . M v), so that the second factor's rounding may show in it: that of the
/// member's motion, and of the impulses by which the rows of its component held it in this step (dt s).
double RowSystem::speed_at_hand(std::size_t index, double dt) const
{
    const ConstraintRow& row = rows_[index];
    double held = 0;
    std::size_t first = index;  // those of a component stand together
    while (first > 0 && rows_[first - 1].component == row.component) --first;
    for (std::size_t i = first; i < rows_.size() && i < lambda_.size() && rows_[i].component == row.component; ++i)
    {
        if (lambda_[i] == 0) continue;
        for (std::uint32_t k = 0; k < rows_[i].count; ++k)
            if (const RowBlock& b = rows_[i].blocks[k]; b.who.facet == Facet::Body && is_mobile(b.who))
                held = std::fmax(held, std::fabs(lambda_[i]) * root_of_mobility(host_->bodies, b));
    }
    double scale = speed_scale(row, dt);
    for (std::uint32_t k = 0; k < row.count; ++k)
    {
        const RowBlock& b = row.blocks[k];
        if (b.who.facet == Facet::Body && is_mobile(b.who))
            scale += root_of_mobility(host_->bodies, b) * (std::sqrt(2 * host_->bodies.kinetic_energy(b.who.index)) + dt * held);
    }
    return scale;
}

/// Whether errors are a contradiction: more than `share` of what is at hand.
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

/// Fills position_error_. The largest of rows that are held, relative to position_scale.
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

void RowSystem::move_members(const StepContext& context)
{
    const auto members = equations_.members();
    double turn = 0;
    for (std::size_t i = 0; i < members.size(); ++i)
    {
        const double* x = equations_.result(i);
        if (members[i].who.facet == Facet::Body) turn = std::fmax(turn, length(Vec3{x[3], x[4], x[5]}));
    }
    const double share = turn > kMostTurn ? kMostTurn / turn : 1.0;
    bool any_shaft = false;
    for (std::size_t i = 0; i < members.size(); ++i)
    {
        const double* x = equations_.result(i);
        const std::uint32_t who = members[i].who.index;
        if (members[i].who.facet == Facet::Shaft)
        {
            host_->shafts.angle[who] += share * x[0];
            any_shaft = true;
            continue;
        }
        Bodies& bodies = host_->bodies;
        bodies.position[who] += share * Vec3{x[0], x[1], x[2]};
        bodies.orientation[who] = normalized(bodies.orientation[who] * exp_rotation(share * Vec3{x[3], x[4], x[5]}));
        bodies.refresh_spin(who);
    }
    if (any_shaft) graph_->derive(host_->shafts, context.active_shafts);
}

void RowSystem::change_speeds(const StepContext& context)
{
    const auto members = equations_.members();
    bool any_shaft = false;
    for (std::size_t i = 0; i < members.size(); ++i)
    {
        const double* x = equations_.result(i);
        const std::uint32_t who = members[i].who.index;
        if (members[i].who.facet == Facet::Shaft)
        {
            host_->shafts.speed[who] += x[0];
            any_shaft = true;
            continue;
        }
        Bodies& bodies = host_->bodies;
        const Vec3 spin{x[3], x[4], x[5]};
        bodies.velocity[who] += Vec3{x[0], x[1], x[2]};
        if (bodies.needle[who] != 0)
            bodies.angular_velocity[who] += rotate(bodies.orientation[who], spin);
        else
            bodies.angular_momentum[who] += rotate(bodies.orientation[who], bodies.inertia_B[who] * spin);
        bodies.refresh_spin(who);
    }
    if (any_shaft) graph_->derive(host_->shafts, context.active_shafts);
}

/// True: with the matrix of this very state.
bool RowSystem::correct_positions(const StepContext& context, double compliance)
{
    const bool fresh = !factored_ || compliance != RowEquations::kCompliance;
    if (fresh) equations_.factor(compliance);
    factored_ = compliance == RowEquations::kCompliance;
    equations_.clear_right_hand_side();
    const auto slots = equations_.slots();
    for (std::size_t s = 0; s < slots.size(); ++s)
        if (rows_[slots[s].row].kind == RowKind::Equality) equations_.wanted(s) = -rows_[slots[s].row].error;
    if (equations_.solve()) move_members(context);
    return fresh;
}

/// Newton's method, with the same matrix while that will do. Compliance is left in: iteration takes its effect away where
/// errors are more than rounding, and rounding is not driven into directions that hardly move a row. Where iteration comes
/// to a stand before the rows hold, least squares take over.
void RowSystem::relax_positions(const StepContext& context, ProjectionReport& report)
{
    double before = std::numeric_limits<double>::infinity();
    bool soft = false, fresh = true;
    for (;; ++report.iterations)
    {
        collect(context);
        equations_.set_rows(rows_, pieces_);
        const double error = measure_positions();
        if (!(error > kRounding) || report.iterations == kMostIterations) break;
        const bool stands = fresh && error > 0.5 * before;
        if (stands && error < kContradiction) break;
        if (soft && std::fabs(error - before) < 1e-10 * error) break;
        soft = soft || stands;
        if (error > kGoodContraction * before) factored_ = false;
        fresh = correct_positions(context, soft ? RowEquations::kSoftCompliance : RowEquations::kCompliance);
        before = error;
    }
}

/// One correction. A factorisation of a state nearby is mostly good enough; if not, it must not touch the speeds.
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
    for (int i = 0; i < kMostSpeedCorrections && left > kRounding; ++i)
    {
        correct_speeds(context, soft);
        add_speed_work();
        const double before = left;
        left = measure_speeds(context.dt);
        if (left < 0.5 * before) continue;
        if (soft || left < kSpeedContradiction) break;
        soft = true;  // rows that cannot all hold
    }
    if (!(left >= kSpeedContradiction) || !speeds_contradict(context.dt)) return;
    report.converged = false;
    name_contradictory(speed_error_, report);
}

/// J^T mu (v + v') / 2: what each row's impulse has done. Called when speeds have just been changed.
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
    // By the last factorisation: of a state close to the present one, but not by one that lets rows give way.
    if (equations_.compliance() > RowEquations::kCompliance) return;
    const auto slots = equations_.slots();
    for (std::size_t s = 0; s < slots.size(); ++s)
        if (equations_.redundant(s)) ++redundant_[slots[s].piece], ++report.redundant;
}

/// Whoever has a fair share in the worst error.
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
    // Rows that nobody can follow, as all who take part are prescribed: nothing to correct, but to tell.
    const auto nobody_moves = [this](const ConstraintRow& row)
    {
        const auto mobile = [this](const RowBlock& b) { return is_mobile(b.who); };
        return !row.may_yield() && std::none_of(row.blocks.begin(), row.blocks.begin() + row.count, mobile);
    };
    double left = measure_positions();
    for (std::size_t i = 0; i < rows_.size(); ++i)
        if (rows_[i].kind == RowKind::Equality && rows_[i].error != 0 && nobody_moves(rows_[i]))
            position_error_[i] = rows_[i].error, left = std::fmax(left, std::fabs(rows_[i].error) / position_scale(rows_[i]));
    report.places_hold = left < kContradiction || !positions_contradict();
    report.converged = report.places_hold;
    if (!report.converged) name_contradictory(position_error_, report);
    match_speeds(context, report);
    // What rows take that hold is the solver's error, and stays unexplained; what those take that cannot hold is theirs.
    if (!report.converged) book_speed_work(book);
    double stuck = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i)
        if (nobody_moves(rows_[i]) && speed_of(rows_[i]) != rows_[i].rate)
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
