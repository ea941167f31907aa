/// Scenes of stacked and supported bodies, from blueprint text: contacts by rows (Response/Rows) with a manager.
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

/// The force of each contact point of two bodies on the second body of the pair, N, W; in the order of features. For managers
/// and impulses: the mean over the last step.
struct PointForce
{
    Vec3 force, normal;
    bool on_first = false;  ///< the first of the two requested bodies: then the force is on `a`
};
inline std::vector<PointForce> forces_of(const Scene& s, const std::string& a, const std::string& b)
{
    const world::World& world = s.simulation().world();
    const auto& cache = s.simulation().stepper().contacts();
    std::vector<PointForce> out;
    const auto add = [&](const auto& p, auto force)
    {
        const std::string &of_a = world.id_of(p.a), &of_b = world.id_of(p.b);
        const bool straight = of_a == a && of_b == b, turned = of_b == a && of_a == b;
        for (std::uint32_t i = 0; (straight || turned) && i < p.count; ++i) out.push_back({force(p.contacts[i]), p.normal, turned});
    };
    for (const simulation::PairState& p : cache.pairs()) add(p, [&](const auto& c) { return c.impulse / s.simulation().dt(); });
    for (const simulation::ForcePair& p : cache.force_pairs()) add(p, [](const auto& c) { return c.force; });
    return out;
}

/// Total force of the contacts of a and b on b, N, W.
inline Vec3 force_between(const Scene& s, const std::string& a, const std::string& b)
{
    Vec3 sum;
    for (const PointForce& f : forces_of(s, a, b)) sum += f.on_first ? -f.force : f.force;
    return sum;
}

/// Normal forces at the points of a pair, N.
inline std::vector<double> point_forces(const Scene& s, const std::string& a, const std::string& b)
{
    std::vector<double> out;
    for (const PointForce& f : forces_of(s, a, b)) out.push_back(dot(f.force, f.normal));
    return out;
}

}  // namespace plab::test
