/// The whole step in one go for everybody: groups in batches, one batch for each thread.
///
/// Partition never shows in the state: groups do not feel one another, and a solver whose choices depend on its whole system gets each
/// cluster by itself, or refuses to advance several together; then they are split.
#pragma once

#include <memory>

#include "simulation/advance/worker_pool.h"
#include "simulation/motion/group_motion.h"

namespace plab::simulation
{

/// Events of one thread, until all threads are done.
class EventBuffer final : public EventSink
{
public:
    void emit(Event event) override { events.push_back(std::move(event)); }
    std::vector<Event> events;
};

/// What one thread advances: whole clusters of groups.
struct Batch
{
    struct Part
    {
        std::uint32_t solver = kNoIndex;
        std::vector<std::uint32_t> groups;
        std::unique_ptr<GroupSystem> system;
        bool fine = true;
    };
    /// Clusters of one solver share a part where that changes no bit (`together`).
    void add(std::span<const std::uint32_t> cluster, std::uint32_t solver, bool together);

    std::vector<Part> parts;
    std::size_t load = 0;
    bool split = false;  ///< a part was refused in this step
    std::vector<double> work;
    std::unique_ptr<StageScratch> scratch;
    CostMeter meter;  ///< where threads step in parallel
    EventBuffer events;
};

class BatchedAdvance
{
public:
    BatchedAdvance(StepState& step, GroupMotion& motion, int threads) : step_(step), motion_(motion), workers_(threads) {}

    /// After any structural change.
    void rebuild();
    void advance();
    /// Of forces, since the last time.
    std::uint64_t take_evaluations();

    /// By cluster: 0, or which part it went to when its solver refused to advance it with others. Who shares systems with whom shows
    /// in the last digits of the ledger, so a snapshot keeps it.
    const std::vector<std::uint32_t>& split() const { return split_; }
    void continue_split(const std::vector<std::uint32_t>& split);

private:
    void plan();
    Batch& lightest_batch(std::size_t total_load);
    void run_batch(Batch& batch, std::vector<double>& work);
    void run_batch_measured(Batch& batch);
    bool run_solver(Batch::Part& part, std::vector<double>& work, EventSink& events);
    void emit_in_order();

    StepState& step_;
    GroupMotion& motion_;
    WorkerPool workers_;
    std::vector<Batch> batches_;
    bool ready_ = false;
    std::vector<std::uint32_t> split_;
    std::int64_t waiting_ns_ = 0;  ///< for other threads: nobody's cost
};

}  // namespace plab::simulation
