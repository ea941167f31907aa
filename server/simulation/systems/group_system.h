/// The equations of motion of some groups in the form that a solver sees, evaluated on the world's host tables.
///
/// Coordinates start at zero at the beginning of an advance and are mapped onto the tables at every evaluation (sdk/plab/dynamics.h), so
/// forces always read the poses and velocities of the solver's stage. Prescribed members follow their closed-form motion from the start
/// of the step, however the step is divided.
#pragma once

#include <array>
#include <vector>

#include "plab/contact_pieces.h"
#include "plab/interruption.h"
#include "plab/minimal_coordinates.h"
#include "simulation/articulated/articulated_bodies.h"
#include "simulation/groups/groups.h"
#include "simulation/rows/force_changes.h"
#include "simulation/rows/row_system.h"
#include "simulation/shafts/shaft_system.h"
#include "simulation/systems/progress.h"
#include "simulation/systems/stage_scratch.h"
#include "world/command_call.h"

namespace plab::simulation
{

/// Data that a step shares with all of its parts; owned by StepState (motion/step_state.h).
struct StepFrame
{
    world::World* world = nullptr;
    const Schedule* schedule = nullptr;
    const Groups* groups = nullptr;
    ConstraintGraph* graph = nullptr;
    const world::MotionMemento* start = nullptr;  ///< at the start of the step
    double start_time = 0;                        ///< s
    double step = 0;                              ///< s
    Tick tick = 0;
    std::uint64_t seed = 0;
    const Interruption* interruption = nullptr;  ///< null: the step cannot be interrupted
    Progress* progress = nullptr;                ///< for displaying a long step; null: none
    std::vector<std::uint8_t>* reported_contradictory =
        nullptr;  ///< by component: joints that an event has reported; each system writes its own

    /// A safe point for interruption, and the counter of work: one event candidate, one part of a contact's forces, one evaluation.
    /// Returns true if the step is interrupted and the caller has to return.
    bool give_up() const
    {
        if (progress) progress->count();
        return interruption && interruption->due();
    }
};

/// Where the work of force components is booked during an advance.
struct WorkBook
{
    std::vector<double>* work = nullptr;  ///< J by component; null: a trial, which is not booked
    double sign = 1;                      ///< -1 cancels the booking of a part of the step that was rewound
};

/// Whether pose and velocities are finite.
bool is_finite(const Bodies& bodies, std::uint32_t b);
bool is_finite(const Shafts& shafts, std::uint32_t s);
bool is_finite(const Quantities& quantities, std::uint32_t q);

/// Forces that are not added by a component of the schedule: force-based contacts.
class ExtraForces
{
public:
    virtual ~ExtraForces() = default;
    /// Called at every solver stage, with the host tables at the state of the stage.
    virtual void add(const StepContext& context, Wrenches& wrenches) = 0;
    /// Called after add() where the stage is booked: adds `share` (s) times the `power` (W by component) that add() left to `work`, and
    /// clears it.
    virtual void book(const StepContext& context, std::vector<double>& work, std::vector<double>& power, double share) = 0;
    /// See DynamicSystem.
    virtual bool is_undersampled() const { return false; }
    /// Joins the groups that these forces couple.
    virtual void join(DisjointSets& /*groups*/) const {}
};

class GroupSystem final : public DynamicSystem, public MinimalCoordinates, public ContactPieces
{
public:
    explicit GroupSystem(StageScratch& scratch) : scratch_(&scratch) {}
    GroupSystem(const GroupSystem&) = delete;
    GroupSystem& operator=(const GroupSystem&) = delete;

    /// Selects the groups that are members, and the `observed` groups: their state is read by forces of members, so they are advanced
    /// along, but their work is not booked. Memory is kept between calls.
    void configure(const StepFrame& frame, std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed = {});
    /// Sets the present step's frame after configure(); the structure of the world must be unchanged.
    void set_frame(const StepFrame& frame) { frame_ = frame; }
    /// To be called after a change of structure that has left its groups as they were (compare_groups). False: it has to be configured
    /// again.
    bool follow(const StepFrame& frame);
    /// From now on it is advanced with the arrays of another thread. The structure of the world must be unchanged since configure().
    void borrow(StageScratch& scratch) { scratch_ = &scratch, configuration_ = scratch.new_configuration(); }
    /// Null: none. A caller that sets forces has to remove them after the advance.
    void set_extra_forces(ExtraForces* forces) { extra_ = forces; }
    /// Starts an advance from `from` to `to` (s since the start of the step) at the present state of the tables.
    void begin(double from, double to, WorkBook book, EventSink* events);
    /// Writes the solver's result into the tables. Returns false if a value is not finite.
    bool finish();
    bool all_finite() const;
    /// For contact steps, which evaluate forces once and move with the mean of the speeds before and after the kick: the next evaluations
    /// are made where the members are halfway through the advance at their present speeds. So a spring swings without gaining energy:
    /// half a move, kick, half a move is Stoermer and Verlet's method (Hairer, Lubich, Wanner, Geometric Numerical Integration (2006),
    /// I.1.4), whereas a kick by the forces of the start adds energy in each step. Does nothing if no force depends on time or state, or
    /// where contacts are forces, which have pieces of their own.
    void go_midway();
    /// Puts the members back to where they are at the start of the advance.
    void leave_midway();
    /// The forces halfway; the members are where they were afterwards.
    void evaluate_midway();
    /// Evaluates forces and rates at the present state, for contact steps (kick, then move). The work during the following kick is booked
    /// with the mean of the speeds before and after it, which is exact for constant forces.
    void evaluate_here();

    /// For contact steps, after evaluate_here(): moves shafts by the mean of old and new speeds, and prescribed members to the
    /// end.
    void move_shafts(double h, Shafts& shafts);
    void move_prescribed() { scatter_prescribed(from_ + call_.context.dt); }

    bool needs_solver() const { return !bodies_.empty() || !shafts_.empty() || !quantities_.empty(); }
    std::span<const std::uint32_t> bodies() const { return bodies_; }
    std::span<const std::uint32_t> shafts() const { return shafts_; }
    std::span<const std::uint32_t> roots() const { return roots_; }
    std::span<const std::uint32_t> quantities() const { return quantities_; }
    const StepContext& context() const { return call_.context; }
    /// Of a member body after an evaluation: dv/dt (m/s^2), and the torque about the centre of mass (N m).
    Vec3 acceleration(std::size_t member) const { return get(speed_rates_, 6 * member); }
    Vec3 torque(std::size_t member) const { return scratch_->wrenches.torque[bodies_[member]]; }
    /// Changes velocity and spin of a member body by the effect of the forces of evaluate_here() during h. Free rotation is not included;
    /// the code that moves the bodies applies it.
    void kick(std::size_t member, double h);
    /// The joints of the members; null if there are none.
    RowSystem* rows() { return rows_.get(); }
    /// How forces change after evaluate_midway(), if there are joints and a manager holds them.
    std::span<const ConstraintRow> force_changes() const { return force_changes_.rows(); }
    /// The meter of the thread that advances this system.
    CostMeter& meter() { return scratch_->meter(); }
    RowBook row_book() const { return {book_.work, book_.sign, scratch_->accounted_bodies, scratch_->accounted_shafts}; }
    /// To be set before begin(): a manager holds the joints, so evaluations leave them out.
    void hold_rows(bool held) { rows_held_ = held; }
    /// Makes speeds satisfy the joints, and then poses, after something other than the solver has moved the members.
    void join();
    void project();
    /// To be called when a manager has advanced the bodies: brings all other members to the end of the advance.
    void finish_held();
    /// Adds the reports of the joints; after finish().
    void add_reports(RowReportTable& reports) const;
    /// Adds the torques of couplings, from the last evaluation.
    void add_reactions(ShaftTorques& torques) const { shaft_system_.add_reactions(torques); }
    std::span<double> coordinates() override { return coordinates_; }
    std::span<double> speeds() override { return speeds_; }
    std::span<const double> coordinate_rates() const override { return coordinate_rates_; }
    std::span<const double> speed_rates() const override { return speed_rates_; }
    void evaluate(double t, double weight) override;
    /// Books the work of the forces that act midway, or at the present coordinates where forces do not change, and at the speeds of the
    /// start, at the power of other velocities: those with which the bodies moved meanwhile, in the form of speeds(). A force that depends
    /// on the velocity is not what it would be at those.
    void book_forces(std::span<const double> moved_with);
    void evaluate_kinematics() override;
    std::span<double> workspace(int i) override;
    std::string_view use_minimal_coordinates() override;
    std::size_t body_count() const override { return minimal_ ? 0 : bodies_.size(); }
    RigidMember rigid(std::size_t body) const override;
    std::size_t quantity_count() const override { return quantity_values_; }
    bool interrupted() const override { return frame_.interruption && frame_.interruption->due(); }
    bool is_undersampled() const override { return extra_ != nullptr && extra_->is_undersampled(); }
    bool are_only_contacts() const override { return uniform_ && extra_ != nullptr; }
    bool forces_are_uniform() const override { return uniform_ && !extra_ && !is_constrained(); }
    bool is_constrained() const override { return rows_ != nullptr; }

private:
    struct Selected
    {
        std::uint32_t index = 0;  ///< of the block
        const Block* block = nullptr;
        std::vector<Row> rows;
        std::vector<Shortlist> shortlists;
    };

    void share_cost_of_rows();

    static Vec3 get(const std::vector<double>& v, std::size_t i) { return {v[i], v[i + 1], v[i + 2]}; }
    static void put(std::vector<double>& v, std::size_t i, const Vec3& a) { v[i] = a.x, v[i + 1] = a.y, v[i + 2] = a.z; }
    void collect_members(std::span<const std::uint32_t> groups);
    void activate();
    void filter_forces();
    void make_shortlists(Selected& selected);
    template <class Visit>
    void for_each_long_list(const Selected& selected, Visit visit) const;
    bool follow_forces();
    void configure_rows();
    void keep_reactions();
    void size_vectors(std::size_t body_values);
    void scatter_bodies();
    void announce_contradictions(const ProjectionReport& report);
    void scatter(double t);
    void scatter_prescribed(double since_step_start);
    void clear_wrenches();
    void run_forces(double weight);
    void rates_of_bodies();
    Vec3 spin_rate_B(std::uint32_t body) const;
    void rates_of_shafts(double weight);
    void rates_of_quantities();

    StepFrame frame_;
    StageScratch* scratch_;
    std::uint64_t configuration_ = 0;  ///< StageScratch::new_configuration() at the last configure()
    std::vector<std::uint32_t> bodies_, shafts_, quantities_, prescribed_bodies_, prescribed_shafts_;
    std::vector<std::uint32_t> active_bodies_, active_shafts_;  ///< all members, including prescribed ones
    std::size_t own_bodies_ = 0, own_shafts_ = 0;               ///< these come first; the others are observed only and are not booked
    std::size_t quantity_values_ = 0;                           ///< coordinates of quantities
    ExtraForces* extra_ = nullptr;
    std::vector<std::uint32_t> roots_;  ///< shafts that have coordinates of their own
    std::vector<Selected> selected_;    ///< only the first selected_count_ are valid
    std::size_t selected_count_ = 0;
    std::vector<BlockRow> merged_, forces_of_members_;
    std::vector<std::uint32_t> groups_;
    bool has_observed_ = false;
    bool uniform_ = false;  ///< no force depends on time or state

    world::CommandCall call_;  ///< of the Force commands; its context is that of all evaluations
    double from_ = 0;
    double midway_ = 0;  ///< s since the start of the advance, between go_midway() and leave_midway(); else 0
    WorkBook book_;
    ShaftSystem shaft_system_;
    std::unique_ptr<RowSystem> rows_;
    ForceChanges force_changes_;
    bool rows_held_ = false;
    std::vector<std::uint32_t> joints_;  ///< components that rows_ belong to
    bool minimal_ = false;               ///< in this advance the bodies have the coordinates of their joints
    std::size_t body_values_ = 0;        ///< coordinates of bodies: six each, or those of joints
    JointTree tree_;
    ArticulatedBodies articulated_;

    std::vector<double> coordinates_, speeds_, coordinate_rates_, speed_rates_;
    std::array<std::vector<double>, 32> workspace_;
    std::vector<Vec3> start_position_;
    std::vector<Quat> start_orientation_;
    std::vector<double> start_angle_;
};

}  // namespace plab::simulation
