// The reduced problem of a mechanism: which points and rows take part, W, and the way back.
#include <algorithm>
#include <cmath>

#include "delassus.h"
#include "joint_solver.h"

namespace plab::managers
{
namespace
{

/// What the mechanism can move by less than this share of what its bodies alone could is locked: the rest is rounding.
constexpr double kLocked = 1e-13;

}  // namespace

// Which points and rows take part ----------------------------------------------------------------------------------------

void DelassusSolver::add_place(std::uint32_t index, std::uint32_t count, bool line)
{
    (line ? line_in_ : point_in_)[index] = 1;
    places_.push_back({index, static_cast<std::uint32_t>(size_), count, line});
    size_ += count;
}

/// Adds what has an impulse, closes at the present velocities, or opens by less than `least` (m/s). Of several solutions, which are not
/// rare in an impact, the one that is found depends on what takes part, so rounding must not decide on that: what neither closes nor opens
/// does, and so does a brake at rest. False if there is nothing to add.
bool DelassusSolver::add_missing(const Problem& problem, double least)
{
    const std::size_t before = places_.size();
    for (std::uint32_t i = 0; i < problem.points.size(); ++i)
    {
        const Point& p = problem.points[i];
        if (point_in_[i] != 0 || !(p.K(2, 2) > 0)) continue;
        if (p.impulse != Vec3{} || problem.relative_velocity(p).z - p.least < least) add_place(i, p.frictional() ? 3 : 1, false);
    }
    for (std::uint32_t i = 0; i < problem.lines.size(); ++i)
    {
        const Line& line = problem.lines[i];
        if (line_in_[i] != 0 || line.count == 0) continue;
        if (line.least == 0 && line.most == 0) continue;
        if (line.impulse != 0 || line.least < 0 || problem.gap(line) < least) add_place(i, 1, true);
    }
    return places_.size() > before;
}

// The reduced problem ----------------------------------------------------------------------------------------------------

/// The velocities of the mechanism without r.
void DelassusSolver::find_free(Problem& problem)
{
    columns_.assign(problem.movers.size(), Column6{});
    joints_->move_with(problem, columns_);
    for (std::size_t m = 0; m < columns_.size(); ++m) problem.movers[m].v = first(columns_[m]), problem.movers[m].w = last(columns_[m]);
}

/// Of the places from this one on, and by symmetry of the others.
void DelassusSolver::find_columns(const Problem& problem, std::size_t from)
{
    const auto at = [this](std::size_t r, std::size_t c) -> double& { return W_[c * kMostImpulses + r]; };
    for (std::size_t k = from; k < places_.size(); ++k)
        for (std::uint32_t axis = 0; axis < places_[k].count; ++axis)
        {
            const Place& own = places_[k];
            columns_.assign(problem.movers.size(), Column6{});
            if (own.line)
                add_push(columns_, problem.lines[own.index], 1);
            else
                add_push(columns_, problem.points[own.index],
                         own.count == 1 ? Vec3{0, 0, 1} : Vec3{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0});
            joints_->respond(columns_);
            const std::size_t c = own.first + axis;
            for (const Place& other : places_)
            {
                if (other.line)
                    at(other.first, c) = rate_of(columns_, problem.lines[other.index]);
                else
                {
                    const Vec3 u = relative_velocity_of(columns_, problem.points[other.index]);
                    if (other.count == 1)
                        at(other.first, c) = u.z;
                    else
                        at(other.first, c) = u.x, at(other.first + 1, c) = u.y, at(other.first + 2, c) = u.z;
                }
                if (&other - places_.data() < static_cast<std::ptrdiff_t>(from))
                    for (std::uint32_t r = other.first; r < other.first + other.count; ++r) at(c, r) = at(r, c);
            }
        }
}

/// A row of a loop that others imply, or one that resists what joints hold, has nothing to do. False where a bounded row cannot move
/// anything.
bool DelassusSolver::take_row(const Problem& problem, const Place& place, Line& line, double locked)
{
    const std::uint32_t f = place.first;
    line = problem.lines[place.index];
    const bool moves = W(f, f) > locked * line.mobility;
    if (!moves && !line.resists() && !(is_joint(line) && line.compliance == 0)) return false;
    if (!moves) line.count = 0;
    line.mobility = W(f, f);
    q_[f] = problem.rate(line), r_[f] = moves ? line.impulse : 0.0;
    return true;
}

/// Where the mechanism cannot slide at a point, friction there has nothing to do. False where it cannot open it.
bool DelassusSolver::take_point(const Problem& problem, const Place& place, Point& p, double locked)
{
    const std::uint32_t f = place.first, normal = f + place.count - 1;
    p = problem.points[place.index];
    const Vec3 u = problem.relative_velocity(p);
    if (!(W(normal, normal) > locked * p.K(2, 2))) return false;
    const double slip = p.slip_mobility;
    p.K = {};
    if (place.count == 1)
    {
        p.K(2, 2) = W(f, f), q_[f] = u.z, r_[f] = p.impulse.z;
        return true;
    }
    for (std::uint32_t i = 0; i < 3; ++i)
        for (std::uint32_t k = 0; k < 3; ++k) p.K(i, k) = W(f + i, f + k);
    p.slip_mobility = slip_mobility(p.K);
    if (!(p.slip_mobility > kLocked * slip)) p.friction = 0, p.impulse.x = p.impulse.y = 0;
    q_[f] = u.x, q_[f + 1] = u.y, q_[f + 2] = u.z;
    r_[f] = p.impulse.x, r_[f + 1] = p.impulse.y, r_[f + 2] = p.impulse.z;
    return true;
}

/// Takes the points and rows over, with the mobilities of the mechanism, and the guess. The movers have the velocities without r.
bool DelassusSolver::set_up(const Problem& problem, double locked)
{
    points_.clear(), lines_.clear();
    q_.resize(size_), r_.resize(size_), u_.resize(size_);
    return std::ranges::all_of(places_,
                               [&](const Place& place)
                               {
                                   Point& p = points_.emplace_back();
                                   Line& line = lines_.emplace_back();
                                   return place.line ? take_row(problem, place, line, kLocked) : take_point(problem, place, p, locked);
                               });
}

/// Gives r to the problem, and the velocities of the whole mechanism with it.
void DelassusSolver::take_velocities(Problem& problem)
{
    columns_.assign(problem.movers.size(), Column6{});
    for (std::size_t k = 0; k < places_.size(); ++k)
    {
        const Place& place = places_[k];
        if (place.line)
        {
            problem.lines[place.index].impulse = r_[place.first];
            add_push(columns_, problem.lines[place.index], r_[place.first]);
            continue;
        }
        problem.points[place.index].impulse = points_[k].impulse;
        add_push(columns_, problem.points[place.index], points_[k].impulse);
    }
    joints_->move_with(problem, columns_);
    for (std::size_t m = 0; m < columns_.size(); ++m) problem.movers[m].v = first(columns_[m]), problem.movers[m].w = last(columns_[m]);
}

}  // namespace plab::managers
