#include "viewer/scene_model.h"

#include <algorithm>
#include <cmath>

#include "plab/rotation.h"

namespace plab::view
{
namespace
{

std::optional<render::Form> form_of(const std::string& name)
{
    if (name == "sphere") return render::Form::Sphere;
    if (name == "box") return render::Form::Box;
    if (name == "plane") return render::Form::Plane;
    if (name == "mesh" || name == "compound") return render::Form::Mesh;
    if (name == "cylinder") return render::Form::Cylinder;
    if (name == "capsule") return render::Form::Capsule;
    return {};  // "none", and forms of newer servers
}

/// The row with this handle; null if there is none.
template <class T>
const T* find_row(const std::vector<T>& rows, std::uint32_t handle)
{
    const auto row = std::lower_bound(rows.begin(), rows.end(), handle, [](const T& r, std::uint32_t h) { return r.handle < h; });
    return row != rows.end() && row->handle == handle ? &*row : nullptr;
}

bool same_mesh(const render::Mesh& mesh, const link::Shape& shape)
{
    return mesh.vertices == shape.vertices && mesh.triangles == link::triangles_of(shape);
}

render::Mesh mesh_of(const link::Shape& shape) { return {shape.vertices, link::triangles_of(shape)}; }

}  // namespace

State state_of_catalogue(const link::CatalogueContents& scene, const link::ServerInfo& server)
{
    State out{server.run, server.revision, server.step, server.time, {}, {}};
    for (const auto& [id, object] : scene.objects)
    {
        if (link::is_shaft(object))
            out.shafts.push_back({object.handle, link::shaft_angle(object)});
        else if (object.motion != "static")
            out.bodies.push_back({object.handle, {object.position, object.orientation}});
    }
    const auto by_handle = [](const auto& a, const auto& b) { return a.handle < b.handle; };
    std::sort(out.bodies.begin(), out.bodies.end(), by_handle);
    std::sort(out.shafts.begin(), out.shafts.end(), by_handle);
    return out;
}

void SceneModel::use(std::shared_ptr<const link::CatalogueContents> scene)
{
    if (scene == scene_) return;
    scene_ = std::move(scene);
    rebuild_meshes();
    captions_.use(*scene_);
    props_.clear();
    for (const auto& [id, object] : scene_->objects) add_prop(object);
}

void SceneModel::rebuild_meshes()
{
    std::vector<const link::Shape*> wanted;
    for (const auto& [id, shape] : scene_->shapes)
        if (form_of(shape.form) == render::Form::Mesh) wanted.push_back(&shape);
    const auto as_before = [this](const link::Shape* shape)
    {
        const auto known = std::find(mesh_ids_.begin(), mesh_ids_.end(), shape->component_id);
        return known != mesh_ids_.end() && same_mesh(drawing_.meshes[static_cast<std::size_t>(known - mesh_ids_.begin())], *shape);
    };
    if (wanted.size() == mesh_ids_.size() && std::all_of(wanted.begin(), wanted.end(), as_before)) return;
    mesh_ids_.clear();
    drawing_.meshes.clear();
    for (const link::Shape* shape : wanted)
    {
        mesh_ids_.push_back(shape->component_id);
        drawing_.meshes.push_back(mesh_of(*shape));
    }
    ++drawing_.meshes_revision;
}

void SceneModel::add_parts(const link::Object& object, const Vec3& color, std::vector<Part>& out) const
{
    for (const std::string& id : object.shapes)
    {
        const auto shape = scene_->shapes.find(id);
        if (shape == scene_->shapes.end()) continue;  // it arrives with a later snapshot
        const std::optional<render::Form> form = form_of(shape->second.form);
        if (!form) continue;
        Part part{*form, {shape->second.position, shape->second.orientation}, shape->second.size, color, 0};
        if (*form == render::Form::Mesh)
            part.mesh = static_cast<std::uint32_t>(std::find(mesh_ids_.begin(), mesh_ids_.end(), id) - mesh_ids_.begin());
        out.push_back(part);
    }
}

void SceneModel::add_prop(const link::Object& object)
{
    const bool is_static = !link::is_shaft(object) && object.motion == "static";
    const Vec3 color = link::shown_color(object);
    Prop prop{object.component_id, object.handle, object.run, link::is_shaft(object), is_static, {object.position, object.orientation}, {}};
    add_parts(object, color, prop.parts);
    if (link::is_shaft(object) && object.shapes.empty())
    {
        const link::Axle axle = link::axle_of_inertia(object.mass);
        prop.parts.push_back({render::Form::Cylinder, {}, {axle.radius, axle.radius, axle.half_length}, color, 0});
        prop.parts.push_back({render::Form::Box, {axle.mark_position, {}}, axle.mark_size, link::kMarkColor, 0});
    }
    props_.push_back(std::move(prop));
}

std::optional<Pose> SceneModel::pose_of(const Prop& prop, const State& state) const
{
    if (prop.is_static) return prop.X_WB;
    // Handles are never reused within a run, but they are in the next one.
    if (prop.run != state.run) return {};
    if (prop.is_shaft)
    {
        const Shaft* const shaft = find_row(state.shafts, prop.handle);
        if (shaft == nullptr) return {};
        return Pose{prop.X_WB.p, prop.X_WB.q * link::shaft_rotation(shaft->angle)};
    }
    const Body* const body = find_row(state.bodies, prop.handle);
    if (body == nullptr) return {};
    return body->pose;
}

render::Drawing& SceneModel::draw(const State& state)
{
    drawing_.items.clear();
    for (const Prop& prop : props_)
        if (const std::optional<Pose> X_WB = pose_of(prop, state))
            for (const Part& part : prop.parts) drawing_.items.push_back({part.form, *X_WB * part.X_BS, part.size, part.color, part.mesh});
    drawing_.ground = overlays_.ground;
    drawing_.captions.clear();
    if (overlays_.captions)
        for (std::string& line : captions_.lines(state)) drawing_.captions.push_back({std::move(line), false});
    return drawing_;
}

const std::vector<link::Camera>& SceneModel::cameras() const
{
    static const std::vector<link::Camera> kNone;
    return scene_ && scene_->scene ? scene_->scene->cameras : kNone;
}

bool SceneModel::has_object(const std::string& id) const { return scene_ && scene_->objects.contains(id); }

std::optional<Vec3> SceneModel::position_of(const std::string& id, const State& state) const
{
    for (const Prop& prop : props_)
        if (prop.id == id)
        {
            const std::optional<Pose> pose = pose_of(prop, state);
            return pose ? std::optional(pose->p) : std::nullopt;
        }
    return {};
}

}  // namespace plab::view
