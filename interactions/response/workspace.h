/// What the responses that apply impulses have in common: their working memory, when a bounce is suppressed, and the outputs of a step.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "cone_solver.h"
#include "plab/collision.h"
#include "plab/column.h"
#include "plab/schema.h"

namespace plab::response
{

/// A rebound below these is suppressed: see README, "When a bounce is suppressed".
struct BounceLimit
{
    double rest_height = 0;  ///< m, where the bodies are pressed together
    double rest_speed = 0;   ///< m/s, where they are not
};

/// Whether a contact that separates at `speed` rests: the height v^2 / 2a is below rest_height, or below what its position can resolve.
bool rests(const Contact& contact, double speed, const BounceLimit& limit);

/// Declares the parameters of an impact law that these responses share: `friction` and `restitution`, both dimensionless.
void describe_impact_law(Schema& schema, Column<double>& friction, Column<double>& restitution);
/// The parameters by which managers resist rolling and spinning (plab::RollingResistance).
void describe_rolling_resistance(Schema& schema, Column<double>& rolling, Column<double>& spinning);

/// The contacts between two bodies, which are answered together.
struct PairManifold
{
    std::uint32_t first = 0, end = 0;  ///< range in Workspace::order
    std::uint64_t id = 0;              ///< smallest contact id
};

/// Working memory of one response, kept from call to call to avoid allocations.
struct Workspace
{
    std::vector<std::uint32_t> order;     ///< contacts by pair of bodies, then id
    std::vector<PairManifold> manifolds;  ///< by id
    ContactVelocities velocities;
    std::vector<ConeContact> cones;
    std::vector<Vec3> before;             ///< m/s, contact velocities before an impact
    std::vector<std::uint32_t> together;  ///< manifolds that are hit simultaneously
    std::vector<std::uint32_t> hit;       ///< contacts of those manifolds
    std::vector<double> restitution;      ///< parallel to `hit`

    /// Sets `velocities`, and `order` to the contacts that can move, in the order of `impact.contacts`.
    void gather(const Impact& impact, Bodies& bodies);
    /// Sorts `order` by id, and sets `before` to the present velocities in that order.
    void sort_by_id(std::span<const Contact> contacts);
};

/// Adds an answered impact to the outputs of its step, which begin again at zero in each step.
template <class Table>
void add_to_outputs(Table& rows, Row row, Tick tick, const Impact& impact)
{
    if (rows.step[row] != tick) rows.residual[row] = 0, rows.iterations[row] = 0, rows.step[row] = tick;
    rows.residual[row] = std::max(rows.residual[row], impact.residual);
    rows.iterations[row] += impact.iterations;
}

}  // namespace plab::response
