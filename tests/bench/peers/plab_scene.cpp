#include "bench/peers/plab_scene.h"

#include <map>

#include "support/text.h"

namespace plab::peers
{
namespace
{

using test::text;

std::string attribute(const char* name, const std::string& value) { return std::string(" ") + name + "=\"" + value + "\""; }

std::string id_of(char letter, std::size_t i)
{
    const std::string digits = std::to_string(i);
    return letter + std::string(digits.size() < 5 ? 5 - digits.size() : 0, '0') + digits;
}
std::string child_of(const Scene& scene, int joint)
{
    return body_id(static_cast<std::size_t>(scene.joints[static_cast<std::size_t>(joint)].child));
}
std::string axis_of(const Scene& scene, int joint) { return text(scene.joints[static_cast<std::size_t>(joint)].axis); }
/// As roles of a joint; without a, it is on the world.
std::string pair_of(const JointSpec& j)
{
    const std::string b = attribute("b", body_id(static_cast<std::size_t>(j.child)));
    return j.parent == kWorld ? b : attribute("a", body_id(static_cast<std::size_t>(j.parent))) + b;
}

/// A shape component per form and size, shared by all bodies that have it.
class Forms
{
public:
    std::string of(const BodySpec& body, std::string& out)
    {
        const std::string what = body.form == Form::Sphere ? "type=\"Shape/Sphere\" radius=\"" + text(body.half.x) + "\""
                                                           : "type=\"Shape/Box\" half_extents=\"" + text(body.half) + "\"";
        const auto [place, is_new] = ids_.try_emplace(what, id_of('s', ids_.size()));
        if (is_new) out += "<component id=\"" + place->second + "\" " + what + "/>\n";
        return place->second;
    }

private:
    std::map<std::string, std::string> ids_;
};

void add_bodies(const Scene& scene, std::string& out)
{
    Forms forms;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    {
        const BodySpec& b = scene.bodies[i];
        const std::string shape = b.form == Form::Point ? "" : attribute("shape", forms.of(b, out));
        const Quat& q = b.orientation;
        out += "<component id=\"" + body_id(i) + "\" type=\"State/RigidBody\"" + shape + attribute("mass", text(b.mass)) +
               attribute("inertia", text(b.inertia)) + attribute("position", text(b.position)) + attribute("orientation", text(q)) +
               attribute("linear_velocity", text(b.velocity)) + attribute("angular_velocity", text(b.angular_velocity)) + "/>\n";
    }
}

/// The normal of a half-space is +z of its frame.
void add_half_spaces(const Scene& scene, std::string& out)
{
    if (!scene.ground) return;
    out += "<component id=\"plane\" type=\"Shape/Plane\"/>\n<component id=\"ground\" type=\"State/Static\" shape=\"plane\"/>\n";
    if (scene.container <= 0) return;
    const std::string w = text(scene.container);
    const std::string sides[4][2] = {{"-" + w + " 0 0", "axis 0 1 0 90 deg"},
                                     {w + " 0 0", "axis 0 1 0 -90 deg"},
                                     {"0 -" + w + " 0", "axis 1 0 0 -90 deg"},
                                     {"0 " + w + " 0", "axis 1 0 0 90 deg"}};
    for (std::size_t i = 0; i < 4; ++i)
        out += "<component id=\"side" + std::to_string(i) + "\" type=\"State/Static\" shape=\"plane\" position=\"" + sides[i][0] +
               "\" orientation=\"" + sides[i][1] + "\"/>\n";
}

void add_contact(const Scene& scene, const Algorithm& algorithm, std::string& out)
{
    if (!scene.ground) return;
    out += "<component id=\"contact\" type=\"CDetection/ODE\" between=\"*\" " + algorithm.contact +
           "/>\n<component id=\"contact.response\" " + algorithm.response + attribute("friction", text(scene.friction)) +
           attribute("restitution", text(scene.restitution)) + "/>\n";
}

/// Two gears on their axles, without a world of bodies.
void add_shafts(const Scene& scene, std::string& out)
{
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        out += "<component id=\"" + body_id(i) + "\" type=\"State/Shaft\"" + attribute("inertia", text(scene.bodies[i].inertia.y)) +
               attribute("axis", "0 1 0") + attribute("position", text(scene.bodies[i].position)) + "/>\n";
    for (std::size_t i = 0; i < scene.loads.size(); ++i)
        out += "<component id=\"" + id_of('l', i) + "\" type=\"Field/Load\"" + attribute("between", child_of(scene, scene.loads[i].joint)) +
               attribute("shaft_torque", text(scene.loads[i].torque)) + "/>\n";
    for (const GearSpec& g : scene.gears)
        out += "<component id=\"gear\" type=\"Constraint/AngularVelocity/Graph\"" + attribute("driver", child_of(scene, g.first)) +
               attribute("driven", child_of(scene, g.second)) + attribute("velocity_factor", text(g.ratio)) + "/>\n";
}

const char* type_of(JointKind kind)
{
    switch (kind)
    {
        case JointKind::Hinge:
            return "Constraint/Hinge";
        case JointKind::Ball:
            return "Constraint/Ball";
        case JointKind::Slider:
            return "Constraint/Slider";
    }
    return "";
}

/// Between points that are far enough apart along the axis for the distance never to pass zero.
void add_spring(const Scene& scene, const JointSpec& j, const Algorithm& algorithm, std::string& out)
{
    constexpr double kAway = 1;  // m
    const Vec3 at_b = scene.bodies[static_cast<std::size_t>(j.child)].position;
    const Vec3 at_a = j.parent == kWorld ? at_b - j.axis * kAway : scene.bodies[static_cast<std::size_t>(j.parent)].position;
    out += "<component id=\"spring\" " + algorithm.spring + pair_of(j) + attribute("anchor_a", text(j.parent == kWorld ? at_a : Vec3{})) +
           attribute("anchor_b", text(Vec3{})) + attribute("stiffness", text(j.stiffness)) + attribute("damping", text(j.damping)) +
           attribute("length", text(length(at_b - at_a) + j.rest)) + "/>\n";
}

void add_joints(const Scene& scene, const Algorithm& algorithm, std::string& out)
{
    for (std::size_t i = 0; i < scene.joints.size(); ++i)
    {
        const JointSpec& j = scene.joints[i];
        if (j.stiffness > 0) add_spring(scene, j, algorithm, out);
        if (j.stiffness > 0 && j.parent != kWorld) continue;  // two free bodies: no force pushes them off their line
        const std::string place = attribute("anchor", text(j.anchor)) + (j.kind == JointKind::Ball ? "" : attribute("axis", text(j.axis)));
        out += "<component id=\"" + id_of('j', i) + "\" type=\"" + type_of(j.kind) + "\"" + pair_of(j) + place + "/>\n";
    }
    for (const GearSpec& g : scene.gears)
        out += "<component id=\"gear\" type=\"Constraint/Gear\"" + attribute("driver", child_of(scene, g.first)) +
               attribute("driven", child_of(scene, g.second)) + attribute("velocity_factor", text(g.ratio)) +
               attribute("driver_axis", axis_of(scene, g.first)) + attribute("driven_axis", axis_of(scene, g.second)) + "/>\n";
    for (std::size_t i = 0; i < scene.loads.size(); ++i)
    {
        const Vec3 torque = scene.joints[static_cast<std::size_t>(scene.loads[i].joint)].axis * scene.loads[i].torque;
        out += "<component id=\"" + id_of('l', i) + "\" type=\"Field/Load\"" + attribute("between", child_of(scene, scene.loads[i].joint)) +
               attribute("torque", text(torque)) + "/>\n";
    }
}

}  // namespace

std::string body_id(std::size_t i) { return id_of('b', i); }

std::string blueprint_text(const Scene& scene, const Algorithm& algorithm, const Step& step)
{
    std::string out = "<plab version=\"1\"><scene dt=\"" + step.text() + "\" solver=\"solver\"/>\n";
    out += "<component id=\"solver\" " + algorithm.solver + "/>\n" + algorithm.extra;
    if (length(scene.gravity) > 0)
        out += "<component id=\"gravity\" type=\"Field/Gravity\" between=\"*\"" + attribute("acceleration", text(scene.gravity)) + "/>\n";
    if (!scene.gears.empty() && algorithm.gears == Algorithm::Gears::Shafts)
        add_shafts(scene, out);
    else
    {
        add_bodies(scene, out);
        add_joints(scene, algorithm, out);
    }
    add_half_spaces(scene, out);
    add_contact(scene, algorithm, out);
    return out + "</plab>\n";
}

}  // namespace plab::peers
