/// How the forces on joined bodies change within a step (Phase::Linearize), for managers, which evaluate each force once in a step.
///
/// A spring or servo of frequency w gains energy without bound in such a step from h w = 2 on, and a damper from h c / m = 2. Between
/// joined bodies it cannot be foreseen what m is: a servo of some N m s/rad at the wrist of an arm is always beyond. So a manager gets,
/// beside the joints, one row for each such force, lambda = bias - stiffness x - damping (J v - v_0) for the displacement x and the speed
/// since the evaluation, and finds its impulse together with those of joints and contacts. The step is then linearly implicit: stable
/// however stiff the force is, and of the same order (interactions/managers/stepping.h).
///
/// Source: E. Hairer, G. Wanner, Solving ordinary differential equations II (1996), IV.7 (linearly implicit methods).
#pragma once

#include "simulation/rows/scheduled_rows.h"

namespace plab::simulation
{

class ForceChanges
{
public:
    /// Of those of these forces (rows of Phase::Force) whose components can tell it.
    void configure(world::World& world, const Schedule& schedule, std::span<const BlockRow> forces);
    bool empty() const { return scheduled_.empty(); }
    /// At the present state of the tables, which is that of the evaluation, `ahead` (s) of where the members are at present speeds.
    void collect(const StepContext& context, double ahead, CostMeter& meter);
    /// The rows of the last collect(); those of one component are adjacent.
    std::span<const ConstraintRow> rows() const { return rows_; }

private:
    class Sink;
    world::World* world_ = nullptr;
    ScheduledRows scheduled_;
    std::vector<BlockRow> chosen_;
    std::vector<ConstraintRow> rows_;
};

}  // namespace plab::simulation
