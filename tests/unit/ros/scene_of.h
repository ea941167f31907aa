/// Scenes as the catalogue of a server has them, and frames of them, for tests of what ROS sees.
#pragma once

#include <doctest/doctest.h>

#include "ros/scene_frames.h"

namespace plab::test
{

inline link::Object object(const std::string& id, std::uint32_t handle, const std::string& motion = "dynamic", const Pose& pose = {})
{
    link::Object out;
    out.component_id = id, out.name = id, out.handle = handle, out.type_name = "State/RigidBody";
    out.shape_of = "body", out.motion = motion, out.position = pose.p, out.orientation = pose.q, out.color = {-1, -1, -1};
    return out;
}

inline link::Object shaft(const std::string& id, std::uint32_t handle, const Pose& axle = {})
{
    link::Object out = object(id, handle, "dynamic", axle);
    out.shape_of = "shaft", out.type_name = "State/Shaft";
    return out;
}

inline void add(link::CatalogueContents& scene, const link::Object& object) { scene.objects[object.component_id] = object; }

inline void add_shape(link::CatalogueContents& scene, const std::string& owner, const std::string& form, const Vec3& size,
                      const Pose& X_BS = {})
{
    link::Shape shape;
    shape.component_id = owner + "." + form, shape.form = form, shape.size = size, shape.position = X_BS.p, shape.orientation = X_BS.q;
    scene.shapes[shape.component_id] = shape;
    scene.objects[owner].shapes.push_back(shape.component_id);
}

/// A joint or a drive between two bodies; "" is the world.
inline link::Interaction interaction(const std::string& id, const std::string& type, const std::string& a, const std::string& b,
                                     std::vector<link::Parameter> parameters)
{
    link::Interaction out;
    out.component_id = id, out.type_name = type, out.parameters = std::move(parameters);
    out.roles.push_back({"a", a.empty() ? std::vector<std::string>{} : std::vector<std::string>{a}});
    out.roles.push_back({"b", {b}});
    return out;
}

/// A frame that owns its states.
struct TestFrame
{
    std::vector<plab_v2_BodyState> bodies;
    std::vector<plab_v2_ShaftState> shafts;
    plab_v2_Frame frame{};

    void add(std::uint32_t handle, const Pose& X, const Vec3& v = {}, const Vec3& w = {})
    {
        bodies.push_back({handle, {X.p.x, X.p.y, X.p.z}, {X.q.w, X.q.x, X.q.y, X.q.z}, {v.x, v.y, v.z}, {w.x, w.y, w.z}});
    }
    const plab_v2_Frame& at(double time)
    {
        frame.time = time;
        frame.bodies._buffer = bodies.data(), frame.bodies._length = static_cast<std::uint32_t>(bodies.size());
        frame.shafts._buffer = shafts.data(), frame.shafts._length = static_cast<std::uint32_t>(shafts.size());
        return frame;
    }
};

inline Quat turn_about_z(double angle) { return {std::cos(angle / 2), 0, 0, std::sin(angle / 2)}; }

}  // namespace plab::test
