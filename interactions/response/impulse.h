/// Response/None, Response/Impulse and Response/Automatic: impulses at the instant of an impact, and over a step where contacts persist.
#pragma once

#include <cstdint>

#include "plab/collision.h"
#include "plab/context.h"
#include "plab/schema.h"
#include "workspace.h"

namespace plab::response
{

/// Response/None, a sensor: contacts are detected and reported, and bodies pass through one another. The host reports them by itself.
struct NoneRows
{
    void describe(Schema&) {}
};

/// Response/Impulse: the impact law (impact_law.h) for contacts that close, friction cones (cone_solver.h) for those that persist.
struct ImpulseRows
{
    Column<double> friction, restitution;  // 1
    Column<double> rest_height;            // m
    Column<double> rest_speed;             // m/s
    Column<double> tolerance;              // m/s
    Column<std::int64_t> max_iterations;
    Column<double> residual;  // m/s
    Column<std::int64_t> iterations;
    Column<Tick> step;  ///< the step whose outputs are being summed
    Column<Workspace> workspace;

    void describe(Schema& schema, std::int64_t most_iterations = 500);
};

/// Phase::Respond.
void respond(const StepContext& context, Row row, ImpulseRows& rows, Bodies& bodies, Impact& impact);

/// When a bounce is suppressed, and how many iterations are allowed.
struct ImpactSettings
{
    BounceLimit bounce;
    double tolerance = 0;  ///< m/s
    int max_iterations = 0;
    const Interruption* interruption = nullptr;  ///< checked in each sweep
};
/// Impacts: see README, "Impacts".
void respond_impact(const ImpactSettings& settings, Workspace& work, Bodies& bodies, Impact& impact);
/// Persistent contacts over dt: see README, "Resting contacts".
void respond_rest(const ImpactSettings& settings, Workspace& work, Bodies& bodies, Impact& impact);

/// Response/Automatic: the impact law of Response/Impulse, and a manager for contacts that persist.
///
/// Impacts that a resolution locates are answered one pair after the other, in the order in which they happen (Newton's cradle passes its
/// momentum on). Everything else is left to the manager: bodies that rest on one another, and all impacts of a step whose resolution does
/// not locate them.
struct AutomaticRows
{
    ImpulseRows impulse;
    Column<double> rolling_friction, spinning_friction;  // m
    Column<Ref> manager;

    void describe(Schema& schema);
};

/// Phase::Respond.
void respond_automatically(const StepContext& context, Row row, AutomaticRows& rows, Bodies& bodies, Impact& impact);

}  // namespace plab::response
