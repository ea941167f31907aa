/// Phase::Couple: pairwise couplings and one-way drives between shafts, solved iteratively over the reduced coordinates of the constraint
/// graph.
///
/// Only roots of trains have a rate of their own (a speed or an acceleration). A joined shaft has rho times the rate of its root and the
/// mobility rho^2 / J_root. One sweep runs all Couple commands once: each command reads the rates of its two shafts and applies the
/// torque (or impulse) that restores its ratio, which changes the rates that the following commands read. Sweeps are repeated until
/// nothing changes: this is the Gauss-Seidel method. The same sweep serves accelerations in the solver's stages and speeds at the start
/// of a step and after impulses.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "plab/shafts.h"
#include "plab/tables.h"
#include "simulation/shafts/constraint_graph.h"
#include "simulation/shafts/member_index.h"

namespace plab::simulation
{

/// Sweeps end when no rate changes by more than this share of the largest value that it had; a few rounding errors.
inline constexpr double kCouplingTolerance = 4e-15;
inline constexpr int kMaxCouplingSweeps = 1000;
/// They also end if the largest change has not fallen below this share of itself. The check is made after as many sweeps as a change
/// needs to pass the longest train twice. Contradictory couplings oscillate for ever and end this way.
inline constexpr double kCouplingStagnation = 0.995;
inline constexpr std::size_t kLeastSweepsCompared = 32;
/// Relative tolerance within which two drives of the same root agree.
inline constexpr double kDriveTolerance = 1e-12;

/// Two components drive the same shaft, or shafts that the graph joins, at different rates. The first one takes precedence.
struct DriveConflict
{
    std::uint32_t first = 0, second = 0;     ///< components
    std::uint32_t shaft = 0;                 ///< driven by the second one
    double first_rate = 0, second_rate = 0;  ///< of that shaft
};

struct CouplingReport
{
    int sweeps = 0;
    double residual = 0;    ///< largest change of the last sweep, relative
    bool converged = true;  ///< false: residual above the tolerance after the last permitted sweep, or no longer decreasing
    std::optional<DriveConflict> conflict;
};

class ShaftCoupling final : public ShaftMotion
{
public:
    /// Prepares for solves of these shafts. Keeps its memory. Without it, shafts are numbered as they come, which takes more time.
    void configure(std::span<const std::uint32_t> members, std::span<const std::uint32_t> prescribed);

    // One solve: begin, sweeps, results. Graph and shafts must outlive it.
    // --------------------------------------------------
    /// Starts from the accelerations under `torque` (N m, by shaft) of the dynamic `members`, in id order; those of prescribed shafts are
    /// 0.
    void begin_accelerations(const ConstraintGraph& graph, const Shafts& shafts, std::span<const double> torque,
                             std::span<const std::uint32_t> members, std::span<const std::uint32_t> prescribed);
    /// Starts from the present speeds; those of joined shafts must be consistent (ConstraintGraph::engage).
    void begin_speeds(const ConstraintGraph& graph, const Shafts& shafts, std::span<const std::uint32_t> members,
                      std::span<const std::uint32_t> prescribed);
    /// Calls `couple_all`, which runs all rows of Phase::Couple in order, until nothing changes or the changes stop decreasing.
    template <class CoupleAll>
    CouplingReport solve(CoupleAll&& couple_all, int max_sweeps = kMaxCouplingSweeps, double tolerance = kCouplingTolerance)
    {
        CouplingReport report;
        double before = std::numeric_limits<double>::infinity();
        do {
            start_sweep();
            couple_all();
            ++report.sweeps;
            if (static_cast<std::size_t>(report.sweeps) % std::max(kLeastSweepsCompared, 2 * participants_.size()) != 0) continue;
            if (!(largest_change_ < kCouplingStagnation * before)) break;
            before = largest_change_;
        } while (largest_change_ > tolerance && report.sweeps < max_sweeps);
        report.residual = largest_change_, report.converged = largest_change_ <= tolerance;
        report.conflict = conflict_;
        return report;
    }
    void start_sweep();
    /// The largest |rate| of a shaft during this solve.
    double scale(Ref shaft) const;

    /// Writes only the speeds that the sweeps changed. Requires begin_speeds().
    void store_speeds(Shafts& shafts) const;
    /// Adds share * power (W), or share * work (J) after begin_speeds(), by component, for dynamic shafts only. Couplings of the graph
    /// between dynamic shafts do no net work; those to a prescribed shaft transmit the work of its motor.
    void account(std::vector<double>& work, double share);

    // ShaftMotion
    // --------------------------------------------------------------------------------------------------------
    void begin(std::uint32_t component, Ref driven) override;
    double rate(Ref shaft) const override;
    double mobility(Ref shaft) const override;
    void apply(Ref shaft, double torque) override;
    void assign(Ref shaft, double rate) override;

    // For the reported torques.
    // ------------------------------------------------------------------------------------------------------
    bool at_accelerations() const { return level_ == Level::Acceleration; }
    const ConstraintGraph& graph() const { return *graph_; }
    /// Calls each(tree) for the trees whose root takes part.
    template <class Each>
    void for_each_tree(Each&& each) const
    {
        for (const std::uint32_t shaft : index_.members())
            if (const ShaftTree* tree = graph_->tree_of(shaft); tree && tree->root == shaft && entered(shaft)) each(*tree);
    }
    /// N m on a shaft: forces, pairwise couplings, and the torque with which a one-way drive or a prescribed motion is maintained.
    double total_torque(std::uint32_t shaft) const;
    /// Components that acted in this solve, in order, and the torque that each applied to its driven shaft (N m).
    std::span<const std::uint32_t> participants() const { return participants_; }
    double reaction(std::uint32_t component) const;
    /// Whether the shaft is a member of this solve, or prescribed in it.
    bool takes_part(std::uint32_t shaft) const
    {
        const std::uint32_t i = index_.find(shaft);
        return i != kNoIndex && members_[i].solve == solve_;
    }

private:
    enum class Level : std::uint8_t
    {
        Acceleration,
        Speed
    };
    /// A shaft that takes part.
    struct Member
    {
        std::uint64_t solve = 0;  ///< the last one that it took part in
        double torque = 0;        ///< N m (s), in that solve
    };
    /// The same if it is a root.
    struct Root
    {
        double rate = 0;
        double mobility = 0;              ///< 1 / inertia; 0 for prescribed motion
        double inertia = 0;               ///< at the root, dynamic members only
        double torque = 0;                ///< at the root: forces and everything applied
        double scale = 0;                 ///< largest |rate| in this solve
        std::uint64_t solve = 0;          ///< in which the other values are valid
        std::uint64_t sweep = 0;          ///< in which it was last assigned
        std::uint32_t driver = kNoIndex;  ///< component that assigns it
        std::uint32_t driven = kNoIndex;  ///< shaft that is assigned
        bool touched = false;
    };
    struct Share
    {
        std::uint64_t solve = 0;
        std::uint32_t driven = kNoIndex;
        double reaction = 0;  ///< N m (s) applied to driven
        double work = 0;      ///< W or J
    };

    void begin_level(Level level, const ConstraintGraph& graph, const Shafts& shafts);
    Root& enter(std::uint32_t root, double rate);
    /// Its number.
    std::uint32_t take_in(std::uint32_t shaft, double torque);
    /// Null unless the root was entered in this solve.
    const Root* entered(std::uint32_t root) const
    {
        const std::uint32_t i = index_.find(root);
        return i != kNoIndex && roots_[i].solve == solve_ ? &roots_[i] : nullptr;
    }
    Root* entered(std::uint32_t root) { return const_cast<Root*>(std::as_const(*this).entered(root)); }
    Share& share_of(std::uint32_t component) { return shares_[components_.find(component)]; }
    const Share& share_of(std::uint32_t component) const { return shares_[components_.find(component)]; }
    std::uint32_t root_of(Ref shaft) const { return shafts_->root[shaft.index]; }
    double inertia_of(std::uint32_t root) const;
    bool assigned(const Root& r) const { return r.driver != kNoIndex; }
    /// Torque at the root in addition to what was applied: that of a one-way drive or of a prescribed motion.
    double holding_torque(const Root& r) const { return r.inertia * r.rate - r.torque; }
    void change_rate(Root& r, double rate);
    void account_prescribed(const ShaftTree& tree, std::vector<double>& work, double share);

    const ConstraintGraph* graph_ = nullptr;
    const Shafts* shafts_ = nullptr;
    std::span<const std::uint32_t> dynamic_;
    Level level_ = Level::Acceleration;
    std::uint64_t solve_ = 0, sweep_ = 0;
    std::uint32_t current_ = kNoIndex;  ///< component
    std::uint32_t current_share_ = 0;   ///< its number
    std::uint32_t next_ = 0;            ///< number of the component that is likely to come next
    double largest_change_ = 0;
    std::optional<DriveConflict> conflict_;
    MemberIndex index_;            // of shafts
    std::vector<Member> members_;  // by number of the shaft
    std::vector<Root> roots_;      // likewise
    MemberIndex components_;
    std::vector<Share> shares_;  // by number of the component
    std::vector<std::uint32_t> participants_;
    std::vector<double> below_;  // by node of a tree
};

}  // namespace plab::simulation
