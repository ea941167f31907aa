/// The parts of the step described in advance_island.h: impacts, velocity targets of the contact solve, position correction.
#pragma once

#include "problem.h"

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
    std::vector<Vec3> velocities;  ///< m/s, at the start of the step
    std::vector<Vec3> impulses;    ///< N s, from the parts of the step that are done
    std::vector<double> line_impulses;
    std::vector<Vec3> separations;     ///< contact velocities before the impacts
    std::vector<double> line_rates;    ///< of the rows before the impacts
    std::vector<double> line_impacts;  ///< N s or N m s, by line; empty if there was no impact
    std::vector<Vec3> impacts;         ///< N s, by point; empty if there was no impact; in the directions of the points, as `impulses`
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
/// Sets what the contact velocities and row rates must be at the end of h; `passing` as in StepMemory, or empty.
void set_targets(Problem& problem, const Island& island, double h, double slop, std::span<const double> passing = {});
/// The same for the rows alone.
void set_line_targets(Problem& problem, const Island& island, double h);
Verdict correct_positions(Island& island, Bodies& bodies, Shafts& shafts, Method& method, const StepChoices& choices, StepMemory& memory);
/// Moves with the mean of old and new velocities. Where the impulses have not converged it moves with the new velocities only:
/// these keep gaps from closing, whereas their mean with velocities that lead into an overlap would not.
void move(const Island& island, const Verdict& found, double h);
void store_impulses(const Problem& problem, Island& island);
/// Adds the impulses of the points to what the island's contacts gave, if somebody asks for that.
void add_impulses(const Problem& problem, Island& island);
/// Moves and turns the bodies by the movers' velocities, taken as displacements.
void displace(const Problem& problem, Bodies& bodies, Shafts& shafts);

}  // namespace plab::managers
