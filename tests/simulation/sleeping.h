/// Scenes whose islands may sleep, and what the tests of sleeping ask of them.
#pragma once

#include <string>
#include <vector>

#include "support/ground.h"
#include "support/scene.h"
#include "support/text.h"

namespace plab::test
{

inline std::string cube(const std::string& id, const Vec3& place, const std::string& more = "")
{
    return "<component id=\"" + id + "\" type=\"State/RigidBody\" shape=\"cube\" mass=\"1\" position=\"" + text(place) + "\" " + more +
           "/>";
}

inline std::string ball(const std::string& id, const Vec3& place, const std::string& more = "")
{
    return "<component id=\"" + id + "\" type=\"State/RigidBody\" shape=\"round\" mass=\"1\" position=\"" + text(place) + "\" " + more +
           "/>";
}

/// Cubes of 0.5 m on one another, "<name>0" lowest.
inline std::string stack(const std::string& name, double x, int high)
{
    std::string out;
    for (int k = 0; k < high; ++k) out += cube(name + std::to_string(k), {x, 0.01 * (k % 2), 0.2501 + 0.5002 * k});
    return out;
}

/// `bodies` on level ground under gravity; a contact with rows, solved by "manager".
inline std::string resting_scene(const std::string& bodies, const std::string& manager = "type=\"Manager/SoftStep\" sleep_after=\"0.5\"")
{
    return "<component id=\"g\" type=\"Field/Gravity\" between=\"*\"/>"
           "<component id=\"cube\" type=\"Shape/Box\" half_extents=\"0.25 0.25 0.25\"/>"
           "<component id=\"round\" type=\"Shape/Sphere\" radius=\"0.1\"/>" +
           std::string(kGround) + bodies + "<component id=\"manager\" " + manager +
           "/><component id=\"contact\" type=\"CDetection/ODE\" between=\"*\" resolution=\"Resolution/None\" response=\"Response/Rows\" "
           "response.manager=\"manager\" response.friction=\"0.6\"/>";
}

inline std::int64_t asleep(const Scene& s) { return std::get<std::int64_t>(s.get("manager", "asleep")); }

inline bool is_asleep(const Scene& s, const std::string& id)
{
    const world::World& world = s.simulation().world();
    return s.simulation().stepper().contacts().rest().asleep(world.component(world.find(id)).host_index);
}

struct Place
{
    Vec3 position;
    Quat orientation;
    friend bool operator==(const Place&, const Place&) = default;
};
inline Place place_of(const Scene& s, const std::string& id) { return {s.vec(id, "position"), s.quat(id, "orientation")}; }

inline std::vector<Place> places_of(const Scene& s, const std::vector<std::string>& ids)
{
    std::vector<Place> out;
    for (const std::string& id : ids) out.push_back(place_of(s, id));
    return out;
}

}  // namespace plab::test
