/// What all rooms of a step share: the world, what was derived from its structure, the frame of the present step, and what the step
/// reports.
#pragma once

#include <vector>

#include "simulation/systems/group_system.h"

namespace plab::simulation
{

/// What a step did, beside moving the world.
struct StepReport
{
    int events = 0;   ///< impacts located and answered
    int trials = 0;   ///< trial advances made to locate them
    int rewinds = 0;  ///< groups rewound
    int resting_pairs = 0;
    std::uint64_t swept_rows = 0;   ///< rows of contacts and joints times sweeps (or pivots) over them, trials included
    double further_pairs = 0;       ///< of shapes, beyond one for each pair of bodies, that looks for contacts went through
    std::uint64_t evaluations = 0;  ///< of forces, summed over the systems that solvers advanced, trials included
    double worst_residual = 0;      ///< m/s, left over by contact responses
    double deepest = 0;             ///< m, overlap left at the end of the step
    std::vector<Ref> frozen;        ///< objects whose state was not finite any more
};

/// Energy that contacts put in on their own account, by component (manager or response), J, since the run began.
struct ContactEnergy
{
    double made = 0;    ///< work of contacts that have none to do: no part of the ledger's work, so it stays unexplained there
    double lifted = 0;  ///< against the forces of the step, where overlap was parted
};

/// What events told of already and would tell again only when it ends and comes back.
struct Reported
{
    bool stiff = false;                       ///< contact.stiff
    std::vector<std::uint8_t> contradictory;  ///< constraint.contradiction and coupling.*, by component
};

struct StepState final : EventSink
{
    explicit StepState(world::World& of) : world(of) {}
    StepState(const StepState&) = delete;
    StepState& operator=(const StepState&) = delete;

    /// The event is of this step's tick.
    void emit(Event event) override
    {
        event.tick = frame.tick;
        events.push_back(std::move(event));
    }
    /// Work of this step is booked here.
    WorkBook book() { return {&work, 1}; }
    /// Time, length and number of the step, for a call of a command.
    StepContext context() const
    {
        StepContext out;
        out.time = frame.start_time, out.dt = frame.step, out.tick = frame.tick;
        return out;
    }

    /// A call with the host tables that most commands may see.
    PhaseCall call() const
    {
        world::HostTables& host = world.host();
        PhaseCall out;
        out.bodies = &host.bodies, out.shafts = &host.shafts, out.shapes = &host.shapes, out.quantities = &host.quantities;
        return out;
    }

    world::World& world;
    Schedule schedule;
    Groups groups;
    std::vector<std::uint32_t> all_groups;  ///< their indices, ascending
    ConstraintGraph graph;
    StepFrame frame;
    std::uint64_t serial = 0;  ///< counts steps that were begun, of whatever tick
    StepReport report;
    std::vector<Event> events;
    CostMeter meter;
    std::vector<double> work;                   ///< J by component, since the run began
    std::vector<ContactEnergy> contact_energy;  ///< by component
    Reported reported;
};

}  // namespace plab::simulation
