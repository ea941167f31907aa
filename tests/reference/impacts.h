/// Scenes of impacts, from blueprint text.
#pragma once

#include <string>
#include <vector>

#include "reference/contact_algorithms.h"
#include "support/ground.h"
#include "support/scene.h"
#include "support/text.h"

namespace plab::test
{

inline std::string sphere(const std::string& id, double radius, const std::string& attributes, const char* state = "RigidBody")
{
    return "<component id=\"" + id + ".shape\" type=\"Shape/Sphere\" radius=\"" + text(radius) + "\"/><component id=\"" + id +
           "\" type=\"State/" + state + "\" shape=\"" + id + ".shape\" " + attributes + "/>";
}
inline std::string box(const std::string& id, const Vec3& half, const std::string& attributes, const char* state = "RigidBody")
{
    return "<component id=\"" + id + ".shape\" type=\"Shape/Box\" half_extents=\"" + text(half) + "\"/><component id=\"" + id +
           "\" type=\"State/" + state + "\" shape=\"" + id + ".shape\" " + attributes + "/>";
}
inline std::string at(const Vec3& p, const Vec3& v = {}, double mass = 1)
{
    return "mass=\"" + text(mass) + "\" position=\"" + text(p) + "\" linear_velocity=\"" + text(v) + "\"";
}
inline std::string gravity(const std::string& between)
{
    return "<component id=\"g\" type=\"Field/Gravity\" between=\"" + between + "\"/>";
}
inline std::string gravity(const std::string& between, const Vec3& g)
{
    return "<component id=\"g\" type=\"Field/Gravity\" between=\"" + between + "\" acceleration=\"" + text(g) + "\"/>";
}
inline std::string contact(const std::string& between, const std::string& resolution, const std::string& restitution,
                           const std::string& more = "")
{
    return "<component id=\"contact\" type=\"CDetection/ODE\" between=\"" + between + "\" resolution=\"Resolution/" + resolution +
           "\" response=\"Response/Impulse\" response.restitution=\"" + restitution + "\" " + more + "/>";
}
/// Every resolution with every impulse response that accepts it; for all algorithms see contact_algorithms.h.
inline constexpr Algorithm kAlgorithms[] = {
    {"None", "Impulse"},           {"Bisection", "Impulse"},
    {"LocalBisection", "Impulse"}, {"ConservativeAdvancement", "Impulse"},
    {"LocalRoot", "Impulse"},      {"None", "Rows"},
    {"Speculative", "Rows"},       {"Bisection", "Rows"},
    {"LocalBisection", "Rows"},    {"ConservativeAdvancement", "Rows"},
    {"LocalRoot", "Rows"},
};
inline std::string sensor(const std::string& between, const std::string& resolution, const std::string& against = "")
{
    const std::string others = against.empty() ? "" : "\" against=\"" + against;
    return "<component id=\"contact\" type=\"CDetection/ODE\" between=\"" + between + others + "\" resolution=\"Resolution/" + resolution +
           "\" response=\"Response/None\"/>";
}

inline std::vector<Event> events_of(const Scene& s, const char* kind)
{
    std::vector<Event> out;
    for (const Event& e : s.events)
        if (e.kind == kind) out.push_back(e);
    return out;
}
inline double energy(const Scene& s)
{
    const auto& host = s.simulation().world().host();
    double sum = 0;
    for (std::uint32_t b = 0; b < host.bodies.size(); ++b)
        if (host.bodies.dynamic(b)) sum += host.bodies.kinetic_energy(b) + 9.81 * host.bodies.mass[b] * host.bodies.position[b].z;
    return sum;
}

}  // namespace plab::test
