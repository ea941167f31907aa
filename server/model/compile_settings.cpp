/// <scene>: time step, seed, default solver, title, cameras.

#include <algorithm>
#include <numbers>

#include "model/compile_internal.h"
#include "model/names.h"
#include "model/numbers.h"
#include "model/text.h"
#include "model/values.h"

namespace plab::model::detail
{

namespace
{

Field make_field(std::string name, FieldType type, Unit unit)
{
    Field field;
    field.name = std::move(name);
    field.type = type;
    field.unit = unit;
    return field;
}

std::vector<std::string> setting_names() { return {"dt", "seed", "solver", "title"}; }

void complain(Compilation& c, const TextNode& text, std::string why) { c.report.add(text.where, "scene", std::move(why)); }

void read_setting(Compilation& c, const TextNode& text)
{
    if (text.name == "title")
        c.settings.title = text.text;
    else if (text.name == "dt")
    {
        Result<StepLength> dt = parse_step_length(text.text);
        if (!dt) return complain(c, text, dt.error().reason);
        c.settings.dt = *dt;
    }
    else if (text.name == "seed")
    {
        Result<std::uint64_t> seed = parse_unsigned(trimmed(text.text));
        if (!seed) return complain(c, text, "seed: " + seed.error().reason);
        c.settings.seed = *seed;
    }
    else if (text.name == "solver")
    {
        if (trimmed(text.text).empty()) return complain(c, text, "solver is empty: give the id or the type of a solver");
        c.settings.solver = std::string(trimmed(text.text));
        c.solver_place = text.where;
    }
    else
        complain(c, text,
                 "unknown setting " + quoted(text.name) + did_you_mean(text.name, setting_names()) + " (settings are " +
                     quoted_list(setting_names()) + ")");
}

/// Parses into a camera's own variable.
template <class T>
void read_camera_value(Compilation& c, const ComponentNode& node, const TextNode& text, const Field& field, T& out)
{
    Result<Value> value = parse_value(text.text, field);
    if (!value) return c.report.add(text.where, "camera " + quoted(node.id), value.error().reason);
    out = std::get<T>(*value);
}

void read_camera_attribute(Compilation& c, const ComponentNode& node, const TextNode& text, Camera& camera)
{
    const std::vector<std::string> names{"position", "look_at", "up", "field_of_view"};
    Field field = make_field(text.name, FieldType::Vector, unit::metre);
    if (text.name == "position") return read_camera_value(c, node, text, field, camera.position);
    if (text.name == "look_at") return read_camera_value(c, node, text, field, camera.look_at);
    if (text.name == "up")
    {
        field.unit = unit::one;
        field.rules.push_back({Rule::Kind::UnitLength, 0, {}});
        return read_camera_value(c, node, text, field, camera.up);
    }
    if (text.name == "field_of_view")
    {
        field = make_field(text.name, FieldType::Real, unit::radian);
        field.rules.push_back({Rule::Kind::MoreThan, 0, {}});
        field.rules.push_back({Rule::Kind::AtMost, 0.99 * std::numbers::pi, {}});
        return read_camera_value(c, node, text, field, camera.field_of_view);
    }
    c.report.add(text.where, "camera " + quoted(node.id), "unknown attribute " + quoted(text.name) + did_you_mean(text.name, names));
}

void read_camera(Compilation& c, const ComponentNode& node)
{
    Camera camera;
    camera.name = node.id.empty() ? node.name : node.id;
    for (const TextNode& text : node.attributes) read_camera_attribute(c, node, text, camera);
    for (const TextNode& text : node.parameters) read_camera_attribute(c, node, text, camera);
    const std::string element = "camera " + quoted(camera.name);
    if (camera.name.empty()) c.report.add(node.where, "camera", "needs an id");
    if (camera.position == camera.look_at) c.report.add(node.where, element, "must not look at its own position");
    if (cross(camera.look_at - camera.position, camera.up) == Vec3{})
        c.report.add(node.where, element, "must not look along its up direction");
    for (const Camera& other : c.settings.cameras)
        if (other.name == camera.name) c.report.add(node.where, element, "is given twice");
    c.settings.cameras.push_back(std::move(camera));
}

}  // namespace

void read_settings(Compilation& c)
{
    c.solver_place = c.blueprint->where;
    if (c.existing)
    {
        // A fragment uses the settings of the scene to which it is added.
        c.settings = c.existing->settings;
        for (const TextNode& text : c.blueprint->settings)
            complain(c, text, text.name + " belongs to the scene, not to a part that is added");
        for (const ComponentNode& camera : c.blueprint->cameras)
            c.report.add(camera.where, "camera " + quoted(camera.id), "belongs to the scene, not to a part that is added");
        return;
    }
    std::unordered_set<std::string> seen;
    for (const TextNode& text : c.blueprint->settings)
    {
        if (!seen.insert(text.name).second) complain(c, text, text.name + " is given twice");
        read_setting(c, text);
    }
    for (const ComponentNode& camera : c.blueprint->cameras) read_camera(c, camera);
}

void settle_solver(Compilation& c)
{
    if (c.existing || c.settings.solver == SceneSettings{}.solver) return;
    std::string written = c.settings.solver;
    const std::size_t found = c.directory.follow(c.directory.find(written));
    if (found != kNone)
    {
        const Draft& d = c.draft(found);
        if (d.broken || d.type_name.starts_with("Solver/")) return;
        c.solver_broken = true;
        return c.report.add(c.solver_place, "scene", "solver " + quoted(written) + " is not a component of type Solver/...");
    }
    c.solver_broken = true;
    if (Result<std::string> name = c.full_type_name(written, "Solver/")) written = name.take();
    if (written.find('/') == std::string::npos)
        return c.report.add_unknown_id(c.solver_place, "scene", "solver: no component has the id " + quoted(written), written);
    if (!written.starts_with("Solver/"))
        return c.report.add(c.solver_place, "scene", "solver must be of type Solver/..., not " + quoted(written));
    if (!c.is_type_name(written))
        return c.report.add(c.solver_place, "scene", "solver: unknown type " + quoted(written) + did_you_mean(written, c.type_names));
    c.settings.solver = SceneSettings{}.solver;
    const std::size_t own = c.directory.find(c.settings.solver);
    if (own != kNone && c.draft(own).type_name != written)
        return c.report.add(c.solver_place, "scene",
                            "solver is " + quoted(written) + " here, but component " + quoted(c.settings.solver) + " is of type " +
                                quoted(c.draft(own).type_name));
    c.settings.solver_type = written;
    c.solver_broken = false;
}

}  // namespace plab::model::detail
