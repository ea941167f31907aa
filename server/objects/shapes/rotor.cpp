#include "rotor.h"

#include <array>
#include <numbers>

#include "volume_integration.h"

namespace plab::shapes
{
namespace
{

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

}  // namespace

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
    auto mesh = mesh_of(row, rotors);
    if (!mesh) return mesh.error();
    shapes.geometry[context.facet_of_row[row]] = mesh.take().geometry(rotors.shape.pose(row), rotors.hull_collides[row]);
    return {};
}

Result<void> measure_rotor(Row row, const RotorRows& rotors, MassProperties& solid)
{
    const auto mesh = mesh_of(row, rotors);
    if (!mesh) return mesh.error();
    const auto solid_S = solid_mesh(mesh->vertices, mesh->triangles);
    if (!solid_S) return solid_S.error();
    solid = posed(*solid_S, rotors.shape.pose(row));
    return {};
}

}  // namespace plab::shapes
