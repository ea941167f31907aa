#include "surfaces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "built_mesh.h"
#include "plab/random.h"
#include "plab/surface.h"

namespace plab::shapes
{

namespace
{

constexpr std::uint32_t kBowlSides = 64, kRings = 24;
/// Thickness of the drawn wall relative to the radius.
constexpr double kDrawnBowlWall = 0.02;

/// Adds the quarter of the profile from the rim down to the bottom, or back.
void add_quarter(std::vector<ProfilePoint>& profile, double radius, double rim, bool down)
{
    for (std::uint32_t i = 0; i <= kRings; ++i)
    {
        const double angle = rim + (std::numbers::pi - rim) * (down ? i : kRings - i) / kRings;  // from +z
        profile.push_back({radius * std::sin(angle), radius * std::cos(angle)});
    }
}

/// Outside, rim and inside; of a closed shell only the inside, so that one can look into it.
BuiltMesh picture_of_bowl(double radius, double opening)
{
    const double rim = std::acos(opening / radius);
    std::vector<ProfilePoint> profile;
    if (opening < radius) add_quarter(profile, radius * (1 + kDrawnBowlWall), rim, false);
    add_quarter(profile, radius, rim, true);
    return turned_profile(profile, kBowlSides);
}

}  // namespace

void BowlRows::describe(Schema& schema)
{
    shape.describe(schema);
    schema.param(radius, "radius", unit::metre, "of the inside").positive();
    schema
        .param(opening, "opening", unit::metre,
               "height of the rim over the centre: 0 is half a ball; from the radius on the shell is closed")
        .or_else(0);
}

Result<void> prepare_bowl(const StepContext& context, Row row, const BowlRows& bowls, Shapes& shapes)
{
    const double radius = bowls.radius[row], opening = std::min(bowls.opening[row], radius);
    if (!(opening > -radius)) return reason("opening must be above -radius: below that nothing is left of the bowl");
    Geometry geometry = picture_of_bowl(radius, opening).geometry(bowls.shape.pose(row), false);
    set_surface(geometry, Surface::Bowl, radius, opening);
    shapes.geometry[context.facet_of_row[row]] = std::move(geometry);
    return {};
}

Result<void> measure_bowl(Row, const BowlRows&, MassProperties&) { return reason("a bowl is a surface and has no volume"); }

namespace
{

constexpr std::uint32_t kBoreSides = 64;
/// Thickness of the drawn wall relative to the radius.
constexpr double kDrawnBoreWall = 0.02;

/// The inside, the outside and both ends of the wall.
BuiltMesh picture_of_bore(double radius, double half)
{
    BuiltMesh out;
    const auto ring = [&](double r, double z) { return out.add_ring(circle(r, z, kBoreSides)); };
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

namespace
{

constexpr double kMostLines = 1024;  ///< grid lines in each direction: two million triangles

std::vector<Vec3> points_of(Row row, const HeightFieldRows& fields)
{
    const std::int64_t columns = fields.columns[row], rows = fields.rows[row];
    const Reals& heights = fields.heights[row];
    const double wave = 2 * std::numbers::pi / fields.wave_length[row];
    auto random = static_cast<std::uint64_t>(fields.seed[row]);
    std::vector<Vec3> out;
    out.reserve(static_cast<std::size_t>(columns * rows));
    for (std::int64_t k = 0; k < rows; ++k)
        for (std::int64_t i = 0; i < columns; ++i)
        {
            const double x = (static_cast<double>(i) - 0.5 * static_cast<double>(columns - 1)) * fields.spacing[row];
            const double y = (static_cast<double>(k) - 0.5 * static_cast<double>(rows - 1)) * fields.spacing[row];
            double z = heights.empty() ? 0.0 : heights[out.size()];
            if (fields.wave_height[row] != 0) z += fields.wave_height[row] * std::sin(wave * x) * std::sin(wave * y);
            if (fields.roughness[row] != 0) z += fields.roughness[row] * (2 * next_uniform(random) - 1);
            out.push_back({x, y, z});
        }
    return out;
}

std::vector<std::uint32_t> triangles_of(std::uint32_t columns, std::uint32_t rows)
{
    std::vector<std::uint32_t> out;
    out.reserve(6ull * (columns - 1) * (rows - 1));
    for (std::uint32_t k = 0; k + 1 < rows; ++k)
        for (std::uint32_t i = 0; i + 1 < columns; ++i)
        {
            const std::uint32_t low = k * columns + i, high = low + columns;
            out.insert(out.end(), {low, low + 1, high + 1, low, high + 1, high});
        }
    return out;
}

}  // namespace

void HeightFieldRows::describe(Schema& schema)
{
    shape.describe(schema);
    schema.param(columns, "columns", unit::one, "points along x").at_least(2).at_most(kMostLines);
    schema.param(rows, "rows", unit::one, "points along y").at_least(2).at_most(kMostLines);
    schema.param(spacing, "spacing", unit::metre, "between neighbours; the grid's middle is the origin").positive();
    schema.param(heights, "heights", unit::metre, "z of each point, row by row along x; none: level ground").or_else({});
    schema.param(wave_height, "wave_height", unit::metre, "adds waves: this times sin(2 pi x/wave_length) sin(2 pi y/wave_length)")
        .or_else(0);
    schema.param(wave_length, "wave_length", unit::metre, "of these waves").or_else(1).positive();
    schema.param(roughness, "roughness", unit::metre, "adds to each point a random height, uniform from minus this to this")
        .or_else(0)
        .not_negative();
    schema.param(seed, "seed", unit::one, "of the random heights").or_else(1);
}

Result<void> prepare_height_field(const StepContext& context, Row row, const HeightFieldRows& fields, Shapes& shapes)
{
    const auto columns = static_cast<std::uint32_t>(fields.columns[row]), rows = static_cast<std::uint32_t>(fields.rows[row]);
    const std::size_t given = fields.heights[row].size(), wanted = std::size_t{columns} * rows;
    if (given != 0 && given != wanted)
        return reason("heights must be columns x rows = " + std::to_string(wanted) + " numbers, not " + std::to_string(given));
    Geometry geometry;
    geometry.kind = GeometryKind::Mesh;
    geometry.pose = fields.shape.pose(row);
    geometry.set_mesh(points_of(row, fields), triangles_of(columns, rows));
    set_surface(geometry, Surface::Triangles);
    shapes.geometry[context.facet_of_row[row]] = std::move(geometry);
    return {};
}

Result<void> measure_height_field(Row, const HeightFieldRows&, MassProperties&)
{
    return reason("a height field is a surface and has no volume");
}

}  // namespace plab::shapes
