/// The parts of the step described in advance_island.h: impacts, velocity targets of the contact solve, position correction.
#pragma once

#include "joint_solver.h"

namespace plab::managers
{

struct Verdict
{
    int iterations = 0;
    double residual = 0;  ///< m/s
    bool converged = true;
    bool fell_back = false;
    bool put_back = false;  ///< nothing was done (StepChoices::or_nothing)

    void join(const Verdict& other);
};

/// A way of finding impulses: sweeps, or Newton's method.
class Method
{
public:
    virtual ~Method() = default;
    /// Finds the impulses of `problem`, starting from its present ones; velocities agree with the impulses before and
    /// afterwards.
    virtual Verdict find_impulses(Problem& problem) = 0;
    /// The same for displacements (m instead of m/s), without friction.
    virtual Verdict find_displacements(Problem& problem, double tolerance) = 0;
};

/// Overlap or joint error that is not corrected: as a fraction of the island's size, or in rad.
inline constexpr double kPositionTolerance = 0x1p-30;
/// Lower bound on u_n of a contact that cannot act now: so low that it never binds.
inline constexpr double kFar = -1e30;

struct StepMemory
{
    Problem problem;
    JointSolver joints;            ///< of methods that sweep
    std::vector<Vec3> velocities;  ///< m/s, at the start of the step
    std::vector<Vec3> impulses;    ///< N s, from the parts of the step that are done
    std::vector<double> line_impulses;
    std::vector<Vec3> rest;  ///< N s, of the rest of the step if nothing ends within it; of lines: N s or N m s
    std::vector<double> line_rest;
    std::vector<Vec3> separations;     ///< contact velocities before the impacts
    std::vector<double> line_rates;    ///< of the rows before the impacts
    std::vector<double> line_impacts;  ///< N s or N m s, by line; empty if there was no impact
    std::vector<Vec3> impacts;         ///< N s, W, by point; empty if there was no impact
    std::vector<double> passing;       ///< m/s, <= 0: closing speed that an impact leaves for the next step to answer
    struct Speeds
    {
        Vec3 velocity, spin, momentum;
        double shaft = 0;
    };
    std::vector<Speeds> speeds;

    void reserve(const IslandSize& size) { problem.reserve(size); }
};

/// Ends of sliding are located inside the step up to this many contacts: in a pile some contact always stops sliding.
struct StepChoices
{
    std::size_t slip_ends_up_to = 16;
    /// m: overlap that is tolerated, and gaps that are held as if closed, so that contacts that vibrate by less persist.
    double slop = 0;
    /// The fraction of the overlap beyond `slop` that is corrected in one step.
    double correction_share = 1;
    /// Where something collides, or the impulses do not converge, the step is not made, and all is as before. Ends of sliding are not
    /// located then.
    bool or_nothing = false;
};

/// Keeps the speeds of all movers in `memory`, and gives them back.
void keep_speeds(const Bodies& bodies, const Shafts& shafts, StepMemory& memory);
void take_back_speeds(const StepMemory& memory, Bodies& bodies, Shafts& shafts);

Verdict answer_impacts(Island& island, Bodies& bodies, Shafts& shafts, Method& method, StepMemory& memory);
/// Whether a row has an impulse at an instant, as in an impact: motors and forces have none.
inline bool acts_at_once(const ConstraintRow& row) { return row.kind == RowKind::Equality || row.kind == RowKind::OneSided; }
/// Whether a force changes so much within h (s) that its bodies hardly move along it: h (h k + c) is above what they weigh. `mobility`: J
/// M^-1 J^T.
inline bool is_stiff(const ConstraintRow& row, double mobility, double h)
{
    return row.kind == RowKind::ForceChange && h * (h * row.stiffness + row.damping) * mobility > 1;
}
/// Whether the error of the row is an angle.
bool turns_only(const ConstraintRow& row);
/// How the bodies will move after a kick.
enum class Moving : std::uint8_t
{
    ByMean,  ///< by the mean of their speeds before the kick and at the end
    ByEnd,   ///< by those at the end
};
/// By the mean, unless a damper would stop its bodies within a fraction of h: a speed that an impact leaves lasts no longer, and half of it
/// would take them far during h.
Moving how_to_move(const Problem& problem, double h);
/// Applies the forces during h (s).
void kick(Problem& problem, const Island& island, const Bodies& bodies, const Shafts& shafts, double h);
/// Sets what the contact velocities and row rates must be at the end of h; `passing` as in StepMemory, or empty.
void set_targets(Problem& problem, const Island& island, double h, double slop, Moving moving, std::span<const double> passing = {});
/// The same for the rows alone. The change of a force (RowKind::ForceChange) is that of the implicit midpoint rule, for which it is
/// evaluated where the bodies are halfway through the move. Damping counts with the speed theta v + (1 - theta) v_before, where theta is
/// such that a body on a damper alone slows down by exactly exp(-h c / m): 1/2 if that is slow, up to 1 for stiff dampers, whose speeds
/// would otherwise swing from one side to the other (exponential fitting; W. Liniger, R. Willoughby, SIAM J. Numer. Anal. 7 (1970)).
void set_line_targets(Problem& problem, const Island& island, double h, Moving moving);
Verdict correct_positions(Island& island, Bodies& bodies, Shafts& shafts, Method& method, const StepChoices& choices, StepMemory& memory);
/// Whether a violation (m/s) takes some body farther than 2^-23 of its size (or of a rad) in h (s).
inline bool matters(double residual, const Island& island, double h)
{
    return !(residual * h <= 0x1p-23 * (island.bodies.empty() ? 1 : island.size));
}
/// Moves. Where the impulses have not converged, and this matters, it does so with the new velocities in any case: these keep gaps from
/// closing, whereas their mean with velocities that lead into an overlap would not.
void move(const Problem& problem, const Island& island, const Verdict& found, double h, Moving moving);
/// Notes how far a move by h (s) takes the bodies along the rows of forces. To be called before it.
void note_move(const Problem& problem, const Island& island, double h, Moving moving);
void store_impulses(const Problem& problem, Island& island);
/// Adds the impulses of the points to what the island's contacts gave, if somebody asks for that.
void add_impulses(const Problem& problem, Island& island);
/// Moves and turns the bodies by the movers' velocities, taken as displacements.
void displace(const Problem& problem, Bodies& bodies, Shafts& shafts);

}  // namespace plab::managers
