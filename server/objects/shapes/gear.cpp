#include "gear.h"

#include <algorithm>
#include <numbers>

#include "plab/number_text.h"
#include "volume_integration.h"

namespace plab::shapes
{
namespace
{

constexpr double kFlank = 20 * std::numbers::pi / 180;  ///< rad, from the tooth's middle line
constexpr double kDedendum = 1.25;                      ///< of the module
/// Width of a tooth relative to half the pitch: straight flanks need more clearance than involutes to pass one another.
constexpr double kPlay = 0.88;

double module_of(double pitch_radius, std::int64_t teeth) { return 2 * pitch_radius / static_cast<double>(teeth); }

/// Half of the angle, seen from the axle, of a tooth at distance `radius` from the axle.
double half_angle(double radius, double pitch_radius, std::int64_t teeth)
{
    const double half = kPlay * std::numbers::pi / 4 * module_of(pitch_radius, teeth) - (radius - pitch_radius) * std::tan(kFlank);
    // With few teeth, neighbours would merge at their roots; this limit leaves a small gap.
    return std::min(half / radius, 0.97 * std::numbers::pi / static_cast<double>(teeth));
}

/// Four points per tooth.
std::vector<Vec3> outline_of(double pitch_radius, std::int64_t teeth)
{
    const double m = module_of(pitch_radius, teeth), tip = pitch_radius + m, root = pitch_radius - kDedendum * m;
    const double at_tip = half_angle(tip, pitch_radius, teeth), at_root = half_angle(root, pitch_radius, teeth);
    std::vector<Vec3> out;
    for (std::int64_t i = 0; i < teeth; ++i)
    {
        const double middle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(teeth);
        for (const auto& [radius, angle] : {std::pair{root, -at_root}, {tip, -at_tip}, {tip, at_tip}, {root, at_root}})
            out.push_back({radius * std::cos(middle + angle), radius * std::sin(middle + angle), 0});
    }
    return out;
}

Result<BuiltMesh> mesh_of(Row row, const GearRows& gears)
{
    const double r = gears.pitch_radius[row], root = r - kDedendum * module_of(r, gears.teeth[row]);
    // The gap between two teeth is a chord, so its middle is closer to the axle than the root circle.
    const double gap = root * std::cos(std::numbers::pi / static_cast<double>(gears.teeth[row]));
    if (!(gears.bore[row] < gap)) return reason("bore must be less than the radius at the teeth's roots, " + rounded_text(gap, 6) + " m");
    return bored_prism(outline_of(r, gears.teeth[row]), gears.bore[row], 0.5 * gears.width[row]);
}

}  // namespace

void GearRows::describe(Schema& schema)
{
    shape.describe(schema);
    schema.param(pitch_radius, "pitch_radius", unit::metre, "two gears that mesh are as far apart as the sum of theirs").positive();
    schema.param(teeth, "teeth", unit::one, "number of teeth; one of them points along x").at_least(6).at_most(1000);
    schema.param(width, "width", unit::metre, "along z, half of it on either side").positive();
    schema.param(bore, "bore", unit::metre, "radius of the hole for the axle; 0: none").or_else(0).not_negative();
    schema
        .param(hull_collides, "hull_collides", unit::one,
               "it collides as its convex hull, which fills the gaps between the teeth, or not at all")
        .or_else(false);
}

Result<void> prepare_gear(const StepContext& context, Row row, const GearRows& gears, Shapes& shapes)
{
    auto mesh = mesh_of(row, gears);
    if (!mesh) return mesh.error();
    shapes.geometry[context.facet_of_row[row]] = mesh.take().geometry(gears.shape.pose(row), gears.hull_collides[row]);
    return {};
}

Result<void> measure_gear(Row row, const GearRows& gears, MassProperties& solid)
{
    const auto mesh = mesh_of(row, gears);
    if (!mesh) return mesh.error();
    const auto solid_S = solid_mesh(mesh->vertices, mesh->triangles);
    if (!solid_S) return solid_S.error();
    solid = posed(*solid_S, gears.shape.pose(row));
    return {};
}

}  // namespace plab::shapes
