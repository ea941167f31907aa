/// How groups of objects move over a part of a step by their solvers, and how they go back to where a piece of it began.
///
/// A step is one smooth piece for most groups. Where an event cuts it, the groups that it touches begin a new piece at its time
/// (`save_segment`); everybody remembers where the step ends for it (`save_end`), so that somebody else's trial can go back and return.
#pragma once

#include "simulation/motion/step_state.h"
#include "simulation/shafts/shaft_reactions.h"
#include "simulation/systems/system_pool.h"

namespace plab::simulation
{

/// What else has a state by group that goes back and forth with it: contacts that are forces.
class GroupMemory
{
public:
    virtual ~GroupMemory() = default;
    virtual void rewind(std::uint32_t group) = 0;
    virtual void save_segment(std::uint32_t group) = 0;
    virtual void save_end(std::uint32_t group) = 0;
    virtual void restore_end(std::uint32_t group) = 0;
    virtual void save_ends() = 0;
};

class GroupMotion
{
public:
    explicit GroupMotion(StepState& step) : step_(step) {}

    /// As long as groups are moved it must live.
    void remember_with(GroupMemory* memory) { memory_ = memory; }
    /// After any structural change. `rewinds`: somebody may go back within a step.
    void rebuild(bool rewinds);
    /// What all systems that are set up now feel beside the forces of the schedule; null: nothing.
    void feel(ExtraForces* extra) { extra_ = extra; }
    const ExtraForces* extra() const { return extra_; }

    // Where the step, the present piece of each group, and the step's end are -------------------------------------------
    void save_start();
    void save_ends();
    void rewind(std::uint32_t group);
    void save_segment(std::uint32_t group);
    void save_end(std::uint32_t group);
    void restore_end(std::uint32_t group);
    /// s since the start of the step: where the group's present piece began.
    double segment_begin(std::uint32_t group) const { return segment_begin_[group]; }
    void begin_segment(std::uint32_t group, double time) { segment_begin_[group] = time; }
    const world::MotionMemento& start() const { return start_; }
    const world::MotionMemento& end() const { return end_; }

    // Moving --------------------------------------------------------------------------------------------------------
    /// The system of these groups, ready for the present frame. `shadows`: whom they read.
    GroupSystem& system_for(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed);
    /// Each by its solver, from where it is. A trial emits no events and freezes nobody.
    void advance_smooth(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed, double from, double to,
                        WorkBook book, bool trial);
    /// False: something is not finite any more.
    bool run_solver(GroupSystem& system, std::uint32_t solver, double from, double to, WorkBook book, EventSink* events);
    /// False if the command refused.
    bool call_solver(GroupSystem& system, std::uint32_t solver, const CommandInfo& command);
    void finish_advance(GroupSystem& system, bool finite, double to, bool trial);
    /// Takes what its joints and couplings did over into reactions() and row_reports().
    void take_reports(const GroupSystem& system);
    /// Who is not finite stays where the step began, and is told.
    void freeze(const GroupSystem& system);

    void clear_reports();
    const ShaftTorques& reactions() const { return reactions_; }
    const RowReportTable& row_reports() const { return row_reports_; }
    StageScratch& scratch() { return pool_.scratch(); }

    /// Whether a group's solver may not advance it in one system with others.
    bool goes_alone(const Group& group) const;

private:
    /// Groups that are advanced in one system.
    struct Unit
    {
        std::uint32_t solver_rank = 0, cluster = kNoIndex, group = 0;  ///< kNoIndex: whatever cluster
        friend auto operator<=>(const Unit&, const Unit&) = default;
    };
    void collect_units(std::span<const std::uint32_t> groups);

    StepState& step_;
    GroupMemory* memory_ = nullptr;
    ExtraForces* extra_ = nullptr;
    world::MotionMemento start_, segment_, end_;
    std::vector<double> segment_begin_;  ///< s, by group
    bool rewinds_ = false;
    SystemPool pool_;
    ShaftTorques reactions_;
    RowReportTable row_reports_;
    std::vector<Unit> units_;
    std::vector<std::uint32_t> same_unit_;
};

}  // namespace plab::simulation
