/// Response/None and Response/Impulse: what happens to bodies that touch.
#pragma once

#include <cstdint>
#include <vector>

#include "cone_solver.h"
#include "plab/collision.h"
#include "plab/context.h"
#include "plab/schema.h"

namespace plab::response
{

/// A sensor: contacts are detected and reported, and bodies pass through one another.
struct NoneRows
{
    void describe(Schema&) {}
};
/// Phase::Respond. Contacts are marked as resting, without impulse, so that they are not located again.

/// The contacts between two bodies, which are answered together.
struct Patch
{
    std::uint32_t first = 0, end = 0;  ///< range in Workspace::order
    std::uint64_t id = 0;              ///< smallest contact id
};

/// A contact that takes part in an impact at several points; and a body's state before that impact.
struct HitContact
{
    std::uint32_t contact = 0;
    double restitution = 0;
};
struct HitBody
{
    std::uint32_t body = 0;
    Vec3 velocity, spin, momentum;
};

/// Working memory of one response, kept from call to call to avoid allocations.
struct Workspace
{
    std::vector<std::uint32_t> order;  ///< contacts by pair of bodies, then id
    std::vector<Patch> patches;        ///< by id
    std::vector<ContactPoint> points;  ///< per contact
    std::vector<ConeContact> cones;
    std::vector<Vec3> before;             ///< m/s, contact velocities before an impact
    std::vector<std::uint32_t> together;  ///< patches that are hit simultaneously
    std::vector<HitContact> hit;          ///< contacts of those patches
    std::vector<HitBody> saved;           ///< bodies of those patches, before the impact
};

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

    void describe(Schema& schema);
};

/// Phase::Respond.
void respond(const StepContext& context, Row row, ImpulseRows& rows, Bodies& bodies, Impact& impact);

/// When a bounce is suppressed, and how many iterations are allowed.
struct ImpactSettings
{
    double rest_height = 0, rest_speed = 0, tolerance = 0;
    int max_iterations = 0;
    const Interruption* interruption = nullptr;  ///< checked in each sweep
};
/// Impacts: see README, "Impacts".
void respond_impact(const ImpactSettings& settings, Workspace& work, Bodies& bodies, Impact& impact);
/// Persistent contacts over dt: see README, "Resting contacts".
void respond_rest(const ImpactSettings& settings, Workspace& work, Bodies& bodies, Impact& impact);

}  // namespace plab::response
