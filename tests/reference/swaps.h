/// Shared by the tests of swaps: scenes in which every algorithm has something to do, and requests.
#pragma once

#include <algorithm>

#include "support/joints.h"

namespace plab::test
{

inline const std::vector<std::string>& solvers()
{
    static const std::vector<std::string> list{
        "SemiImplicitEuler", "StoermerVerlet",   "RungeKutta4", "DormandPrince54", "RotationSplitting", "Exact",
        "Exponential",       "ImplicitMidpoint", "Radau5",      "Automatic"};
    return list;
}
inline const std::vector<std::string>& responses()
{
    static const std::vector<std::string> list{"None", "Impulse", "Rows", "Penalty", "HuntCrossley"};
    return list;
}
inline const std::vector<std::string>& resolutions()
{
    static const std::vector<std::string> list{"None",     "Speculative", "Bisection", "LocalBisection", "ConservativeAdvancement",
                                               "LocalRoot"};
    return list;
}
inline const std::vector<std::string>& managers()
{
    static const std::vector<std::string> list{"Direct", "SequentialImpulse", "SoftStep"};
    return list;
}

/// The ground and the contact laws: ids `contact`, `contact.resolution`, `contact.response` and, for rows,
/// `contact.response.manager`.
inline std::string ground_and_contact(const std::string& resolution, const std::string& response, const std::string& more = "")
{
    std::string parts =
        "<component id='floor' type='Shape/Plane'/><component id='ground' type='State/Static' shape='floor'/>"
        "<component id='contact' type='CDetection/ODE' between='*' resolution='Resolution/" +
        resolution + "' response='Response/" + response + "' " + more + "/>";
    return parts;
}

/// A body that collides with its shape.
inline std::string solid(const std::string& id, const std::string& shape, double mass, const Vec3& position, const std::string& more = "")
{
    return "<component id='" + id + ".shape' type='Shape/" + shape + "/><component id='" + id + "' type='State/RigidBody' shape='" + id +
           ".shape' mass='" + text(mass) + "' position='" + text(position) + "' " + more + "/>";
}

/// A box on a box, a rolling ball, a bouncing ball, and a ball that spins far away.
inline std::string heap()
{
    return gravity() + solid("low", "Box' half_extents='0.2 0.2 0.1'", 2, {0, 0, 0.1}) +
           solid("high", "Box' half_extents='0.1 0.1 0.1'", 1, {0.02, 0.03, 0.3}) +
           solid("roller", "Sphere' radius='0.1'", 1, {1, 0, 0.1}, "linear_velocity='0.3 0.1 0' angular_velocity='1 3 0'") +
           solid("bouncer", "Sphere' radius='0.1'", 1, {2, 0, 0.5}) +
           solid("spinner", "Box' half_extents='0.1 0.2 0.3'", 1, {0, 0, 1000}, "linear_velocity='1 2 30' angular_velocity='3 0.1 0.2'");
}

/// A block on a slope of 30 degrees (inclined gravity), held by the stiction springs of its contacts, at 1/60 s.
inline Scene block_on_a_slope()
{
    return Scene(
        gravity("4.905 0 -8.495709211125344") + solid("a", "Box' half_extents='0.2 0.2 0.1'", 1, {0, 0, 0.1}) +
            ground_and_contact(
                "None", "Penalty",
                "response.stiffness='2e3' response.restitution='1' response.damping_ratio='1' response.tangential_damping_ratio='1' "
                "response.friction='0.6' response.steps_per_contact='20'"),
        dt(60));
}

inline simulation::Reply swap(Scene& s, const std::string& id, const std::string& type, std::vector<simulation::NamedValue> values = {})
{
    return s.ask(simulation::SwapOperation{id, type, std::move(values)});
}
/// A swap that must succeed.
inline simulation::Reply swapped(Scene& s, const std::string& id, const std::string& type, std::vector<simulation::NamedValue> values = {})
{
    simulation::Reply reply = swap(s, id, type, std::move(values));
    REQUIRE_MESSAGE(reply.done, id, " -> ", type, ": ", first_error(reply.errors));
    return reply;
}
inline std::vector<std::string> typed_ids(const Scene& s)
{
    std::vector<std::string> out;
    const world::World& world = s.simulation().world();
    for (const std::uint32_t i : world.in_id_order())
        if (world.type_of(i)) out.push_back(world.id_of(i));
    return out;
}
inline std::string type_name(const Scene& s, const std::string& id)
{
    return s.simulation().world().type_of(s.simulation().world().find(id))->info.name;
}
/// What the reply reports for a field: "kept", "lost" ...; empty if it reports nothing.
inline std::string transfer_of(const simulation::Reply& reply, const std::string& field)
{
    constexpr const char* kNames[] = {"kept", "converted", "given", "fresh", "lost"};
    for (const simulation::TransferredField& f : reply.swaps.at(0).fields)
        if (f.field.rfind(field, 0) == 0) return kNames[static_cast<int>(f.transfer)];
    return {};
}

}  // namespace plab::test
