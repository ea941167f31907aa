#include "simulation/step/render_scene.h"

#include <algorithm>
#include <cmath>

#include "plab/rotation.h"

namespace plab::simulation
{
namespace
{

Vec3 color_of(const world::World& world, std::uint32_t component, const Vec3& otherwise)
{
    const Value v = world.get(component, "color");
    const Vec3* color = std::get_if<Vec3>(&v);
    return color ? *color : otherwise;
}

/// A stage list may leave out Shape/Draw: then the shape collides and has mass, but is invisible.
bool draws(const world::World& world, const world::Component& shape)
{
    const int command = world.table_of(world.find(shape.id)).type().find_command("Shape/Draw");
    return command >= 0 && (shape.commands >> command & 1u) != 0;
}

/// Whether a component is an algorithm: neither an object nor a shape, and not a solver or camera.
bool is_algorithm(const world::World& world, std::uint32_t i)
{
    const world::Component& c = world.component(i);
    if (c.table == kNoIndex || c.facet != Facet::Component) return false;
    const std::string& type = world.type_of(i)->info.name;
    return !type.starts_with("Solver/") && !type.starts_with("Camera/");
}

}  // namespace

Pose pose_of_shaft(const Shafts& shafts, std::uint32_t shaft)
{
    const double half = 0.5 * shafts.angle[shaft];
    return {shafts.axle[shaft].p, shafts.axle[shaft].q * Quat{std::cos(half), 0, 0, std::sin(half)}};
}

void RenderSceneBuilder::add_shapes(const world::World& world, const world::Component& component, const RefList& shapes, const Vec3& color)
{
    for (const Ref shape : shapes)
    {
        const std::uint32_t owner = world.host().component_of(shape);
        if (owner == kNoIndex || !draws(world, world.component(owner))) continue;
        const Vec3 own = color_of(world, owner, {1, 1, 1});
        Thing thing;
        thing.facet = component.facet, thing.index = component.host_index;
        thing.visual.geometry = &world.host().shapes.geometry[shape.index];
        thing.visual.shape = shape.index;
        thing.visual.color = {color.x * own.x, color.y * own.y, color.z * own.z};
        thing.in_object = thing.visual.geometry->pose;
        things_.push_back(thing);
    }
}

void RenderSceneBuilder::learn_shaft(const world::World& world, const world::Component& component, const Vec3& color)
{
    const Shafts& shafts = world.host().shafts;
    if (!shafts.shapes[component.host_index].empty()) return add_shapes(world, component, shafts.shapes[component.host_index], color);
    // It has no shape that gives its size: draw a thin axle, thicker with larger inertia.
    const double inertia = shafts.motion[component.host_index] == Motion::Dynamic ? shafts.inertia[component.host_index] : 0.001;
    Thing thing;
    thing.facet = Facet::Shaft, thing.index = component.host_index;
    const double radius = std::clamp(0.2 * std::pow(inertia, 0.25), 0.01, 0.5);
    thing.visual.size = {radius, radius, 2 * radius};
    thing.visual.color = color;
    things_.push_back(thing);
}

void RenderSceneBuilder::learn(const world::World& world)
{
    things_.clear(), views_.clear(), algorithms_.clear();
    for (const std::uint32_t i : world.in_id_order())
    {
        const world::Component& c = world.component(i);
        const Vec3 color = c.facet == Facet::Body || c.facet == Facet::Shaft ? color_of(world, i, {1, 1, 1}) : Vec3{};
        if (c.facet == Facet::Body) add_shapes(world, c, world.host().bodies.shapes[c.host_index], color);
        if (c.facet == Facet::Shaft) learn_shaft(world, c, color);
        if (is_algorithm(world, i)) algorithms_.push_back(c.id + ": " + world.type_of(i)->info.name);
    }
    for (const model::Camera& camera : world.scene().settings.cameras)
        views_.push_back({camera.name, camera.position, camera.look_at, camera.up, camera.field_of_view});
    known_ = true;
}

RenderScene RenderSceneBuilder::view_of(const world::World& world)
{
    if (!known_) learn(world);
    visuals_.clear();
    for (const Thing& thing : things_)
    {
        visuals_.push_back(thing.visual);
        const Pose object =
            thing.facet == Facet::Body ? world.host().bodies.pose(thing.index) : pose_of_shaft(world.host().shafts, thing.index);
        visuals_.back().pose = object * thing.in_object;
    }
    return {visuals_, views_, algorithms_, revision_};
}

}  // namespace plab::simulation
