/// Parts of blueprints for scenes with joints.
#pragma once

#include <string>

#include "support/scene.h"
#include "support/text.h"

namespace plab::test
{

inline std::string dt(int per_second) { return "dt='1/" + std::to_string(per_second) + "'"; }
inline std::string solver_is(const std::string& type) { return "<component id='solver' type='Solver/" + type + "'/>"; }
inline std::string gravity(const std::string& g = "0 0 -9.81")
{
    return "<component id='g' type='Field/Gravity' between='*' acceleration='" + g + "'/>";
}
inline std::string body(const std::string& id, const std::string& mass, const std::string& inertia, const std::string& position,
                        const std::string& more = "")
{
    return "<component id='" + id + "' type='State/RigidBody' mass='" + mass + "' inertia='" + inertia + "' position='" + position + "' " +
           more + "/>";
}
inline std::string body(const std::string& id, double mass, const Vec3& inertia, const Vec3& position, const std::string& more = "")
{
    return body(id, text(mass), text(inertia), text(position), more);
}
inline std::string joint(const std::string& id, const std::string& type, const std::string& a, const std::string& b,
                         const std::string& more)
{
    return "<component id='" + id + "' type='Constraint/" + type + "'" + (a.empty() ? "" : " a='" + a + "'") + " b='" + b + "' " + more +
           "/>";
}

}  // namespace plab::test
