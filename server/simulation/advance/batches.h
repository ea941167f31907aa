/// Advances all groups over the whole step in parallel: groups are divided into batches, one batch for each thread.
///
/// The partition has no influence on the state: groups do not interact, and a solver whose choices depend on its whole system (a step size
/// chosen from an error estimate, for instance) gets each cluster by itself, or refuses to advance several together; then they are split.
#pragma once

#include <memory>

#include "simulation/motion/group_motion.h"

namespace plab::simulation
{

/// Stores the events of one thread until all threads are done.
class EventBuffer final : public EventSink
{
public:
    void emit(Event event) override { events.push_back(std::move(event)); }
    std::vector<Event> events;
};

/// The work of one thread: whole clusters of groups.
struct Batch
{
    struct Part
    {
        std::uint32_t solver = kNoIndex;
        std::vector<std::uint32_t> groups;
        std::size_t load = 0;  ///< number of objects, and one for each group
        std::unique_ptr<GroupSystem> system;
        bool fine = true;
    };
    Part& add_part(std::uint32_t solver);

    std::vector<Part> parts;
    std::size_t load = 0;
    bool split = false;  ///< a solver refused a part in this step
    std::vector<double> work;
    std::unique_ptr<StageScratch> scratch;
    CostMeter meter;  ///< used if threads step in parallel
    EventBuffer events;
};

class BatchedAdvance
{
public:
    BatchedAdvance(StepState& step, GroupMotion& motion) : step_(step), motion_(motion) {}

    /// To be called after any structural change. Systems of groups that have not changed serve again.
    void rebuild(const GroupsChange& change);
    /// To be called if nothing but solvers has changed (world::Revisions): a system does not depend on its solver, so those of groups that
    /// stay together serve again.
    void divide_again();
    void advance();
    /// Number of force evaluations since the last call.
    std::uint64_t take_evaluations();
    /// StageScratch::held_bodies of all batches since take_evaluations().
    std::uint64_t held_bodies() const;

    /// By cluster: 0, or the part that it went to when its solver refused to advance it with others. Which clusters share a system affects
    /// the last digits of the energy ledger, so a snapshot keeps it.
    const std::vector<std::uint32_t>& split() const { return split_; }
    void continue_split(const std::vector<std::uint32_t>& split);

private:
    /// How a cluster shares systems with others, in the order in which clusters are divided. Alone comes last, so that no other cluster
    /// joins its parts.
    enum class Sharing : std::uint8_t
    {
        Always,
        UnlessRefused,
        Alone,
    };
    Sharing sharing_of(std::span<const std::uint32_t> groups) const;
    bool divides_as_before(const GroupsChange& change) const;
    void follow(const GroupsChange& change);
    void plan();
    void divide(std::vector<Batch>& batches);
    void set_up(std::vector<Batch>& batches);
    Batch& lightest_batch(std::vector<Batch>& batches, std::size_t total_load) const;
    void run_batch(Batch& batch, std::vector<double>& work);
    void run_batch_measured(Batch& batch);
    bool run_solver(Batch::Part& part, std::vector<double>& work, EventSink& events);
    void emit_in_order();

    StepState& step_;
    GroupMotion& motion_;
    std::vector<Batch> batches_;
    bool ready_ = false;
    std::vector<std::uint32_t> split_;
    std::vector<Sharing> sharing_;  ///< by cluster, as it was divided last
    std::int64_t waiting_ns_ = 0;   ///< time spent waiting for other threads: not counted as any component's cost
};

}  // namespace plab::simulation
