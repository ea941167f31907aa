/// Advances groups of objects over a part of a step by their solvers, and rewinds them to the start of their present piece.
///
/// For most groups a step is one smooth piece. An event divides it: the groups that it affects begin a new piece at its time
/// (`save_segment`). The state at the end of the step is stored as well (`save_end`), so that a trial advance, made to locate another
/// event, can be undone.
#pragma once

#include "simulation/motion/step_state.h"
#include "simulation/shafts/shaft_reactions.h"
#include "simulation/systems/system_pool.h"

namespace plab::simulation
{

/// Interface for other state that belongs to groups and is rewound and restored with them: force contacts.
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

    /// `memory` must outlive this object.
    void remember_with(GroupMemory* memory) { memory_ = memory; }
    /// To be called after any structural change. `rewinds`: groups may be rewound within a step, so states have to be saved.
    /// `members_only`: nothing but the members of groups moves or is looked at, so states of others need not be saved.
    void rebuild(bool rewinds, bool members_only);
    /// Forces that all systems set up from now on get in addition to those of the schedule; null: none.
    void feel(ExtraForces* extra) { extra_ = extra; }
    const ExtraForces* extra() const { return extra_; }

    // Saved states: start of the step, start of the present piece of each group, end of the step -------------------------
    /// `changed`: bodies outside of it have stayed as they were saved last; null: all may have changed.
    void save_start(const std::vector<std::uint32_t>* changed = nullptr);
    /// The same for one body, whose velocity has been chosen since.
    void save_start_of(std::uint32_t body);
    void save_ends();
    void rewind(std::uint32_t group);
    void save_segment(std::uint32_t group);
    void save_end(std::uint32_t group);
    void restore_end(std::uint32_t group);
    /// s since the start of the step: time at which the group's present piece began.
    double segment_begin(std::uint32_t group) const { return segment_begin_[group]; }
    void begin_segment(std::uint32_t group, double time) { segment_begin_[group] = time; }
    const world::MotionMemento& start() const { return start_; }
    const world::MotionMemento& end() const { return end_; }

    // Moving --------------------------------------------------------------------------------------------------------
    /// The system of these groups, ready for the present frame. `observed`: groups whose state they read.
    GroupSystem& system_for(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed);
    /// Advances each group by its solver, from its present state. A trial emits no events and freezes no object.
    void advance_smooth(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed, double from, double to,
                        WorkBook book, bool trial);
    /// Puts the prescribed members of these groups to where they are at `time` (s since the start of the step).
    void put_prescribed(std::span<const std::uint32_t> groups, double time);
    /// False if some state is no longer finite.
    bool run_solver(GroupSystem& system, std::uint32_t solver, double from, double to, WorkBook book, EventSink* events);
    /// False if the command refused.
    bool call_solver(GroupSystem& system, std::uint32_t solver, const CommandInfo& command);
    void finish_advance(GroupSystem& system, bool finite, double to, bool trial);
    /// Adds the results of its joints and couplings to reactions() and row_reports().
    void take_reports(const GroupSystem& system);
    /// Puts objects whose state is no longer finite back to the start of the step, at rest, and reports them.
    void freeze(const GroupSystem& system);

    void clear_reports();
    const ShaftTorques& reactions() const { return reactions_; }
    const RowReportTable& row_reports() const { return row_reports_; }
    StageScratch& scratch() { return pool_.scratch(); }

    /// Whether a group must not share a system with others, as that would change its result.
    bool goes_alone(const Group& group) const;

private:
    /// Sort key: groups with the same solver and cluster are advanced in one system.
    struct Unit
    {
        std::uint32_t solver_rank = 0, cluster = kNoIndex, group = 0;  ///< cluster kNoIndex: may share with any cluster
        friend auto operator<=>(const Unit&, const Unit&) = default;
    };
    void collect_units(std::span<const std::uint32_t> groups);
    void fit_members();
    void save_members(world::MotionMemento& memento) const;

    StepState& step_;
    GroupMemory* memory_ = nullptr;
    ExtraForces* extra_ = nullptr;
    world::MotionMemento start_, segment_, end_;
    std::vector<double> segment_begin_;  ///< s, by group
    bool rewinds_ = false, members_only_ = false;
    SystemPool pool_;
    ShaftTorques reactions_;
    RowReportTable row_reports_;
    std::vector<Unit> units_;
    std::vector<std::uint32_t> same_unit_;
};

}  // namespace plab::simulation
