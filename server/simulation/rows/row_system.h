/// The joints of some groups: multipliers that hold their rows inside a solver's stages, and the projection of the
/// finished step onto them.
///
/// At acceleration level (index 1): M a = f + J^T lambda, J a = bias. Drift is taken away after the step by projection in
/// position and in speed, weighted by M, so that the solver keeps its order.
///
/// Sources: D. Baraff, "Linear-time dynamics using Lagrange multipliers", SIGGRAPH 1996 (M and J apart, in tree order);
/// E. Hairer, G. Wanner, "Solving ordinary differential equations II", VII.2 (projection keeps the order).
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
    double position_error = 0;    ///< largest |phi| left, m or rad
    double speed_error = 0;       ///< largest |J v - rate| left
    std::uint32_t redundant = 0;  ///< rows that others already imply
    bool converged = true;
    bool places_hold = true;                   ///< what contradicts, if anything, are speeds
    std::vector<std::uint32_t> contradictory;  ///< components (directory indices) that cannot hold together, in id order
};

/// Where rows come from: all rows at the state of the host tables, in a fixed order, those of a component in one piece.
class RowSource
{
public:
    virtual ~RowSource() = default;
    virtual void constrain(const StepContext& context, RowSink& sink) = 0;
};

/// Where the work of rows goes, and whose counts. Empty spans: everybody's.
struct RowBook
{
    std::vector<double>* work = nullptr;  ///< J by component; null: nobody books
    double sign = 1;                      ///< -1 takes back what was booked before
    std::span<const std::uint8_t> bodies, shafts;
};

/// What joints tell Phase::Finish, of all groups.
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

    /// The rows (of Phase::Constrain) of some groups, whose dynamic participants they may move; the groups that such a
    /// participant belongs to are to be advanced together. Keeps its memory from use to use.
    void configure(world::World& world, const Schedule& schedule, std::span<const BlockRow> rows, const ConstraintGraph& graph);
    /// The same without a world: rows from `source`, which has to outlive this.
    void configure(world::HostTables& host, RowSource& source, const ConstraintGraph& graph);
    /// No component can add rows: nothing else needs to be called.
    bool empty() const { return source_ == nullptr; }

    /// Rows at the tables' present state. Shafts stand for the roots of their trains. Impulses are 0.
    void collect(const StepContext& context);
    std::span<ConstraintRow> rows() { return rows_; }
    std::span<const ConstraintRow> rows() const { return rows_; }
    /// Of the last collect: a row may let go, so a manager has to hold them.
    bool may_yield() const { return may_yield_; }

    /// collect(), then the multipliers that make J a = bias under the wrenches so far, added to the wrenches. Rows that
    /// may yield are left out. False if the result is not finite (the wrenches are then as before).
    bool react(const StepContext& context, Wrenches& wrenches);
    /// Adds share (s) times the power of each component's rows of the last react() to the book. Only what moves by itself
    /// does work: rates, and kinematic participants.
    void account(const RowBook& book, double share) const;

    /// Puts the members onto their rows: poses first (error = 0), then speeds (J v = rate). At the end of an advance. What rows
    /// that contradict one another take of the kinetic energy is booked to their components.
    ProjectionReport project(const StepContext& context, const RowBook& book = {});
    /// Speeds only. The change of kinetic energy is booked to the components.
    ProjectionReport project_speeds(const StepContext& context, const RowBook& book = {});
    /// At the start of an advance: the same where speeds do not fit the rows (a joint came, a request or an impact changed
    /// a speed, a motor's speed jumped), by impulses. A function of the present state alone: speeds as a projection leaves
    /// them keep every bit.
    void join(const StepContext& context, const RowBook& book);

    /// collect(), for a manager that will hold the rows.
    void begin_hold(const StepContext& context);
    /// After it did, over h: `held` are those rows with their impulses (N s), in the same order. What is reported of them,
    /// and the errors that they leave at the tables' present state. Books their work, by the mean of the speeds before and
    /// after, and returns its sum (J).
    double take_impulses(const StepContext& context, std::span<const ConstraintRow> held, double h, const RowBook& book);
    /// Of the last react() or take_impulses(), and the last projection.
    void report_to(RowReportTable& table) const;

private:
    class Sink;
    class ScheduledRows;
    /// A block as its component gave it: a shaft that is not a root.
    struct Geared
    {
        std::uint32_t row = 0, block = 0;
        Ref who;
        double coefficient = 0;
    };

    struct Reaction
    {
        std::uint32_t component = 0;
        Vec3 force, torque;  ///< on the last participant
    };

    void keep_reactions();
    void load_forces(const Wrenches& wrenches);
    void add_reactions(Wrenches& wrenches) const;
    bool regularize_near_singular(double dt);
    double speed_norm() const;
    void relax_positions(const StepContext& context, ProjectionReport& report);
    bool correct_positions(const StepContext& context, double compliance);
    void move_members(const StepContext& context);
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
    bool is_mobile(Ref who) const;
    void count_redundant(ProjectionReport& report);
    void name_contradictory(std::span<const double> errors, ProjectionReport& report) const;

    world::HostTables* host_ = nullptr;
    const ConstraintGraph* graph_ = nullptr;
    RowSource* source_ = nullptr;
    std::unique_ptr<ScheduledRows> scheduled_;
    RowEquations equations_;

    std::vector<ConstraintRow> rows_;
    std::vector<Geared> geared_;  ///< in the order of rows
    std::vector<RowPiece> pieces_;
    std::vector<double> lambda_;                        ///< by row, N or N m
    std::vector<double> position_error_, speed_error_;  ///< by row, after the last projection
    std::vector<double> speed_work_;                    ///< J by row, of the last projection of speeds
    std::vector<std::uint32_t> redundant_;              ///< by piece
    std::vector<double> held_speed_;                    ///< by row that a manager holds: of its mobile members at the start
    std::vector<Reaction> reactions_;
    bool may_yield_ = false;
    bool factored_ = false;  ///< the equations hold a factorisation of a state close to the present one
};

}  // namespace plab::simulation
