#include "import/mjcf_settings.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "import/mesh_file.h"
#include "model/numbers.h"

namespace plab::import
{
namespace
{

constexpr std::array<std::string_view, 5> kOrientations{"quat", "axisangle", "euler", "xyaxes", "zaxis"};

double from_0_to_1(double x) { return std::fmin(1, std::fmax(0, x)); }

/// Elements that share defaults: those of actuators and of tendons have one set in a class each.
std::string default_of(const std::string& name) { return is_actuator(name) ? "actuator" : name == "spatial" ? "tendon" : name; }

bool is_default_of(std::string_view name)
{
    return name == "geom" || name == "joint" || name == "site" || name == "mesh" || name == "material" || name == "tendon" ||
           is_actuator(name);
}

/// However many there are; none with an error if one is faulty.
std::vector<double> all_numbers(const XmlElement& e, std::string_view attribute, Document& document)
{
    const std::string* const text = e.find_attribute(attribute);
    std::vector<double> out(text ? text->size() / 2 + 1 : 0);
    out.resize(document.numbers(e, attribute, out, 1));
    return out;
}

}  // namespace

bool is_actuator(std::string_view name) { return name == "motor" || name == "position" || name == "velocity" || name == "general"; }

void list_unused_attributes(const XmlElement& e, Document& document)
{
    document.list_children(e, {});
    // What sites and tendons look like does not matter: they are not drawn.
    if (e.name == "site")
        document.list_attributes(
            e, {"name", "class", "pos", "quat", "axisangle", "euler", "xyaxes", "zaxis", "type", "size", "group", "rgba", "material"});
    if (e.name == "tendon")
        document.list_attributes(
            e, {"class", "limited", "range", "springlength", "stiffness", "damping", "group", "width", "rgba", "material"});
    if (e.name == "geom")
        document.list_attributes(
            e, {"name", "class",   "type", "size",     "fromto",  "pos",         "quat",     "axisangle", "euler",  "xyaxes",   "zaxis",
                "mass", "density", "rgba", "material", "contype", "conaffinity", "friction", "mesh",      "condim", "priority", "solref"});
    if (e.name == "joint")
        document.list_attributes(e, {"name", "class", "type", "pos", "axis", "range", "limited", "ref", "springref", "stiffness", "damping",
                                     "frictionloss", "armature"});
    if (e.name == "motor")
        document.list_attributes(e, {"name", "class", "joint", "tendon", "gear", "ctrlrange", "ctrllimited", "forcerange", "forcelimited"});
    if (e.name == "position")
        document.list_attributes(e, {"name", "class", "joint", "tendon", "gear", "ctrlrange", "ctrllimited", "forcerange", "forcelimited",
                                     "kp", "kv", "timeconst", "dampratio"});
    if (e.name == "velocity")
        document.list_attributes(
            e, {"name", "class", "joint", "tendon", "gear", "ctrlrange", "ctrllimited", "forcerange", "forcelimited", "kv"});
    if (e.name == "general")
        document.list_attributes(e, {"name", "class", "joint", "tendon", "gear", "ctrlrange", "ctrllimited", "forcerange", "forcelimited",
                                     "dyntype", "gaintype", "gainprm", "biastype", "biasprm"});
    if (e.name == "mesh") document.list_attributes(e, {"name", "class", "file", "scale", "vertex", "face"});
    if (e.name == "material") document.list_attributes(e, {"name", "class", "rgba"});
}

MjcfSettings::MjcfSettings(const XmlElement& root, Document& document) : document_(document)
{
    for (const XmlElement& e : root.children)
        if (e.name == "compiler")
            read_compiler(e);
        else if (e.name == "option")
            read_option(e);
    classes_["main"];
    for (const XmlElement& e : root.children)
        if (e.name == "default") read_class(e, classes_["main"], "main");
    for (const XmlElement& e : root.children)
        if (e.name == "asset") read_assets(e);
}

void MjcfSettings::read_compiler(const XmlElement& e)
{
    document_.list_attributes(e,
                              {"angle", "coordinate", "eulerseq", "inertiafromgeom", "autolimits", "meshdir", "assetdir", "settotalmass"});
    const auto choose = [&](const char* name, const std::string& otherwise, std::initializer_list<std::string_view> allowed)
    {
        const std::string value = document_.text(e, name);
        if (value.empty() || std::ranges::find(allowed, value) != allowed.end()) return value.empty() ? otherwise : value;
        document_.error(e, std::string(name) + " cannot be '" + value + "'");
        return otherwise;
    };
    degrees_ = choose("angle", degrees_ ? "degree" : "radian", {"degree", "radian"}) == "degree";
    if (choose("coordinate", "local", {"local", "global"}) == "global") document_.error(e, "coordinate=\"global\" is not supported");
    inertia_from_geom_ = choose("inertiafromgeom", inertia_from_geom_, {"auto", "true", "false"});
    auto_limits_ = choose("autolimits", auto_limits_ ? "true" : "false", {"true", "false"}) == "true";
    total_mass_ = document_.number(e, "settotalmass", total_mass_);
    if (const std::string* const folder = e.find_attribute("assetdir")) mesh_folder_ = *folder;
    if (const std::string* const folder = e.find_attribute("meshdir")) mesh_folder_ = *folder;
    const std::string sequence = document_.text(e, "eulerseq");
    if (sequence.empty()) return;
    euler_sequence_ = sequence;
    if (sequence.size() == 3 && sequence.find_first_not_of("xyzXYZ") == std::string::npos) return;
    document_.error(e, "eulerseq must be three of x, y, z, X, Y, Z, not '" + sequence + "'");
    euler_sequence_ = "xyz";
}

void MjcfSettings::read_option(const XmlElement& e)
{
    document_.list_attributes(e, {"timestep", "gravity"});
    document_.list_children(e, {"flag"});
    gravity_ = document_.vector(e, "gravity", gravity_);
    for (const XmlElement& flag : e.children)
    {
        if (flag.name != "flag") continue;
        document_.list_attributes(flag, {"contact", "gravity", "energy"});
        if (document_.text(flag, "contact") == "disable") collisions_ = false;
        if (document_.text(flag, "gravity") == "disable") gravity_ = {};
    }
    if (!e.find_attribute("timestep")) return;
    const double step = document_.positive(e, "timestep");
    if (step > 0 && (step < 1e-9 || step > 3600)) document_.error(e, "timestep must be from 1e-9 s to 3600 s");
    if (step > 0) step_ = model::format_real(step);
}

void MjcfSettings::read_class(const XmlElement& e, const Class& parent, const std::string& name)
{
    Class own = parent;
    for (const XmlElement& child : e.children)
    {
        if (child.name == "default") continue;
        if (!is_default_of(child.name))
        {
            document_.lost(child, "defaults of this element are not carried over");
            continue;
        }
        list_unused_attributes(child, document_);
        for (const auto& a : child.attributes) own[default_of(child.name)][a.name] = a.value;
    }
    classes_[name] = own;
    for (const XmlElement& child : e.children)
        if (child.name == "default")
        {
            const std::string nested = document_.text(child, "class");
            if (nested.empty()) document_.error(child, "needs a class");
            read_class(child, own, nested);
        }
}

XmlElement MjcfSettings::resolved(const XmlElement& e, const std::string& inherited)
{
    XmlElement out;
    out.name = e.name, out.where = e.where, out.attributes = e.attributes;
    const std::string* const own = e.find_attribute("class");
    const std::string name = own ? *own : inherited.empty() ? "main" : inherited;
    const auto found = classes_.find(name);
    if (found == classes_.end()) return document_.error(e, "there is no default class '" + name + "'"), out;
    const auto defaults = found->second.find(default_of(e.name));
    if (defaults == found->second.end()) return out;
    for (const auto& [attribute, value] : defaults->second)
        if (attribute != "class" && !e.find_attribute(attribute)) out.attributes.push_back({attribute, value});
    return out;
}

bool MjcfSettings::turned(const XmlElement& e) const
{
    return std::ranges::any_of(kOrientations, [&](std::string_view name) { return e.find_attribute(name) != nullptr; });
}

Quat MjcfSettings::euler(const Vec3& angles)
{
    Quat out;
    for (int i = 0; i < 3; ++i)
    {
        const char c = euler_sequence_[std::size_t(i)];
        const bool fixed_axes = c >= 'X' && c <= 'Z';
        Vec3 axis;
        axis[fixed_axes ? c - 'X' : c - 'x'] = 1;
        const Quat turn = rotation_about(axis, angle(angles[i]));
        out = fixed_axes ? turn * out : out * turn;
    }
    return normalized(out);
}

Pose MjcfSettings::pose(const XmlElement& e)
{
    Pose out{document_.vector(e, "pos", {}), {}};
    if (std::ranges::count_if(kOrientations, [&](std::string_view name) { return e.find_attribute(name) != nullptr; }) > 1)
        document_.error(e, "has more than one of quat, axisangle, euler, xyaxes, zaxis");
    double v[6];
    if (document_.numbers(e, "quat", std::span(v, 4), 4) == 4)
    {
        const Quat q{v[0], v[1], v[2], v[3]};
        if (!(norm(q) > 1e-30)) return document_.error(e, "quat must not be zero"), out;
        out.q = normalized(q);
    }
    if (document_.numbers(e, "axisangle", std::span(v, 4), 4) == 4)
    {
        const Vec3 axis = normalized(Vec3{v[0], v[1], v[2]});
        if (axis == Vec3{}) return document_.error(e, "axisangle needs an axis that is not zero"), out;
        out.q = rotation_about(axis, angle(v[3]));
    }
    if (document_.numbers(e, "euler", std::span(v, 3), 3) == 3) out.q = euler({v[0], v[1], v[2]});
    if (document_.numbers(e, "xyaxes", v, 6) == 6)
    {
        const Vec3 x = normalized(Vec3{v[0], v[1], v[2]}), given{v[3], v[4], v[5]};
        const Vec3 y = normalized(given - x * dot(x, given));
        if (x == Vec3{} || length(y) < 0.5) return document_.error(e, "xyaxes must be two directions that are not parallel"), out;
        out.q = rotation_of_columns(x, y, cross(x, y));
    }
    if (e.find_attribute("zaxis")) out.q = rotation_from_z(document_.direction(e, "zaxis", {0, 0, 1}));
    return out;
}

std::optional<Vec3> MjcfSettings::color(const XmlElement& e)
{
    double c[4];
    if (document_.numbers(e, "rgba", c, 4) != 4) return {};
    return Vec3{from_0_to_1(c[0]), from_0_to_1(c[1]), from_0_to_1(c[2])};
}

std::optional<Vec3> MjcfSettings::material(const std::string& name) const
{
    const auto found = materials_.find(name);
    return found == materials_.end() ? std::nullopt : std::optional(found->second);
}

std::shared_ptr<const TriangleMesh> MjcfSettings::mesh(const std::string& name) const
{
    const auto found = meshes_.find(name);
    return found == meshes_.end() ? nullptr : found->second;
}

void MjcfSettings::read_assets(const XmlElement& e)
{
    document_.list_children(e, {"mesh", "material"});
    for (const XmlElement& child : e.children)
    {
        if (child.name != "mesh" && child.name != "material") continue;
        list_unused_attributes(child, document_);
        const XmlElement full = resolved(child, "");
        if (child.name == "mesh")
            read_mesh(full);
        else if (const auto found = color(full))
            materials_[document_.text(full, "name")] = *found;
    }
}

/// vertex and face.
void MjcfSettings::read_inline_mesh(const XmlElement& e, const std::string& name)
{
    if (!e.find_attribute("face")) return document_.lost(e, "is not carried over: it needs a face");
    const std::vector<double> points = all_numbers(e, "vertex", document_), corners = all_numbers(e, "face", document_);
    const Vec3 scale = document_.vector(e, "scale", {1, 1, 1});
    if (points.size() / 3 > kMostMeshVertices || corners.size() / 3 > kMostMeshTriangles)
        return document_.error(e, "has more than 100,000 vertices or 200,000 triangles");
    auto mesh = std::make_shared<TriangleMesh>();
    for (std::size_t i = 0; i + 2 < points.size(); i += 3)
        mesh->vertices.push_back({scale.x * points[i], scale.y * points[i + 1], scale.z * points[i + 2]});
    for (const double corner : corners)
    {
        if (!(corner >= 0 && corner < double(mesh->vertices.size()) && corner == std::floor(corner)))
            return document_.error(e, "face must name vertices by their numbers, from 0");
        mesh->triangles.push_back(static_cast<std::uint32_t>(corner));
    }
    if (mesh->triangles.empty() || points.size() % 3 != 0 || corners.size() % 3 != 0)
        return document_.error(e, "vertex and face must be triples of numbers");
    if (scale.x * scale.y * scale.z < 0)
        for (std::size_t i = 0; i < mesh->triangles.size(); i += 3) std::swap(mesh->triangles[i + 1], mesh->triangles[i + 2]);
    meshes_[name] = std::move(mesh);
}

void MjcfSettings::read_mesh(const XmlElement& e)
{
    const std::string file = document_.text(e, "file");
    std::string name = document_.text(e, "name");
    if (name.empty()) name = std::filesystem::path(file).stem().string();
    if (e.find_attribute("vertex")) return read_inline_mesh(e, name);
    if (file.empty()) return document_.lost(e, "is not carried over: only meshes in files, or with vertex and face, are");
    const std::string path = find_mesh_file(document_.file(), mesh_folder_, file);
    if (path.empty()) return document_.lost(e, "the mesh '" + file + "' is missing: its shapes are left out");
    auto mesh = read_mesh_file(path, document_.vector(e, "scale", {1, 1, 1}));
    if (!mesh) return document_.lost(e, mesh.error().reason + ": its shapes are left out");
    meshes_[name] = mesh.take();
}

}  // namespace plab::import
