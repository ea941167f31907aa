/// The impulses of the rows of an island (joints, limits, motors, changes of forces) with which they hold exactly, while contacts keep the
/// impulses that they have. Rows that act within their bounds make a linear problem, with a sparse matrix that for chains and trees costs
/// time in proportion to their joints; which ones do so is found in rounds (an active-set method).
///
/// Sweeps pass a load on from joint to joint, so a chain of light links under a heavy load stretches, and a servo that is stiff against the
/// inertia of its links needs hundreds of them. Methods that sweep use this before and between their sweeps. What resists rolling
/// (Line::resists) is left to the sweeps, as contacts are: it joins all that touches.
#pragma once

#include <vector>

#include "island_matrix.h"

namespace plab::managers
{

/// Whether a row is an equality, whose impulse has no bounds.
inline bool is_joint(const Line& line) { return line.count > 0 && line.least == -HUGE_VAL && line.most == HUGE_VAL; }
/// Whether a row is the change of a force that matters.
inline bool is_force(const Line& line) { return line.count > 0 && line.compliance > 0; }
inline bool has_forces(const Problem& problem)
{
    return std::any_of(problem.lines.begin(), problem.lines.end(), [](const Line& line) { return is_force(line); });
}

class JointSolver
{
public:
    /// Takes the rows of an island, for the next calls.
    void load(const Problem& problem);
    /// Whether holding the rows that were loaded costs time in proportion to the bodies, or not much more: not in a net of many loops, which
    /// fills its matrix.
    bool is_cheap(const Problem& problem) const;
    /// Changes the impulses of the rows, and the velocities of the movers with them. Rows that contradict one another stay apart.
    void hold(Problem& problem, double tolerance);
    /// The same where, since the last call, velocities have changed, and bodies have turned a little at most: with the matrix of that call,
    /// as long as the same rows act.
    void hold_again(Problem& problem, double tolerance);
    /// Loads and holds the rows if there are joints, and sums the impulses anew. Rows that hold remove energy from what the contacts leave, but these may
    /// have been found for joints that yield. If more energy results than there was, they are halved, and dropped in the end.
    void hold_without_gain(Problem& problem, double tolerance);

private:
    bool choose(const Problem& problem);
    double find_changes(const Problem& problem);

    IslandMatrix matrix_;
    std::vector<Column6> step_;
    std::vector<double> stiffness_, changes_;  ///< by line; a stiffness of 0: the row is at one of its bounds
};

}  // namespace plab::managers
