#include "joints/limit.h"

#include <array>
#include <cmath>

namespace plab::constraints
{
namespace
{

/// Of the distance between two bounds. Where there is only one, or no distance between them: of 1 rad, or of the smaller body's radius of
/// gyration.
constexpr double kActivation = 0x1p-9;

double activation_distance(const LimitRows& rows, Row row, const Bodies& bodies)
{
    const double range = rows.upper[row] - rows.lower[row];
    if (std::isfinite(range) && range > 0) return kActivation * range;
    if (rows.turns(row)) return kActivation;
    return activation_by_size(bodies, std::array{rows.a[row], rows.b[row]});
}

}  // namespace

void LimitRows::describe(Schema& s)
{
    describe_coordinate(s, {"turn", "slide", "distance"});
    s.role(manager, "manager", {Facet::Component}, "advances the bodies while a bound is near")
        .family("Manager/")
        .default_type("Manager/Automatic");
    s.param(lower, "lower", unit::one, "least position, rad or m; -inf: none").or_else(-kInfinity).may_be_infinite();
    s.param(upper, "upper", unit::one, "largest position, rad or m; inf: none").or_else(kInfinity).may_be_infinite();
    s.param(restitution, "restitution", unit::one, "coefficient of restitution: fraction of the speed returned at a bound")
        .or_else(0)
        .not_negative()
        .at_most(1);
    describe_reaction(s, "b");
}

Result<void> prepare_limit(Row row, LimitRows& rows, const Bodies& bodies)
{
    if (!(rows.lower[row] <= rows.upper[row])) return reason("lower must not be above upper");
    return rows.place_coordinate(row, bodies);
}

double activation_by_size(const Bodies& bodies, std::span<const Ref> some)
{
    double size = kInfinity;
    for (const Ref r : some)
    {
        if (r.facet != Facet::Body || !bodies.dynamic(r.index)) continue;
        const Mat3& inertia = bodies.inertia_B[r.index];
        size = std::fmin(size, std::sqrt(0.5 * (inertia(0, 0) + inertia(1, 1) + inertia(2, 2)) * bodies.inverse_mass[r.index]));
    }
    return std::isfinite(size) ? kActivation * size : 0.0;
}

void add_bound(const StepContext& step, ConstraintRow row, double gap, double speed, double activation, double restitution, RowSink& sink)
{
    if (gap > activation + 2 * step.dt * std::fmax(0.0, -speed)) return;
    row.kind = RowKind::OneSided;
    row.error = gap, row.lower = 0, row.restitution = restitution;
    sink.add(row);
}

ConstraintRow opposite(ConstraintRow row)
{
    for (std::uint32_t k = 0; k < row.count; ++k)
        row.blocks[k].linear = -row.blocks[k].linear, row.blocks[k].angular = -row.blocks[k].angular;
    row.error = -row.error, row.bias = -row.bias;
    return row;
}

void constrain_limit(const StepContext& step, Rows which, const LimitRows& rows, const Bodies& bodies, const Shafts& shafts, RowSink& sink)
{
    for (const Row row : which)
    {
        Coordinate c = coordinate_of(rows, row, bodies, shafts, step.time);
        sink.begin(step.component_of_row[row]);
        const double activation = activation_distance(rows, row, bodies), e = rows.restitution[row];
        add_bound(step, c.row, c.x - rows.lower[row], c.speed, activation, e, sink);
        c.row = opposite(c.row), c.row.feature = 1;
        add_bound(step, c.row, rows.upper[row] - c.x, -c.speed, activation, e, sink);
    }
}

}  // namespace plab::constraints
