#include "slip_end.h"

#include <algorithm>
#include <cmath>

namespace plab::managers
{
namespace
{
constexpr int kMostCuts = 8;
/// Fraction of the island's size: a displacement per step below this does not count as slip.
constexpr double kNoSlip = 0x1p-41;
/// Fraction of Contact::turning: slip up to this may be an artefact of a turning normal.
constexpr double kOfTurning = 0x1p-6;
/// Fraction of the step: a shorter part is not worth a cut.
constexpr double kSliver = 1e-9;
}  // namespace

Verdict SlipEnds::try_part(double h)
{
    Problem& problem = memory_.problem;
    kick(problem, island_, bodies_, shafts_, h);
    problem.read_speeds(bodies_, shafts_);
    set_targets(problem, island_, h, slop_, how_to_move(problem, h), memory_.passing);
    problem.apply_impulses();
    return method_.find_impulses(problem);
}

/// Whether the contact slides at the start of the part and carries friction.
bool SlipEnds::slides(std::size_t i) const
{
    const Point& p = memory_.problem.points[i];
    // On a curved path the contact normal turns during the step (Contact::turning). A rolling body then appears to slip by that
    // amount, seen from the middle of the step.
    const double least = std::max(no_slip_, kOfTurning * std::fabs(island_.contacts[i].turning));
    return p.frictional() && p.impulse.z > 0 && std::hypot(memory_.velocities[i].x, memory_.velocities[i].y) > least;
}

/// Slip speed at the end of the part, along the direction of slip at its start, m/s; 0 if the slip ended or reversed.
double SlipEnds::slip_left(std::size_t i) const
{
    const Vec3& before = memory_.velocities[i];
    const Vec3 after = memory_.problem.relative_velocity(memory_.problem.points[i]);
    const double was = std::hypot(before.x, before.y), is = std::hypot(after.x, after.y);
    const double along = (before.x * after.x + before.y * after.y) / was;
    return is > std::max(no_slip_, 1e-9 * was) && along > 0.1 * is ? along : 0.0;
}

double SlipEnds::first_end(double h)
{
    const std::size_t n = memory_.problem.points.size();
    bool ends = false;
    for (std::size_t i = 0; i < n; ++i) ends = ends || (slides(i) && slip_left(i) == 0);
    retried_ = ends;
    if (!ends) return h;
    // While all contacts still slide, slip speeds fall linearly, so their zeros can be extrapolated from a shorter part.
    double share = 0.5;
    for (double part = 0.5 * h; part > kSliver * island_.h && !island_.interrupted(); part *= 0.25, share = 0.25)
    {
        take_back_speeds(memory_, bodies_, shafts_);
        memory_.problem.scale_impulses(share);
        tried_ = part;
        (void)try_part(part);
        double first = h;
        bool all_slide = true;
        for (std::size_t i = 0; i < n && all_slide; ++i)
        {
            if (!slides(i)) continue;
            const double speed = std::hypot(memory_.velocities[i].x, memory_.velocities[i].y), left = slip_left(i);
            all_slide = left > 0;
            if (left < speed) first = std::min(first, part * speed / (speed - left));
        }
        if (all_slide) return std::clamp(first, part, h);
    }
    return h;
}

void SlipEnds::keep_impulses()
{
    memory_.rest.clear(), memory_.line_rest.clear();
    for (const Point& p : memory_.problem.points) memory_.rest.push_back(p.impulse);
    for (const Line& line : memory_.problem.lines) memory_.line_rest.push_back(line.impulse);
}

/// Not from the present impulses if those are of a much shorter part: they would carry the error of sweeps multiplied.
void SlipEnds::start_with(double h, double present, double rest)
{
    constexpr double kMostGrowth = 8;
    Problem& problem = memory_.problem;
    if (h <= kMostGrowth * present) return problem.scale_impulses(h / present);
    const double share = h / rest;
    for (std::size_t i = 0; i < problem.points.size(); ++i) problem.points[i].impulse = memory_.rest[i] * share;
    for (std::size_t i = 0; i < problem.lines.size(); ++i) problem.lines[i].impulse = memory_.line_rest[i] * share;
}

void SlipEnds::move(const Verdict& found, double h)
{
    Problem& problem = memory_.problem;
    problem.write_speeds(bodies_, shafts_);
    managers::move(problem, island_, found, h, how_to_move(problem, h));
    add_impulses(problem, island_);
    for (std::size_t i = 0; i < problem.points.size(); ++i)
    {
        memory_.impulses[i] += problem.points[i].impulse;
        memory_.velocities[i] = problem.relative_velocity(problem.points[i]);
    }
    for (std::size_t i = 0; i < problem.lines.size(); ++i) memory_.line_impulses[i] += problem.lines[i].impulse;
    done_ += h;
}

Verdict SlipEnds::advance()
{
    Problem& problem = memory_.problem;
    std::fill(memory_.impulses.begin(), memory_.impulses.end(), Vec3{});
    std::fill(memory_.line_impulses.begin(), memory_.line_impulses.end(), 0.0);
    Verdict out;
    for (int cuts = 0;; ++cuts)
    {
        const double rest = island_.h - done_;
        keep_speeds(bodies_, shafts_, memory_);
        Verdict verdict = try_part(rest);
        keep_impulses();
        tried_ = rest, retried_ = false;
        // Slip smaller than the error that the sweeps have left is not slip.
        no_slip_ = std::max(kNoSlip * island_.size / island_.h, 10 * verdict.residual);
        const double end = cuts < kMostCuts && verdict.converged ? first_end(rest) : rest;
        const bool cut = end < rest * (1 - kSliver);
        const double part = cut ? end : rest;
        if (retried_)
        {
            take_back_speeds(memory_, bodies_, shafts_);
            start_with(part, tried_, rest);
            verdict = try_part(part);
        }
        out.join(verdict);
        move(verdict, part);
        if (!cut || island_.interrupted()) break;
        problem.turn_with(bodies_);
        start_with(rest - part, part, rest);
    }
    store_impulses(problem, island_);
    for (std::size_t i = 0; i < problem.points.size(); ++i)
    {
        const Point& p = problem.points[i];
        const Vec3& j = memory_.impulses[i];
        island_.contacts[i].impulse = p.t1 * j.x + p.t2 * j.y + p.n * j.z;
    }
    for (std::size_t i = 0; i < island_.rows.size(); ++i) island_.rows[i].impulse = memory_.line_impulses[i];
    return out;
}

}  // namespace plab::managers
