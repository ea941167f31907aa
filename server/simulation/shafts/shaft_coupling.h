/// Phase::Couple over reduced coordinates: pairwise couplings and one-way drives, swept until nothing changes.
///
/// Only roots have a rate of their own; a joined shaft's is rho times its root's, its mobility rho^2 / J_root. The same
/// sweep (Gauss-Seidel) serves accelerations in the solver's stages and speeds at step starts and after impulses.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "plab/shafts.h"
#include "plab/tables.h"
#include "simulation/shafts/constraint_graph.h"

namespace plab::simulation
{

/// Sweeps end when no rate changes by more than this share of the largest value that it had: some rounding errors.
inline constexpr double kCouplingTolerance = 4e-15;
inline constexpr int kMaxCouplingSweeps = 1000;
/// They end, too, when the largest change has not come down to this share of itself over as many sweeps as a change takes
/// through the longest train, twice: what contradicts itself moves to and fro for ever.
inline constexpr double kCouplingStagnation = 0.995;
inline constexpr std::size_t kLeastSweepsCompared = 32;
/// Two drives of one root agree if their rates differ by no more than this, relative.
inline constexpr double kDriveTolerance = 1e-12;

/// Two components drive one shaft, or shafts that the graph joins, at different rates. The first one is obeyed.
struct DriveConflict
{
    std::uint32_t first = 0, second = 0;     ///< components
    std::uint32_t shaft = 0;                 ///< the second's driven
    double first_rate = 0, second_rate = 0;  ///< of that shaft
};

struct CouplingReport
{
    int sweeps = 0;
    double residual = 0;    ///< largest change of the last sweep, relative
    bool converged = true;  ///< false: residual above the tolerance after the last allowed sweep, or no longer falling
    std::optional<DriveConflict> conflict;
};

class ShaftCoupling final : public ShaftMotion
{
public:
    // A solve: begin, sweeps, results. Graph and shafts must outlive it
    // --------------------------------------------------
    /// Accelerations under `torque` (N m, by shaft) of the dynamic `members`, in id order, and of prescribed ones (0).
    void begin_accelerations(const ConstraintGraph& graph, const Shafts& shafts, std::span<const double> torque,
                             std::span<const std::uint32_t> members, std::span<const std::uint32_t> prescribed);
    /// Speeds as they are; those of joined shafts must be consistent (ConstraintGraph::engage).
    void begin_speeds(const ConstraintGraph& graph, const Shafts& shafts, std::span<const std::uint32_t> members,
                      std::span<const std::uint32_t> prescribed);
    /// Runs `couple_all` (all Phase::Couple rows, in order) until nothing changes, or what changes no longer falls.
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
    double largest_change() const { return largest_change_; }
    /// The largest |rate| of a shaft in this solve.
    double scale(Ref shaft) const;

    /// rad/s^2 or rad/s of all members, by shaft.
    void store_rates(std::span<double> out) const;
    /// Writes the speeds that the sweeps changed, and no others. Begun with begin_speeds.
    void store_speeds(Shafts& shafts) const;
    /// Adds share * power (W), or share * work (J) after begin_speeds, by component; on dynamic shafts only. Couplings
    /// of the graph between dynamic shafts do none in sum; to a prescribed shaft they transmit its motor's.
    void account(std::vector<double>& work, double share);

    // ShaftMotion
    // --------------------------------------------------------------------------------------------------------
    void begin(std::uint32_t component, Ref driven) override;
    double rate(Ref shaft) const override;
    double mobility(Ref shaft) const override;
    void apply(Ref shaft, double torque) override;
    void assign(Ref shaft, double rate) override;

    // For reactions
    // ------------------------------------------------------------------------------------------------------
    bool at_accelerations() const { return level_ == Level::Acceleration; }
    const ConstraintGraph& graph() const { return *graph_; }
    /// N m on a shaft: forces, pairwise couplings, and what a one-way drive or prescribed motion takes to be obeyed.
    double total_torque(std::uint32_t shaft) const;
    /// Components that began in this solve, in order, and what each did to its driven shaft (N m).
    std::span<const std::uint32_t> participants() const { return participants_; }
    double reaction(std::uint32_t component) const;
    /// Whether the shaft is a member, or prescribed, in this solve.
    bool takes_part(std::uint32_t shaft) const { return member_[shaft] == solve_; }
    bool takes_part(const ShaftTree& tree) const { return entered(tree.root); }

private:
    enum class Level : std::uint8_t
    {
        Acceleration,
        Speed
    };
    struct Root
    {
        double rate = 0;
        double mobility = 0;              ///< 1 / inertia; 0 for prescribed motion
        double inertia = 0;               ///< at the root, dynamic members only
        double torque = 0;                ///< at the root, forces and what was applied
        double scale = 0;                 ///< largest |rate| in this solve
        std::uint64_t solve = 0;          ///< in which the rest is valid
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
    void take_in(std::uint32_t shaft, double torque);
    bool entered(std::uint32_t root) const { return roots_[root].solve == solve_; }
    std::uint32_t root_of(Ref shaft) const { return shafts_->root[shaft.index]; }
    double inertia_of(std::uint32_t root) const;
    bool assigned(const Root& r) const { return r.driver != kNoIndex; }
    /// Torque at the root beyond what was applied: of a one-way drive, or of prescribed motion.
    double holding_torque(const Root& r) const { return r.inertia * r.rate - r.torque; }
    void change_rate(Root& r, double rate);
    void account_prescribed(const ShaftTree& tree, std::vector<double>& work, double share);

    const ConstraintGraph* graph_ = nullptr;
    const Shafts* shafts_ = nullptr;
    std::span<const std::uint32_t> members_;
    Level level_ = Level::Acceleration;
    std::uint64_t solve_ = 0, sweep_ = 0;
    std::uint32_t current_ = kNoIndex;  ///< component
    double largest_change_ = 0;
    std::optional<DriveConflict> conflict_;
    std::vector<Root> roots_;            // by shaft
    std::vector<double> torque_;         // by shaft, N m (s); of those that take part
    std::vector<std::uint64_t> member_;  // by shaft: the last solve that it took part in
    std::vector<Share> shares_;          // by component
    std::vector<std::uint32_t> participants_;
    std::vector<double> below_;  // by node
};

}  // namespace plab::simulation
