// Correction of positions at the end of a step: overlap is removed, and joints are closed, by displacements that count as velocities of a
// problem of its own.
#include <algorithm>
#include <cmath>

#include "plab/body_turn.h"
#include "plab/rotation.h"
#include "stepping.h"

namespace plab::managers
{
namespace
{

/// A contact that separates by itself within this many steps is not corrected.
constexpr double kSoon = 8;
/// Fraction of the island's size: a displacement per step below this does not count as an impact.
constexpr double kSlow = 0x1p-34;

/// Errors of joints are linear in the displacements only for small turns. What remains after a correction is corrected again while it is
/// more than this fraction of the island's size (or rad), or a chain of light links under a heavy load would come apart.
constexpr double kJointsApart = 0x1p-11;
/// rad: where correcting overlap turns a body by more, joints may be apart afterwards.
constexpr double kMuch = 0x1p-6;
constexpr int kMostCorrections = 10;
/// Overlap that has not gone by then, because it comes back as often as joints are closed, is left to the next steps.
constexpr int kCorrectionsOfOverlap = 6;

/// Sets the displacements that would close the joints and stops; returns the largest of them.
double set_displacements_of_lines(Problem& problem, double length)
{
    double worst = 0;
    problem.let_resist(false);
    for (Line& line : problem.lines)
    {
        const ConstraintRow& row = problem.row_of(line);
        line.target = -row.error;
        const bool held = row.kind == RowKind::Equality;
        line.least = held ? -HUGE_VAL : 0.0, line.most = !acts_at_once(row) || line.count == 0 ? 0.0 : HUGE_VAL;
        if (line.most > 0) worst = std::max(worst, (held ? std::fabs(row.error) : -row.error) * (turns_only(row) ? length : 1));
    }
    return worst;
}

double displacement_of(const Contact& c, const StepChoices& choices)
{
    return (c.depth - choices.slop) * (c.depth > choices.slop ? choices.correction_share : 1.0);
}

constexpr double kMostTurn = 0.25;  // rad: so far errors of joints count as linear in the turns
/// A correction leaves an error of the square of its turns. If each may turn as far as the last one, a taut chain under a heavy load is
/// thrown to and fro.
constexpr double kShrink = 0.5;

double largest_turn(const Problem& problem)
{
    double most = 0;
    for (std::size_t i = 0; i < problem.movers.size(); ++i)
        if (!problem.anchors[i].shaft) most = std::max(most, length(problem.movers[i].w));
    return most;
}

double largest_shift(const Problem& problem)
{
    double most = 0;
    for (std::size_t i = 0; i < problem.movers.size(); ++i)
        if (!problem.anchors[i].shaft) most = std::max(most, length(problem.movers[i].v));
    return most;
}

void scale(Problem& problem, double factor)
{
    for (Mover& m : problem.movers) m.v = m.v * factor, m.w = m.w * factor;
}

void find_from_rest(Problem& problem, double tolerance, Method& method, Verdict& out)
{
    problem.rest();
    problem.clear_impulses();
    problem.apply_impulses();
    out.join(method.find_displacements(problem, tolerance));
}

/// Where displacements would turn bodies so far that errors of joints are not linear, finds others with smaller turns. A taut chain of
/// light links under a heavy load would be thrown from one side to the other to close a joint; if inertias count more than masses, the load
/// is drawn to it instead. Inertias change nothing but which of all displacements that close the joints is found. Returns their factor.
double keep_turns_small(Problem& problem, double tolerance, double most_turn, Method& method, Verdict& out)
{
    constexpr double kFactor = 16;
    constexpr int kTries = 4;
    double weight = 1;
    for (int n = 0; n < kTries && largest_turn(problem) > most_turn; ++n)
    {
        weight *= kFactor, problem.weigh_turns(kFactor);
        find_from_rest(problem, tolerance, method, out);
    }
    if (const double most = largest_turn(problem); most > most_turn) scale(problem, most_turn / most);
    return weight;
}

/// Joints may keep an overlap: of two links that hang on the same end, say. No displacement removes it then; the more a method tries, the
/// farther it moves bodies along what hardly helps, and lifts them. Leaves the overlap of points whose displacement has not come near what
/// it should be, and returns whether there are any.
bool leave_kept_overlap(Problem& problem, double worst)
{
    constexpr double kMissed = 0.25, kOfWorst = 0.125;
    bool any = false;
    for (Point& p : problem.points)
    {
        if (p.least == kFar || !(p.least - problem.relative_velocity(p).z > kMissed * std::max(p.least, kOfWorst * worst))) continue;
        p.least = kFar, any = true;
    }
    return any;
}

/// Leaves the overlap of movers with one another, or of all points.
void leave_overlap(Problem& problem, bool of_movers_only)
{
    for (Point& p : problem.points)
        if (!of_movers_only || (p.a != kNoIndex && p.b != kNoIndex)) p.least = kFar;
}

/// Finds displacements that reach no farther than a chain of bodies would pass on. Points that joints keep in overlap are given up, and if
/// others are always missed then, all of them, so that joints alone are closed. Where bodies would have to go far or turn by more than
/// `most_turn`, rad, so are those of movers with one another, and what joints alone ask for is kept to small turns; what is beyond reach
/// even then is left to the next steps. Returns keep_turns_small().
double find_within_reach(Problem& problem, double worst, double tolerance, double most_turn, Method& method, Verdict& out)
{
    constexpr int kTries = 3;
    const auto keep_small = [&] { return keep_turns_small(problem, tolerance, most_turn, method, out); };
    find_from_rest(problem, tolerance, method, out);
    if (std::none_of(problem.lines.begin(), problem.lines.end(), is_joint) || problem.points.empty()) return keep_small();
    for (int n = 1; n <= kTries && leave_kept_overlap(problem, worst); ++n)
    {
        if (n == kTries) leave_overlap(problem, false);
        find_from_rest(problem, tolerance, method, out);
    }
    const double reach = worst * static_cast<double>(problem.movers.size() + 1);
    const auto beyond = [&] { return std::max(largest_shift(problem) / reach, largest_turn(problem) / std::min(most_turn, kMostTurn)); };
    if (!(beyond() > 1)) return 1;
    leave_overlap(problem, true);
    find_from_rest(problem, tolerance, method, out);
    const double weight = keep_small();
    if (const double times = beyond(); times > 1) scale(problem, 1 / times);
    return weight;
}

Verdict displace_by(Problem& problem, double worst, double tolerance, Bodies& bodies, Shafts& shafts, Method& method, double most_turn)
{
    problem.turn_with(bodies);
    for (Point& p : problem.points) p.friction = 0;
    Verdict out;
    const double weight = find_within_reach(problem, worst, tolerance, most_turn, method, out);
    displace(problem, bodies, shafts);
    if (weight != 1) problem.weigh_turns(1 / weight);
    return out;
}

}  // namespace

Verdict correct_positions(Island& island, Bodies& bodies, Shafts& shafts, Method& method, const StepChoices& choices, StepMemory& memory)
{
    Problem& problem = memory.problem;
    island.motion->refresh_depths();
    if (!island.rows.empty()) island.motion->refresh_rows();
    const double length = island.bodies.empty() ? 1 : island.size;  // islands of shafts alone have errors in rad
    double worst = 0;
    for (std::size_t i = 0; i < problem.points.size(); ++i)
    {
        const Contact& c = island.contacts[i];
        Point& p = problem.points[i];
        // Overlap that will separate by itself soon, or whose impact the next step answers, is left to its velocity: correcting
        // it would lift the body.
        const bool meets_next = i < memory.passing.size() && memory.passing[i] * island.h < -kSlow * island.size;
        const bool leaves = c.depth > 0 && (meets_next || problem.relative_velocity(p).z * kSoon * island.h > c.depth);
        p.least = leaves ? kFar : displacement_of(c, choices);
        worst = std::max(worst, leaves || p.K(2, 2) == 0 ? 0.0 : p.least);
    }
    const double apart = set_displacements_of_lines(problem, length);
    worst = std::max(worst, apart);
    if (worst <= kPositionTolerance * length) return {};
    if (apart > kJointsApart * length) problem.turn_lines();
    Verdict out = displace_by(problem, worst, kPositionTolerance * length, bodies, shafts, method,
                              apart > kJointsApart * length ? kMostTurn : HUGE_VAL);
    const bool may_part = !island.rows.empty() && largest_turn(problem) > kMuch;
    double most_turn = kMostTurn;
    for (int n = 1; n < kMostCorrections && (apart > kJointsApart * length || may_part); ++n)
    {
        island.motion->refresh_rows();
        const double still = set_displacements_of_lines(problem, length);
        if (!(still > kJointsApart * length)) break;
        worst = still;
        if (n < kCorrectionsOfOverlap)
        {
            island.motion->refresh_depths();
            for (std::size_t i = 0; i < problem.points.size(); ++i)
                if (Point& p = problem.points[i]; p.least > kFar)
                    p.least = displacement_of(island.contacts[i], choices), worst = std::max(worst, p.least);
        }
        else
            leave_overlap(problem, false);
        problem.turn_lines();
        most_turn *= kShrink;
        out.join(displace_by(problem, worst, kPositionTolerance * length, bodies, shafts, method, most_turn));
    }
    return out;
}

}  // namespace plab::managers
