/// The impulses of joints and of the changes of forces with which all of these rows hold exactly, while contacts, limits and motors keep
/// the impulses that they have: a linear problem, with a sparse matrix that for chains and trees costs time in proportion to their joints.
///
/// Sweeps pass a load on from joint to joint, so a chain of light links under a heavy load stretches, and a servo that is stiff against the
/// inertia of its links needs hundreds of them. Methods that sweep use this before and between their sweeps.
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
    /// Changes the impulses of the rows, and the velocities of the movers with them. Forces with bounds act within these. Rows that
    /// contradict one another stay apart.
    void hold(Problem& problem, double tolerance);
    /// The same, and sums the impulses anew. Joints that hold remove energy from what the other impulses leave, but these may have been
    /// found for joints that yield. If more energy results than there was, they are halved, and dropped in the end.
    void hold_without_gain(Problem& problem, double tolerance);

private:
    bool choose(const Problem& problem);
    double find_changes(const Problem& problem);

    IslandMatrix matrix_;
    std::vector<Column6> step_;
    std::vector<double> stiffness_, changes_;  ///< by line; a stiffness of 0: the row keeps its impulse
};

}  // namespace plab::managers
