/// Shafts with wheels in a scene with rules, and what the rules made.
#pragma once

#include <string>

#include "control/component_requests.h"
#include "support/scene.h"

namespace plab::test
{

/// A wheel of pitch radius r on a shaft about z.
inline std::string wheel(const std::string& id, double r, const std::string& position, const std::string& more = "")
{
    return "<component id='" + id + "_form' type='Shape/Gear' pitch_radius='" + std::to_string(r) +
           "' teeth='20' width='0.02'/><component id='" + id + "' type='State/Shaft' inertia='0.01' shape='" + id + "_form' position='" +
           position + "' " + more + "/>";
}

/// Wheels that mesh are coupled.
inline std::string meshing(const std::string& more = "", const std::string& id = "mesh")
{
    return "<component id='" + id +
           "' type='Rule/Pair' a_shape='Shape/Gear' b_shape='Shape/Gear' relation='meshing' reach='1' tolerance='0.005' " +
           "angle='1 deg' " + more +
           "><template><component id='${rule}.${a}.${b}' type='Constraint/AngularVelocity/Graph' driver='${a}' driven='${b}' "
           "velocity_factor='${-a.radius / b.radius}'/></template></component>";
}

/// To be called before the first step.
inline void serve(Scene& scene)
{
    REQUIRE_MESSAGE(scene.loaded(), scene.error());
    scene.simulation().read_requests_with(control::component_request_reader(library(), {}));
    scene.keep_events = true;
}

inline bool exists(const Scene& scene, const std::string& id) { return scene.simulation().world().find(id) != kNoIndex; }

inline std::string made_by(const Scene& scene, const std::string& id)
{
    const model::ComponentSpec* spec = scene.simulation().world().scene().find(id);
    return spec ? spec->made_by : "no component";
}

inline void set(Scene& scene, const std::string& id, const std::string& name, const std::string& value)
{
    const auto reply = scene.ask(simulation::SetOperation{id, name, value});
    REQUIRE_MESSAGE(reply.done, first_error(reply.errors));
}

inline std::string message_of(const Scene& scene, const std::string& kind)
{
    for (const Event& e : scene.events)
        if (e.kind == kind) return e.message;
    return {};
}

}  // namespace plab::test
