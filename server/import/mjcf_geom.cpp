#include "import/mjcf_geom.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "import/solid_shapes.h"
#include "import/surface_law.h"
#include "model/numbers.h"
#include "objects/shapes/volume_integration.h"

namespace plab::import
{
namespace
{

std::optional<ShapeKind> kind_of(const std::string& type)
{
    if (type == "plane") return ShapeKind::Plane;
    if (type == "sphere" || type.empty()) return ShapeKind::Sphere;
    if (type == "capsule") return ShapeKind::Capsule;
    if (type == "ellipsoid") return ShapeKind::Ellipsoid;
    if (type == "cylinder") return ShapeKind::Cylinder;
    if (type == "box") return ShapeKind::Box;
    if (type == "mesh") return ShapeKind::Mesh;
    return {};
}

std::size_t sizes_of(ShapeKind kind)
{
    if (kind == ShapeKind::Box || kind == ShapeKind::Ellipsoid) return 3;
    return kind == ShapeKind::Cylinder || kind == ShapeKind::Capsule ? 2 : kind == ShapeKind::Sphere ? 1 : 0;
}

/// size, or fromto with the first number of size.
bool read_size(const XmlElement& e, RobotShape& shape, Document& document)
{
    const std::size_t wanted = sizes_of(shape.kind);
    if (wanted == 0) return true;
    double ends[6], size[3] = {0, 0, 0};
    const bool between = document.numbers(e, "fromto", ends, 6) == 6;
    if (between && wanted < 2) return document.error(e, "fromto is for capsules, cylinders, boxes and ellipsoids"), false;
    const std::size_t needed = between ? 1 : wanted;
    if (!e.find_attribute("size")) return document.error(e, "needs a size"), false;
    if (document.numbers(e, "size", size, needed) < needed) return false;  // more numbers do not matter
    if (between)
    {
        const Vec3 a{ends[0], ends[1], ends[2]}, b{ends[3], ends[4], ends[5]};
        size[wanted - 1] = length(b - a) / 2;
        if (wanted == 3) size[1] = size[0];
        if (!(size[wanted - 1] > 1e-12)) return document.error(e, "the two points of fromto must differ"), false;
        shape.pose = {(a + b) * 0.5, rotation_from_z(normalized(b - a))};
    }
    for (std::size_t i = 0; i < wanted; ++i)
        if (!(size[i] > 0)) return document.error(e, "size must be positive"), false;
    shape.size = wanted == 2 ? Vec3{size[0], 0, size[1]} : Vec3{size[0], size[1], size[2]};
    return true;
}

/// What it lets a contact do beyond a rebound is listed.
Solref read_solref(const XmlElement& e, MjcfSettings& settings, Document& document)
{
    double given[2] = {0.02, 1};
    if (document.numbers(e, "solref", given, 1) == 0) return {};
    const Solref out{given[0], given[1]};
    if ((out.first > 0) != (out.second > 0)) return document.error(e, "solref must be two positive numbers, or two that are not"), Solref{};
    const ContactSpring spring = spring_of(out);
    if (settings.is_new(document.text(e, "solref")))
        document.lost(e, "solref: contacts are rigid; the spring of " + model::format_real(spring.frequency / (2 * std::numbers::pi)) +
                             " 1/s with the damping ratio " + model::format_real(spring.ratio) +
                             " is not carried over, but for its rebound (a Manager/SoftStep has hertz and damping_ratio)");
    return out;
}

void read_contact(const XmlElement& e, RobotShape& shape, MjcfSettings& settings, Document& document)
{
    const auto word = [&](const char* name)
    {
        const double value = document.number(e, name, 1);
        if (value >= 0 && value <= 4294967295.0 && value == std::floor(value)) return static_cast<std::uint32_t>(value);
        return document.error(e, std::string(name) + " must be a whole number of 32 bits"), std::uint32_t{0};
    };
    shape.contact_type = word("contype"), shape.contact_affinity = word("conaffinity");
    Surface& surface = shape.surface;
    double friction[3] = {surface.friction, surface.twisting, surface.rolling};
    (void)document.numbers(e, "friction", friction, 1);
    surface.friction = friction[0], surface.twisting = friction[1], surface.rolling = friction[2];
    if (surface.friction < 0 || surface.twisting < 0 || surface.rolling < 0) document.error(e, "friction must not be negative");
    const double condim = document.number(e, "condim", 3);
    if (condim != 1 && condim != 3 && condim != 4 && condim != 6) document.error(e, "condim must be one of 1, 3, 4, 6");
    surface.dimensions = static_cast<int>(condim);
    surface.priority = static_cast<int>(std::clamp(document.number(e, "priority", 0), -1e6, 1e6));
    surface.solref = read_solref(e, settings, document);
}

MassProperties mass_of(const XmlElement& e, const RobotShape& shape, Document& document)
{
    if (shape.kind == ShapeKind::Plane) return {};
    const auto solid = solid_of(shape);
    if (!solid) return document.error(e, solid.error().reason + ": give the body an <inertial>"), MassProperties{};
    MassProperties out = shapes::posed(*solid, shape.pose);
    const double mass = document.number(e, "mass", -1), density = document.number(e, "density", 1000);
    if (density < 0 || (e.find_attribute("mass") && mass < 0)) document.error(e, "mass and density must not be negative");
    const double factor = mass >= 0 ? mass / out.mass : density;
    out.mass = mass >= 0 ? mass : out.mass * density;
    out.inertia = out.inertia * factor;
    return out;
}

}  // namespace

std::optional<MjcfGeom> read_geom(const XmlElement& e, bool has_mass, MjcfSettings& settings, Document& document)
{
    MjcfGeom out;
    std::string type = document.text(e, "type");
    const std::string mesh = document.text(e, "mesh");
    if (type.empty() && !mesh.empty()) type = "mesh";
    const auto kind = kind_of(type);
    if (!kind) return document.lost(e, "a shape of type '" + type + "' is not carried over"), std::nullopt;
    if (*kind != ShapeKind::Mesh && !mesh.empty()) document.lost(e, "a shape fitted to the mesh '" + mesh + "' is not carried over");
    if (*kind != ShapeKind::Mesh && !mesh.empty()) return {};
    RobotShape& shape = out.shape;
    shape.kind = *kind, shape.where = e.where, shape.name = document.text(e, "name");
    shape.pose = settings.pose(e);
    if (!read_size(e, shape, document)) return {};
    if (shape.kind == ShapeKind::Mesh && !(shape.mesh = settings.mesh(mesh)))
        return document.lost(e, "is left out: there is no mesh '" + mesh + "'"), std::nullopt;
    const std::string material = document.text(e, "material");
    if (!material.empty()) shape.color = settings.material(material);
    if (const auto color = settings.color(e)) shape.color = color;
    read_contact(e, shape, settings, document);
    if (has_mass) out.mass = mass_of(e, shape, document);
    return out;
}

}  // namespace plab::import
