#include "machine_parts.h"

#include <algorithm>
#include <array>
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

constexpr std::uint32_t kHubSides = 48;
constexpr int kStations = 8;         ///< sections of a blade, from root to tip
constexpr double kThickness = 0.1;   ///< maximum thickness of a section relative to its width
constexpr double kCamber = 0.06;     ///< height of the mean line relative to the width
constexpr double kSlopeLimit = 1.2;  ///< rad, largest inclination of a section to the plane of rotation

struct Blade
{
    double hub_radius, radius, pitch_angle, width;
};

/// A section of a blade, developed into a plane: x along it from -1/2 to 1/2, y across; width 1. Counter-clockwise.
constexpr std::array<std::array<double, 2>, 8> kSection = {{{0.5, 0},
                                                            {0.25, 0.75 * kCamber + 0.35 * kThickness},
                                                            {0, kCamber + 0.5 * kThickness},
                                                            {-0.25, 0.75 * kCamber + 0.35 * kThickness},
                                                            {-0.5, 0},
                                                            {-0.25, 0.75 * kCamber - 0.35 * kThickness},
                                                            {0, kCamber - 0.5 * kThickness},
                                                            {0.25, 0.75 * kCamber - 0.35 * kThickness}}};

/// Relative width: narrow at the hub, widest at two thirds of the blade, rounded at the tip; `s` from 0 to 1.
double relative_width(double s) { return (0.62 + 0.76 * s - 0.38 * s * s) * std::sqrt(1 - 0.72 * s * s * s * s * s * s); }

double slope_at(const Blade& blade, double r) { return std::fmin(std::atan(blade.radius * std::tan(blade.pitch_angle) / r), kSlopeLimit); }

/// Each section lies on a cylinder about the axle, so the root section lies on the hub.
std::vector<Vec3> section(const Blade& blade, double s)
{
    const double r = blade.hub_radius + (blade.radius - blade.hub_radius) * s;
    const double slope = slope_at(blade, r), width = blade.width * relative_width(s);
    std::vector<Vec3> out;
    for (const auto& [x, y] : kSection)
    {
        const double around = width * (x * std::cos(slope) - y * std::sin(slope)) / r;
        const double up = width * (x * std::sin(slope) + y * std::cos(slope));
        out.push_back({r * std::cos(around), r * std::sin(around), up});
    }
    return out;
}

BuiltMesh blade_mesh(const Blade& blade)
{
    constexpr auto kCount = static_cast<std::uint32_t>(kSection.size());
    BuiltMesh out;
    std::uint32_t below = 0, root = 0;
    for (int i = 0; i <= kStations; ++i)
    {
        const std::uint32_t ring = out.add_ring(section(blade, static_cast<double>(i) / kStations));
        if (i > 0) out.add_band(below, ring, kCount);
        if (i == 0) root = ring;
        below = ring;
    }
    // Sections are nearly flat, so fans around their first vertex close the ends.
    for (std::uint32_t i = 1; i + 1 < kCount; ++i)
    {
        out.add_triangle(root, root + i + 1, root + i);
        out.add_triangle(below, below + i, below + i + 1);
    }
    return out;
}

BuiltMesh hub_mesh(const Blade& blade)
{
    const double r = blade.hub_radius, half = 0.55 * blade.width * std::sin(slope_at(blade, r)) + 0.2 * r;
    const ProfilePoint profile[] = {{0, -half},
                                    {0.92 * r, -half},
                                    {r, -half + 0.08 * r},
                                    {r, half},
                                    {0.93 * r, half + 0.28 * r},
                                    {0.74 * r, half + 0.52 * r},
                                    {0.42 * r, half + 0.68 * r},
                                    {0, half + 0.74 * r}};
    return turned_profile(profile, kHubSides);
}

BuiltMesh turned(const BuiltMesh& mesh, double angle)
{
    BuiltMesh out = mesh;
    const double c = std::cos(angle), s = std::sin(angle);
    for (Vec3& v : out.vertices) v = {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
    return out;
}

Result<BuiltMesh> mesh_of(Row row, const RotorRows& rotors)
{
    const Blade blade{rotors.hub_radius[row], rotors.radius[row], rotors.pitch_angle[row], rotors.width[row]};
    if (!(blade.radius > blade.hub_radius)) return reason("radius must be more than hub_radius, so that the blades extend beyond the hub");
    if (!(blade.pitch_angle < kSlopeLimit)) return reason("pitch_angle must be less than 1.2 rad");
    const double count = static_cast<double>(rotors.blades[row]);
    const double room = 2 * std::numbers::pi * blade.hub_radius / count;
    const double taken = blade.width * relative_width(0) * std::cos(slope_at(blade, blade.hub_radius));
    if (!(taken < room)) return reason("the blades do not fit on the hub; use fewer blades, a smaller width or a larger hub_radius");
    BuiltMesh out = hub_mesh(blade);
    const BuiltMesh one = blade_mesh(blade);
    for (std::int64_t i = 0; i < rotors.blades[row]; ++i) out.append(turned(one, 2 * std::numbers::pi * static_cast<double>(i) / count));
    return out;
}

/// Both wheels are meshes that follow from few numbers; they are built again for their mass, and not kept.
template <class Table>
Result<void> prepare_wheel(const StepContext& context, Row row, const Table& wheels, Shapes& shapes)
{
    auto mesh = mesh_of(row, wheels);
    if (!mesh) return mesh.error();
    shapes.geometry[context.facet_of_row[row]] = mesh.take().geometry(wheels.shape.pose(row), wheels.hull_collides[row]);
    return {};
}

template <class Table>
Result<void> measure_wheel(Row row, const Table& wheels, MassProperties& solid)
{
    const auto mesh = mesh_of(row, wheels);
    if (!mesh) return mesh.error();
    return measure_mesh_in_body(mesh->vertices, mesh->triangles, wheels.shape.pose(row), solid);
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
    return prepare_wheel(context, row, gears, shapes);
}

Result<void> measure_gear(Row row, const GearRows& gears, MassProperties& solid) { return measure_wheel(row, gears, solid); }

void RotorRows::describe(Schema& schema)
{
    shape.describe(schema);
    schema.param(hub_radius, "hub_radius", unit::metre, "radius of the hub").positive();
    schema.param(radius, "radius", unit::metre, "from the axle to the blades' tips").positive();
    schema.param(blades, "blades", unit::one, "number of blades; one of them points along x").at_least(1).at_most(64);
    schema.param(pitch_angle, "pitch_angle", unit::radian, "between the blades' tips and the plane of rotation").positive();
    schema.param(width, "width", unit::metre, "of a blade, where it is widest").positive();
    schema.param(hull_collides, "hull_collides", unit::one, "it collides as its convex hull or not at all").or_else(false);
}

Result<void> prepare_rotor(const StepContext& context, Row row, const RotorRows& rotors, Shapes& shapes)
{
    return prepare_wheel(context, row, rotors, shapes);
}

Result<void> measure_rotor(Row row, const RotorRows& rotors, MassProperties& solid) { return measure_wheel(row, rotors, solid); }

}  // namespace plab::shapes
