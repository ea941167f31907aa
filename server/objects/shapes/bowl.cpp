#include "bowl.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "built_mesh.h"
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

}  // namespace plab::shapes
