/// The equations of motion of some groups, as a solver sees them, over the world's host tables.
///
/// Coordinates start at zero at the beginning of an advance and are mapped onto the tables at every evaluation
/// (sdk/plab/dynamics.h), so that forces always read poses and velocities of the stage. Prescribed members follow their
/// closed form from the start of the step, whatever pieces the step is cut into.
#pragma once

#include <array>
#include <vector>

#include "plab/interruption.h"
#include "simulation/groups/groups.h"
#include "simulation/rows/row_system.h"
#include "simulation/shafts/shaft_system.h"
#include "simulation/systems/progress.h"
#include "simulation/systems/stage_scratch.h"

namespace plab::simulation
{

/// What a step shares with all of its parts; owned by StepState (motion/step_state.h).
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
    const Interruption* interruption = nullptr;  ///< null: nobody can give the step up
    Progress* progress = nullptr;                ///< for whoever watches a long step; null: nobody does
    std::vector<std::uint8_t>* reported_contradictory =
        nullptr;  ///< by component: joints that an event told of; each system writes its own

    /// A safe point, and a piece of work that is counted: an event looked at, a part of a contact's forces, an evaluation. True: the
    /// step is given up, leave off.
    bool give_up() const
    {
        if (progress) progress->count();
        return interruption && interruption->due();
    }
};

/// Where the work of force components goes while an advance is booked.
struct WorkBook
{
    std::vector<double>* work = nullptr;  ///< J by component; null: a trial
    double sign = 1;                      ///< -1 takes back what a rewound piece had booked
};

/// Whether pose and velocities are numbers still.
bool is_finite(const Bodies& bodies, std::uint32_t b);
bool is_finite(const Shafts& shafts, std::uint32_t s);
bool is_finite(const Quantities& quantities, std::uint32_t q);

/// Forces that no component of the schedule adds by itself: contacts that are forces.
class ExtraForces
{
public:
    virtual ~ExtraForces() = default;
    /// At every solver stage, with the host tables at the stage's state.
    virtual void add(const StepContext& context, Wrenches& wrenches) = 0;
    /// After add, where the stage is booked: takes what add left in `power` (W by component) times `share` (s) into `work`.
    virtual void book(const StepContext& context, std::vector<double>& work, std::vector<double>& power, double share) = 0;
    /// See DynamicSystem.
    virtual bool is_undersampled() const { return false; }
    /// Joins the groups that move together because of them.
    virtual void join(DisjointSets& /*groups*/) const {}
};

class GroupSystem final : public DynamicSystem
{
public:
    explicit GroupSystem(StageScratch& scratch) : scratch_(&scratch) {}
    GroupSystem(const GroupSystem&) = delete;
    GroupSystem& operator=(const GroupSystem&) = delete;

    /// Takes the groups as members, and `shadows`: groups whose state the members' forces read, and that are advanced
    /// along for that reason only; their work is not booked. Keeps its memory from use to use.
    void configure(const StepFrame& frame, std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed = {});
    /// The present step's frame, after configure(): the world's structure must be the same.
    void set_frame(const StepFrame& frame) { frame_ = frame; }
    /// Null: none. Who sets some takes them away when the advance is over.
    void set_extra_forces(ExtraForces* forces) { extra_ = forces; }
    /// Starts an advance from `from` to `to` (s since the start of the step) at the tables' present state.
    void begin(double from, double to, WorkBook book, EventSink* events);
    /// Puts the solver's result into the tables. False if something is not finite any more.
    bool finish();
    bool all_finite() const;
    /// Forces and rates at the present state, for contact steps. Their work over the kick that follows is booked with the
    /// mean of the speeds before and after it, which for constant forces is what they do.
    void evaluate_here();

    /// For contact steps, after evaluate_here: shafts by the mean of old and new speeds, prescribed members to the end.
    void move_shafts(double h, Shafts& shafts);
    void move_prescribed() { scatter_prescribed(from_ + context_.dt); }

    bool needs_solver() const { return !bodies_.empty() || !shafts_.empty() || !quantities_.empty(); }
    std::span<const std::uint32_t> bodies() const { return bodies_; }
    std::span<const std::uint32_t> shafts() const { return shafts_; }
    std::span<const std::uint32_t> roots() const { return roots_; }
    std::span<const std::uint32_t> quantities() const { return quantities_; }
    const StepContext& context() const { return context_; }
    /// Of a member body after evaluate: dv/dt (m/s^2) and the torque about C (N m).
    Vec3 acceleration(std::size_t member) const { return get(speed_rates_, 6 * member); }
    Vec3 torque(std::size_t member) const { return scratch_->wrenches.torque[bodies_[member]]; }
    /// Changes a member body's velocity and spin by what the forces of evaluate_here do in h. Free rotation is no part
    /// of it: whoever moves the bodies turns them freely.
    void kick(std::size_t member, double h);
    /// The joints of the members; null where there are none.
    RowSystem* rows() { return rows_.get(); }
    /// Of the thread that advances it.
    CostMeter& meter() { return scratch_->meter(); }
    RowBook row_book() const { return {book_.work, book_.sign, scratch_->accounted_bodies, scratch_->accounted_shafts}; }
    /// From before begin() on: joints are held by a manager, evaluations leave them out.
    void hold_rows(bool held) { rows_held_ = held; }
    /// Joints, after somebody else than the solver has moved the members: speeds that fit them; then poses, too.
    void join();
    void project();
    /// When a manager has advanced the bodies: whatever else is a member comes to the end.
    void finish_held();
    /// What joints did, after finish().
    void add_reports(RowReportTable& reports) const;
    /// Torques of couplings, from the last evaluation.
    void add_reactions(ShaftTorques& torques) const { shaft_system_.add_reactions(torques); }
    std::span<double> coordinates() override { return coordinates_; }
    std::span<double> speeds() override { return speeds_; }
    std::span<const double> coordinate_rates() const override { return coordinate_rates_; }
    std::span<const double> speed_rates() const override { return speed_rates_; }
    void evaluate(double t, double weight) override;
    void evaluate_kinematics() override;
    std::span<double> workspace(int i) override;
    std::size_t body_count() const override { return bodies_.size(); }
    RigidMember rigid(std::size_t body) const override;
    std::size_t quantity_count() const override { return quantity_values_; }
    bool interrupted() const override { return frame_.interruption && frame_.interruption->due(); }
    bool is_undersampled() const override { return extra_ != nullptr && extra_->is_undersampled(); }
    bool forces_are_uniform() const override { return uniform_ && !extra_ && !is_constrained(); }
    bool is_constrained() const override { return rows_ != nullptr; }

private:
    struct Selected
    {
        const Block* block;
        std::vector<Row> rows;
        std::vector<Shortlist> shortlists;
    };

    void run_force(const Selected& selected, PhaseCall& call, bool booked);
    void share_cost_of_rows();

    static Vec3 get(const std::vector<double>& v, std::size_t i) { return {v[i], v[i + 1], v[i + 2]}; }
    static void put(std::vector<double>& v, std::size_t i, const Vec3& a) { v[i] = a.x, v[i + 1] = a.y, v[i + 2] = a.z; }
    void collect_members(std::span<const std::uint32_t> groups);
    void activate();
    void filter_forces();
    void make_shortlists(Selected& selected);
    void configure_rows();
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
    std::uint64_t configuration_ = 0;  ///< counts configure()
    std::vector<std::uint32_t> bodies_, shafts_, quantities_, prescribed_bodies_, prescribed_shafts_;
    std::vector<std::uint32_t> active_bodies_, active_shafts_;  ///< all members, prescribed ones too
    std::size_t own_bodies_ = 0, own_shafts_ = 0;               ///< the first of those: not shadows, so they are booked
    std::size_t quantity_values_ = 0;                           ///< coordinates of quantities
    ExtraForces* extra_ = nullptr;
    std::vector<std::uint32_t> roots_;  ///< shafts that carry coordinates
    std::vector<Selected> selected_;    ///< forces; the first selected_count_ are valid
    std::size_t selected_count_ = 0;
    std::vector<BlockRow> merged_;
    std::vector<std::uint32_t> groups_;
    bool has_observed_ = false;
    bool uniform_ = false;  ///< no force depends on time or state

    StepContext context_;
    double from_ = 0;
    WorkBook book_;
    ShaftSystem shaft_system_;
    std::unique_ptr<RowSystem> rows_;
    bool rows_held_ = false;
    std::vector<std::uint32_t> joints_;  ///< components of rows_

    std::vector<double> coordinates_, speeds_, coordinate_rates_, speed_rates_;
    std::array<std::vector<double>, 32> workspace_;
    std::vector<Vec3> start_position_;
    std::vector<Quat> start_orientation_;
    std::vector<double> start_angle_;
};

}  // namespace plab::simulation
