/// The parts of a step of an island by speeds first, positions after (advance_island.h): impacts, targets of the rest, positions.
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

    void join(const Verdict& other);
};

/// How a manager finds impulses.
class Method
{
public:
    virtual ~Method() = default;
    /// Impulses of `problem` from its present ones; speeds agree with them before and afterwards.
    virtual Verdict find_impulses(Problem& problem) = 0;
    /// The same for displacements (m instead of m/s), without friction.
    virtual Verdict find_displacements(Problem& problem, double tolerance) = 0;
};

/// Overlap or joint error that is left alone: share of the island's size, or rad.
inline constexpr double kPositionTolerance = 0x1p-30;
/// Least speed of a contact that cannot act now.
inline constexpr double kFar = -1e30;

struct StepMemory
{
    Problem problem;
    std::vector<Vec3> velocities;  ///< m/s, at the start of the step
    std::vector<Vec3> impulses;    ///< N s, of parts of the step that are over
    std::vector<double> line_impulses;
    std::vector<Vec3> separations;  ///< of impacts
    std::vector<Vec3> impacts;      ///< N s, by point; none if nothing met
    std::vector<double> passing;    ///< m/s, <= 0: what an impact leaves closing, for the next step's to answer
    struct Speeds
    {
        Vec3 velocity, spin, momentum;
        double shaft = 0;
    };
    std::vector<Speeds> speeds;
};

/// Contacts up to which the ends of slip are looked for inside the step: in a pile there is always one.
struct StepChoices
{
    std::size_t slip_ends_up_to = 16;
    /// m: overlap that is left, and gaps that hold as if they were closed: contacts that tremble less than this keep holding.
    double slop = 0;
    /// Part of the overlap beyond that is parted in a step.
    double correction_share = 1;
};

Verdict answer_impacts(Island& island, Bodies& bodies, Shafts& shafts, Method& method, StepMemory& memory);
/// What speeds may be at the end of h; `passing` as in StepMemory, or none.
void set_targets(Problem& problem, const Island& island, double h, double slop, std::span<const double> passing = {});
Verdict part_overlap(Island& island, Bodies& bodies, Shafts& shafts, Method& method, const StepChoices& choices, StepMemory& memory);
/// With the mean of old and new speeds; where impulses are not what they should be, with the new ones: those keep gaps from
/// closing, means of them with speeds into an overlap would not.
void move(const Island& island, const Verdict& found, double h);
void store_impulses(const Problem& problem, Island& island);
/// Moves and turns by the movers' speeds taken as displacements.
void displace(const Problem& problem, Bodies& bodies, Shafts& shafts);

}  // namespace plab::managers
