#include "bore.h"

#include <numbers>

#include "built_mesh.h"
#include "plab/surface.h"

namespace plab::shapes
{
namespace
{

constexpr std::uint32_t kBoreSides = 64;
/// Thickness of the drawn wall relative to the radius.
constexpr double kDrawnBoreWall = 0.02;

/// The inside, the outside and both ends of the wall.
BuiltMesh picture_of_bore(double radius, double half)
{
    BuiltMesh out;
    const auto ring = [&](double r, double z)
    {
        std::vector<Vec3> points;
        for (std::uint32_t i = 0; i < kBoreSides; ++i)
        {
            const double angle = 2 * std::numbers::pi * i / kBoreSides;
            points.push_back({r * std::cos(angle), r * std::sin(angle), z});
        }
        return out.add_ring(points);
    };
    const double outer = radius * (1 + kDrawnBoreWall);
    const std::uint32_t outer_low = ring(outer, -half), outer_high = ring(outer, half);
    const std::uint32_t inner_high = ring(radius, half), inner_low = ring(radius, -half);
    out.add_band(outer_low, outer_high, kBoreSides), out.add_band(outer_high, inner_high, kBoreSides);
    out.add_band(inner_high, inner_low, kBoreSides), out.add_band(inner_low, outer_low, kBoreSides);
    return out;
}

}  // namespace

void BoreRows::describe(Schema& schema)
{
    shape.describe(schema);
    schema.param(radius, "radius", unit::metre, "of the inside").positive();
    schema.param(height, "height", unit::metre, "length along z, half of it on either side; open at both ends (planes close them)")
        .positive();
}

void prepare_bore(const StepContext& context, Row row, const BoreRows& bores, Shapes& shapes)
{
    const double radius = bores.radius[row], half = 0.5 * bores.height[row];
    Geometry geometry = picture_of_bore(radius, half).geometry(bores.shape.pose(row), false);
    set_surface(geometry, Surface::Bore, radius, half);
    shapes.geometry[context.facet_of_row[row]] = std::move(geometry);
}

Result<void> measure_bore(Row, const BoreRows&, MassProperties&) { return reason("a bore is a surface and has no volume"); }

}  // namespace plab::shapes
