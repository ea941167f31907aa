/// Pieces of blueprints, and contacts with each response.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "support/text.h"

namespace plab::stability
{

inline constexpr double kG = 9.81;  // m/s^2

using test::text;

/// For headings.
inline std::string brief(double x)
{
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%.3g", x);
    return buffer;
}
inline std::string dt(double h) { return "dt=\"" + text(h) + "\""; }

inline std::string component(const std::string& id, const std::string& type, const std::string& more = "")
{
    return "<component id=\"" + id + "\" type=\"" + type + "\" " + more + "/>";
}
inline std::string attribute(const std::string& name, const std::string& value) { return " " + name + "=\"" + value + "\""; }
inline std::string attribute(const std::string& name, double value) { return attribute(name, text(value)); }
inline std::string attribute(const std::string& name, const Vec3& value) { return attribute(name, text(value)); }

inline std::string body(const std::string& id, double mass, const Vec3& inertia, const Vec3& at, const std::string& more = "")
{
    return component(id, "State/RigidBody",
                     attribute("mass", mass) + attribute("inertia", inertia) + attribute("position", at) + " " + more);
}
inline std::string ball(const std::string& id, double radius, double mass, const Vec3& at, const std::string& more = "")
{
    return component(id + ".shape", "Shape/Sphere", attribute("radius", radius)) +
           component(id, "State/RigidBody",
                     attribute("shape", id + ".shape") + attribute("mass", mass) + attribute("position", at) + " " + more);
}
inline std::string box(const std::string& id, const Vec3& half, double mass, const Vec3& at, const std::string& more = "")
{
    return component(id + ".shape", "Shape/Box", attribute("half_extents", half)) +
           component(id, "State/RigidBody",
                     attribute("shape", id + ".shape") + attribute("mass", mass) + attribute("position", at) + " " + more);
}
inline std::string ground()
{
    return component("ground.shape", "Shape/Plane") + component("ground", "State/Static", attribute("shape", "ground.shape"));
}
inline std::string gravity(double g = kG)
{
    return component("weight", "Field/Gravity", attribute("between", "*") + attribute("acceleration", Vec3{0, 0, -g}));
}

/// A response to contacts.
struct ContactAlgorithm
{
    std::string name, response, resolution, manager;
    bool spring() const { return response == "Penalty" || response == "HuntCrossley"; }
};

/// Each response with the resolution that suits it, rows with each manager.
inline const std::vector<ContactAlgorithm>& contact_algorithms()
{
    static const std::vector<ContactAlgorithm> algorithms{
        {"Penalty", "Penalty", "", ""},
        {"HuntCrossley", "HuntCrossley", "", ""},
        {"Impulse, LocalRoot", "Impulse", "LocalRoot", ""},
        {"Rows, Direct", "Rows", "None", "Direct"},
        {"Rows, SequentialImpulse", "Rows", "None", "SequentialImpulse"},
        {"Rows, SoftStep", "Rows", "None", "SoftStep"},
    };
    return algorithms;
}

inline std::vector<std::string> names_of(const std::vector<ContactAlgorithm>& algorithms)
{
    std::vector<std::string> out;
    for (const ContactAlgorithm& r : algorithms) out.push_back(r.name);
    return out;
}

/// `response_more`: further attributes, as response.friction="..".
inline std::string contact(const ContactAlgorithm& algorithm, const std::string& response_more = "")
{
    return component("contact", "CDetection/ODE",
                     attribute("between", "*") + attribute("response", "Response/" + algorithm.response) +
                         (algorithm.resolution.empty() ? "" : attribute("resolution", "Resolution/" + algorithm.resolution)) +
                         (algorithm.manager.empty() ? "" : attribute("response.manager", "Manager/" + algorithm.manager)) + " " +
                         response_more);
}

inline std::string solver(const std::string& name) { return component("solver", "Solver/" + name); }

inline std::vector<std::string> brief(const std::vector<double>& values)
{
    std::vector<std::string> out;
    for (const double v : values) out.push_back(brief(v));
    return out;
}

}  // namespace plab::stability
