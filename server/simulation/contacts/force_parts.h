/// Into how many parts the step of an island is divided because the forces on its members change too fast for one evaluation in a step.
///
/// Contacts are stepped with forces that are evaluated once, halfway through the advance. A spring of frequency w is stable in such a step
/// up to h w = 2, and accurate to (h w)^2 / 24. A cloth that lies on a ball, or a machine on stiff feet, is far beyond that, and would
/// gain energy without bound as soon as it touches something. So the forces of each group are measured at the start of an advance: with
/// the changes K x and C v of the accelerations by displacements x and speeds v,
///
///   h^2 |K| / n^2 + h |C| / n <= 1/4,   that is h w <= 1/2 in each of n parts.
///
/// Both are found by differences: two rounds of the power method (Golub, Van Loan, Matrix Computations, 7.3.1) for h^2 K + h C in the norm
/// of the kinetic energy, from a random direction that depends on the number of the member in its group alone. Differences span a small
/// part of the bodies' size, so forces that change no further, as those of dry friction in a script, do not count. The result follows
/// from the state alone: trials, rewinds and replays divide alike.
///
/// Limits: groups with joints are not measured, as what a spring does there depends on what its joints let move; their steps are divided
/// only if they touch a group that asks for it. Islands with contacts by force (Response/Penalty) have pieces of their own.
#pragma once

#include <span>
#include <vector>

#include "simulation/motion/group_motion.h"

namespace plab::simulation
{

class ForceParts
{
public:
    ForceParts(StepState& step, GroupMotion& motion) : step_(step), motion_(motion) {}

    static constexpr double kMost = 64;

    /// After any structural change: lists the groups without joints on which forces act that depend on time or state.
    void rebuild();
    void begin_step() { needed_ = 1, stiffest_ = kNoIndex; }
    /// Measures the forces on `groups` (ascending) at their present state, for an advance from `from` to `to` (s since the start of the
    /// step). Returns whether some of them has to be divided.
    bool measure(std::span<const std::uint32_t> groups, double from, double to);
    /// Of a group that was measured last: 1 to kMost.
    std::uint32_t of(std::uint32_t group) const { return parts_[group]; }
    /// Emits force.stiff, once, if in this step some group needed more than kMost parts.
    void finish_step();

private:
    /// Six numbers for each body: m, and m of rotation about the axes of B at the radius of gyration; one for each shaft: rad. Or their
    /// accelerations times h^2.
    using Numbers = std::vector<double>;
    struct Member
    {
        std::uint32_t group = 0;         ///< place among the groups that are measured together
        std::size_t begin = 0, end = 0;  ///< of its numbers
        double size = 0, mass = 1;       ///< m, radius of gyration; kg
        std::span<const double> of(const Numbers& n) const { return std::span(n).subspan(begin, end - begin); }
    };
    /// Of the members of a group, as they are measured together.
    struct Measured
    {
        std::uint64_t members = 0;
        double reach = 0;                  ///< m: displacement of a member whose direction has length 1
        double direction = 0;              ///< kg m^2: square of the norm
        double change = 0, by_speeds = 0;  ///< likewise, of h^2 K x + h C v and of h C v; change - by_speeds is that of h^2 K x
        double largest = 0;                ///< m: change of a single member
    };
    void measure_together(std::span<const std::uint32_t> groups, double from, double to);
    void list_members(const GroupSystem& system, std::span<const std::uint32_t> groups);
    void choose_directions();
    void accelerations(const GroupSystem& system, double h, Numbers& out) const;
    void find_change(GroupSystem& system, double h, bool of_positions, Numbers& out);
    void find_largest();
    template <class Length>
    void follow_change(const Length& length);
    void divide(std::span<const std::uint32_t> groups);

    StepState& step_;
    GroupMotion& motion_;
    std::vector<std::uint8_t> depends_;  ///< by group
    std::vector<std::uint32_t> parts_;   ///< by group
    bool any_ = false, any_divided_ = false;
    double needed_ = 1;                  ///< in this step, the most
    std::uint32_t stiffest_ = kNoIndex;  ///< the group that needed them
    // Of the groups that are measured together.
    std::vector<std::uint32_t> plain_, place_;  ///< groups; by group: its place among them
    std::vector<Member> members_;
    std::vector<Measured> measured_;
    Numbers speeds_, direction_, start_, change_, by_speeds_;
};

}  // namespace plab::simulation
