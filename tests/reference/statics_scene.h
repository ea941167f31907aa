/// Scenes of things that lie on one another, from blueprint text: contacts by rows (Response/Rows) and a manager.
#pragma once

#include <string>
#include <vector>

#include "support/ground.h"
#include "support/scene.h"
#include "support/text.h"

namespace plab::test
{

inline std::string box(const std::string& id, const Vec3& half, double mass, const Vec3& at, const std::string& more = "")
{
    return "<component id=\"" + id + ".shape\" type=\"Shape/Box\" half_extents=\"" + text(half) + "\"/><component id=\"" + id +
           "\" type=\"State/RigidBody\" shape=\"" + id + ".shape\" mass=\"" + text(mass) + "\" position=\"" + text(at) + "\" " + more +
           "/>";
}

inline std::string ball(const std::string& id, double radius, double mass, const Vec3& at, const std::string& more = "")
{
    return "<component id=\"" + id + ".shape\" type=\"Shape/Sphere\" radius=\"" + text(radius) + "\"/><component id=\"" + id +
           "\" type=\"State/RigidBody\" shape=\"" + id + ".shape\" mass=\"" + text(mass) + "\" position=\"" + text(at) + "\" " + more +
           "/>";
}

inline std::string gravity(const std::string& between, const Vec3& g = {0, 0, -9.81})
{
    return "<component id=\"weight\" type=\"Field/Gravity\" between=\"" + between + "\" acceleration=\"" + text(g) + "\"/>";
}

inline std::string contact(const std::string& between, const std::string& manager, double friction, double restitution = 0,
                           const std::string& resolution = "None")
{
    return "<component id=\"contact\" type=\"CDetection/ODE\" between=\"" + between + "\" resolution=\"Resolution/" + resolution +
           "\" response=\"Response/Rows\" response.manager=\"Manager/" + manager + "\" response.friction=\"" + text(friction) +
           "\" response.restitution=\"" + text(restitution) + "\"/>";
}

inline std::string name_of_box(std::size_t i) { return "b" + std::string(i < 10 ? "00" : i < 100 ? "0" : "") + std::to_string(i); }

/// What the contacts of a and b put on b in the last step, N, W: a manager's impulses over the step.
inline Vec3 force_between(const Scene& s, const std::string& a, const std::string& b)
{
    const world::World& world = s.simulation().world();
    Vec3 sum;
    for (const simulation::PairState& p : s.simulation().stepper().contacts().pairs())
    {
        const std::string &of_a = world.id_of(p.a), &of_b = world.id_of(p.b);
        const double sign = of_a == a && of_b == b ? 1 : of_b == a && of_a == b ? -1 : 0;
        for (std::uint32_t i = 0; i < p.count; ++i) sum += p.contacts[i].impulse * sign;
    }
    return sum / s.simulation().dt();
}

/// Impulses of a pair's points in the last step over its length, N, along the normal; in the order of features.
inline std::vector<double> point_forces(const Scene& s, const std::string& a, const std::string& b)
{
    const world::World& world = s.simulation().world();
    std::vector<double> out;
    for (const simulation::PairState& p : s.simulation().stepper().contacts().pairs())
    {
        const std::string &of_a = world.id_of(p.a), &of_b = world.id_of(p.b);
        if (!(of_a == a && of_b == b) && !(of_a == b && of_b == a)) continue;
        for (std::uint32_t i = 0; i < p.count; ++i) out.push_back(dot(p.contacts[i].impulse, p.normal) / s.simulation().dt());
    }
    return out;
}

}  // namespace plab::test
