/// Response/None and Response/Impulse: what happens to bodies that touch.
#pragma once

#include <cstdint>

#include "plab/collision.h"
#include "plab/context.h"
#include "plab/schema.h"
#include "workspace.h"

namespace plab::response
{

/// A sensor: contacts are detected and reported, and bodies pass through one another.
struct NoneRows
{
    void describe(Schema&) {}
};
/// Phase::Respond. Contacts are marked as resting, without impulse, so that they are not located again.

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

}  // namespace plab::response
