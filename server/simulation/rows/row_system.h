/// The joints of some groups: Lagrange multipliers that hold their rows inside a solver's stages, and the projection of the finished step
/// onto the rows.
///
/// The constraints are enforced at acceleration level (index 1): M a = f + J^T lambda, J a = bias. The drift that remains is removed
/// after the step by projecting positions and then speeds in the norm of M, which preserves the order of the solver:
///
///   positions   q += M^-1 J^T mu,  J M^-1 J^T mu = -phi(q),        repeated until phi is at rounding level (a Newton method)
///   speeds      v += M^-1 J^T nu,  J M^-1 J^T nu = rate - J v,     once, up to rounding
///
/// Of all states that satisfy the rows this is the one at the least distance, measured with the masses. Both are solved as the equations
/// of row_equations.h with g = 0, which never multiply J M^-1 J^T out. Contradictory rows are fitted: row_positions.cpp.
///
/// Sources: D. Baraff, "Linear-time dynamics using Lagrange multipliers", SIGGRAPH 1996 (M and J kept apart, in tree order); E. Hairer,
/// G. Wanner, "Solving ordinary differential equations II", VII.2 (projection preserves the order).
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "plab/rows.h"
#include "plab/wrenches.h"
#include "simulation/groups/groups.h"
#include "simulation/rows/row_equations.h"
#include "simulation/shafts/constraint_graph.h"

namespace plab::simulation
{

struct ProjectionReport
{
    int iterations = 0;
    double position_error = 0;    ///< largest remaining |phi|, m or rad
    double speed_error = 0;       ///< largest remaining |J v - rate|
    std::uint32_t redundant = 0;  ///< rows that the others imply
    bool converged = true;
    bool places_hold = true;                   ///< positions satisfy their rows; a contradiction, if any, concerns speeds only
    std::vector<std::uint32_t> contradictory;  ///< components (directory indices) whose rows cannot hold together, in id order
};

/// Source of the rows: emits all rows at the state of the host tables in a fixed order, those of one component adjacent.
class RowSource
{
public:
    virtual ~RowSource() = default;
    virtual void constrain(const StepContext& context, RowSink& sink) = 0;
};

/// Where the work of rows is booked, and for which objects. Empty spans: for all.
struct RowBook
{
    std::vector<double>* work = nullptr;  ///< J by component; null: no booking
    double sign = 1;                      ///< -1 cancels an earlier booking
    std::span<const std::uint8_t> bodies, shafts;
};

/// What joints report to Phase::Finish, for all groups.
class RowReportTable final : public RowReports
{
public:
    void clear(std::size_t components) { reports_.assign(components, RowReport{}); }
    RowReport& at(std::uint32_t component) { return reports_[component]; }
    RowReport of(std::uint32_t component) const override { return component < reports_.size() ? reports_[component] : RowReport{}; }

private:
    std::vector<RowReport> reports_;  ///< by component
};

class RowSystem
{
public:
    RowSystem();
    ~RowSystem();
    RowSystem(const RowSystem&) = delete;
    RowSystem& operator=(const RowSystem&) = delete;
    RowSystem(RowSystem&&) noexcept;
    RowSystem& operator=(RowSystem&&) noexcept;

    /// Selects the rows (of Phase::Constrain) of some groups. The rows may move the dynamic participants; all groups to which such a
    /// participant belongs must be advanced together. Memory is kept between calls.
    void configure(world::World& world, const Schedule& schedule, std::span<const BlockRow> rows, const ConstraintGraph& graph);
    /// The same without a world: rows come from `source`, which must outlive this object.
    void configure(world::HostTables& host, RowSource& source, const ConstraintGraph& graph);
    /// No component can add rows, so no other function needs to be called.
    bool empty() const { return source_ == nullptr; }

    /// Collects the rows at the present state of the tables. Shafts are replaced by the roots of their trains. Impulses are set to 0.
    void collect(const StepContext& context);
    std::span<ConstraintRow> rows() { return rows_; }
    std::span<const ConstraintRow> rows() const { return rows_; }
    /// A row of the last collect() may yield (a limit or a bounded motor), so a manager has to hold the rows.
    bool may_yield() const { return may_yield_; }

    /// collect(), then computes the multipliers with which J a = bias under the present wrenches, and adds their forces to the wrenches.
    /// Rows that may yield are left out. Returns false if the result is not finite; the wrenches are then unchanged.
    bool react(const StepContext& context, Wrenches& wrenches);
    /// Adds `share` (s) times the power of each component's rows in the last react() to the book. Ideal constraints do no work; only
    /// prescribed rates and kinematic participants do.
    void account(const RowBook& book, double share) const;

    /// Projects the members onto their rows: first poses (error = 0), then speeds (J v = rate). To be called at the end of an advance.
    /// Kinetic energy that contradictory rows remove is booked to their components.
    ProjectionReport project(const StepContext& context, const RowBook& book = {});
    /// Projects the speeds only. The change of kinetic energy is booked to the components.
    ProjectionReport project_speeds(const StepContext& context, const RowBook& book = {});
    /// At the start of an advance: makes speeds fit their rows by impulses if they do not (a joint was added, a request or an impact
    /// changed a speed, a motor's rate jumped). Depends on the present state alone; speeds that a projection has just made consistent are
    /// not changed in any bit.
    void join(const StepContext& context, const RowBook& book);

    /// collect(), for a manager that will hold the rows during the advance, and `further` rows that move the same members.
    void begin_hold(const StepContext& context, std::span<const ConstraintRow> further = {});
    /// To be called after the manager held the rows over h (s): `held` are the same rows with their impulses (N s), in the same order.
    /// Stores what is reported about them and the errors that remain at the present state. Books their work, computed with the mean of
    /// the speeds before and after, and returns its sum (J).
    double take_impulses(const StepContext& context, std::span<const ConstraintRow> held, double h, const RowBook& book);
    /// Joints held by other means than multipliers (simulation/articulated): there are none, until react() computes some.
    void forget_multipliers() { lambda_.clear(); }
    /// To be called after project(): the reactions to report, for each component that has rows, in the order of its rows.
    template <class Reactions>
    void take_reactions(const Reactions& reactions)
    {
        reactions_.clear();
        for (const auto& r : reactions) reactions_.push_back({r.component, r.force, r.torque});
    }
    /// Writes what the last react() or take_impulses(), and the last projection, found.
    void report_to(RowReportTable& table) const;

private:
    class Sink;
    class RowsOfComponents;
    /// A block as its component emitted it, before a shaft was replaced by the root of its train.
    struct Geared
    {
        std::uint32_t row = 0, block = 0;
        Ref participant;
        double coefficient = 0;
    };

    /// Of a member, before a step of the projection.
    struct Pose
    {
        Vec3 position;
        Quat orientation;
        double angle = 0;  ///< of a shaft, rad
    };
    struct Reaction
    {
        std::uint32_t component = 0;
        Vec3 force, torque;  ///< on the last participant, N and N m
    };

    void keep_reactions();
    void load_forces(const Wrenches& wrenches);
    void add_reactions(Wrenches& wrenches) const;
    bool regularize_near_singular(double dt);
    double speed_norm() const;
    void relax_positions(const StepContext& context, ProjectionReport& report);
    void fit_positions(const StepContext& context, ProjectionReport& report);
    void satisfy_trees(const StepContext& context);
    bool solve_positions(double compliance);
    double square_of_errors(double share) const;
    double move_members(const StepContext& context);
    void save_poses();
    void restore_poses(const StepContext& context);
    double measure_rows(const StepContext& context);
    void match_speeds(const StepContext& context, ProjectionReport& report);
    void correct_speeds(const StepContext& context, bool least_squares);
    void change_speeds(const StepContext& context);
    void add_speed_work();
    void book_speed_work(const RowBook& book) const;
    bool books(const ConstraintRow& row, const RowBook& book) const;
    bool misfits(double dt) const;
    double measure_positions();
    double measure_speeds(double dt);
    double position_scale(const ConstraintRow& row) const;
    double speed_of(const RowBlock& block) const;
    double speed_of(const ConstraintRow& row) const;
    double speed_scale(const ConstraintRow& row, double dt) const;
    double position_at_hand(const ConstraintRow& row) const;
    double speed_at_hand(std::size_t index, double dt) const;
    bool positions_contradict() const;
    bool speeds_contradict(double dt) const;
    double speed_of_others(const ConstraintRow& row) const;
    double book_work(const ConstraintRow& held, std::size_t place, const ConstraintRow& now, const RowBook& book);
    bool is_mobile(Ref participant) const;
    void count_redundant(ProjectionReport& report);
    void name_contradictory(std::span<const double> errors, ProjectionReport& report) const;

    world::HostTables* host_ = nullptr;
    const ConstraintGraph* graph_ = nullptr;
    RowSource* source_ = nullptr;
    std::unique_ptr<RowsOfComponents> scheduled_;
    RowEquations equations_;

    std::vector<ConstraintRow> rows_;
    std::vector<Geared> geared_;  ///< in the order of rows
    std::vector<RowPiece> pieces_;
    std::vector<double> lambda_;                        ///< by row, N or N m
    std::vector<double> position_error_, speed_error_;  ///< by row, after the last projection
    std::vector<double> speed_work_;                    ///< J by row, of the last projection of speeds
    std::vector<std::uint32_t> redundant_;              ///< by piece
    std::vector<Pose> poses_;                           ///< by member
    std::vector<double> weights_;                       ///< of F, by slot (row_positions.cpp)
    std::vector<double> held_speed_;                    ///< by row that a manager holds: J v of the dynamic members at the start
    std::vector<Reaction> reactions_;
    bool may_yield_ = false;
    bool factored_ = false;  ///< the equations hold a factorisation for a state close to the present one
};

}  // namespace plab::simulation
