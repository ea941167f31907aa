/// What all modules of a step share: the world, what was derived from its structure, the frame of the present step, and its report.
#pragma once

#include <vector>

#include "simulation/systems/group_system.h"
#include "simulation/threads/worker_pool.h"
#include "world/world_lookup.h"

namespace plab::simulation
{

/// Statistics of a step.
struct StepReport
{
    int events = 0;   ///< impacts located and answered
    int trials = 0;   ///< trial advances made to locate them
    int rewinds = 0;  ///< groups rewound
    int resting_pairs = 0;
    std::uint64_t swept_rows = 0;   ///< rows of contacts and joints times sweeps (or pivots) over them, trials included
    double further_pairs = 0;       ///< pairs of shapes that detection went through, beyond one for each pair of bodies
    std::uint64_t visited = 0;      ///< bodies that detections were asked about, and known pairs visited to find what rests on what
    std::uint64_t evaluations = 0;  ///< of forces, summed over the systems that solvers advanced, trials included
    double worst_residual = 0;      ///< m/s, largest residual of the contact responses
    double deepest = 0;             ///< m, overlap left at the end of the step
    std::vector<Ref> frozen;        ///< objects whose state was no longer finite
};

/// Energy that contacts created, by component (manager or response), J, since the run began.
struct ContactEnergy
{
    double created = 0;        ///< by contacts that should only dissipate: not booked as work, so it shows up as unexplained in the ledger
    double by_correction = 0;  ///< by position correction, against the forces of the step
};

/// Conditions that have been reported by an event and are reported again only if they end and come back.
struct Reported
{
    bool stiff = false;                       ///< contact.stiff
    bool stiff_forces = false;                ///< force.stiff; once in a run
    std::vector<std::uint8_t> contradictory;  ///< constraint.contradiction and coupling.*, by component
};

struct StepState final : EventSink
{
    StepState(world::World& of, int threads) : world(of), lookup(of), workers(threads) {}
    StepState(const StepState&) = delete;
    StepState& operator=(const StepState&) = delete;

    /// Gives the event the tick of this step.
    void emit(Event event) override
    {
        event.tick = frame.tick;
        events.push_back(std::move(event));
    }
    /// The account to which the work of this step is booked.
    WorkBook book() { return {&work, 1}; }
    /// Time, length and number of the step, for a call of a command.
    StepContext context() const
    {
        StepContext out;
        out.time = frame.start_time, out.dt = frame.step, out.tick = frame.tick;
        return out;
    }

    /// The host tables that most commands may see.
    PhaseCall arguments() const
    {
        world::HostTables& host = world.host();
        PhaseCall out;
        out.bodies = &host.bodies, out.shafts = &host.shafts, out.shapes = &host.shapes, out.quantities = &host.quantities;
        out.filter = &host.filter;
        return out;
    }

    world::World& world;
    world::WorldLookup lookup;
    WorkerPool workers;  ///< lent to calls on the step thread; calls on other threads must not use it
    Schedule schedule;
    Groups groups;
    std::vector<std::uint32_t> all_groups;  ///< their indices, ascending
    ConstraintGraph graph;
    StepFrame frame;
    std::uint64_t serial = 0;  ///< number of steps that were begun, repeated ones included
    StepReport report;
    std::vector<Event> events;
    CostMeter meter;
    std::vector<double> work;                   ///< J by component, since the run began
    std::vector<ContactEnergy> contact_energy;  ///< by component
    Reported reported;
};

}  // namespace plab::simulation
