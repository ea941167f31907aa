#include "import/joint_text.h"

namespace plab::import
{
namespace
{

void write_stops(const Joint& j, JointText& out, Ids& ids)
{
    if (!std::isfinite(j.lower) && !std::isfinite(j.upper)) return;
    out.lines.push_back(component(ids.make(out.id + ".limit"), "Constraint/Limit",
                                  out.place + bound("lower", j.lower - j.start) + bound("upper", j.upper - j.start) +
                                      attribute("manager", ids.prefix() + "manager")));
    out.needs_manager = true;
}

/// A motor that stands still and may slip is Coulomb's friction.
void write_friction(const Joint& j, JointText& out, Ids& ids)
{
    if (!(j.friction > 0)) return;
    out.lines.push_back(component(
        ids.make(out.id + ".friction"), "Constraint/Motor",
        out.place + attribute("speed", 0) + attribute("max_effort", j.friction) + attribute("manager", ids.prefix() + "manager")));
    out.needs_manager = true;
}

/// A shaft geared to the joint by 1 has the joint's speed relative to its base, so its energy is 1/2 armature q'^2, and nothing else of it
/// acts on the bodies: a shaft has no mass that gravity or accelerations of the base could act on.
void write_rotor(const PlacedJoint& placed, const std::string& a, const std::string& b, JointText& out, Ids& ids)
{
    if (!(placed.joint.armature > 0)) return;
    const std::string rotor = ids.make(out.id + ".rotor");
    out.lines.push_back(
        component(rotor, "State/Shaft",
                  attribute("position", placed.anchor_W) + attribute("axis", placed.axis_W) + attribute("inertia", placed.joint.armature)));
    const bool slides = placed.joint.kind == JointKind::Slide;
    out.lines.push_back(component(ids.make(out.id + ".armature"), slides ? "Constraint/Coupler" : "Constraint/Gear",
                                  attribute("driver", b) + attribute("driven", rotor) + (a.empty() ? "" : attribute("carrier", a)) +
                                      (slides ? " driver_along=\"slide\"" : "") + attribute("driver_axis", placed.axis_W)));
}

}  // namespace

JointText joint_text(const PlacedJoint& placed, const std::string& a, const std::string& b, Ids& ids)
{
    const Joint& j = placed.joint;
    JointText out;
    out.id = ids.make(j.name);
    const std::string anchor = (a.empty() ? "" : attribute("a", a)) + attribute("b", b) + attribute("anchor", placed.anchor_W);
    if (j.kind == JointKind::Ball) return out.lines.push_back(component(out.id, "Constraint/Ball", anchor)), out;
    const bool slides = j.kind == JointKind::Slide;
    const std::string on_axis = anchor + attribute("axis", placed.axis_W);
    out.place = on_axis + attribute("along", slides ? "slide" : "turn");
    out.lines.push_back(j.lead != 0 ? component(out.id, "Constraint/Screw", on_axis + attribute("lead", j.lead))
                                    : component(out.id, slides ? "Constraint/Slider" : "Constraint/Hinge", on_axis));
    write_stops(j, out, ids);
    if (j.stiffness > 0 || j.damping > 0)
        out.lines.push_back(component(
            ids.make(out.id + ".spring"), "Constraint/TorsionSpring",
            out.place + attribute("stiffness", j.stiffness) + attribute("damping", j.damping) + attribute("rest", j.rest - j.start)));
    write_friction(j, out, ids);
    write_rotor(placed, a, b, out, ids);
    return out;
}

std::string actuator_text(const Actuator& actuator, const std::string& place, double start, Ids& ids)
{
    const Vec3 bias{actuator.bias.x + actuator.bias.y * actuator.gear * start, actuator.bias.y, actuator.bias.z};
    std::string out = place;
    if (actuator.gear != 1) out += attribute("gear", actuator.gear);
    if (actuator.gain != 1) out += attribute("gain", actuator.gain);
    if (!(bias == Vec3{})) out += attribute("bias", bias);
    out += bound("control_lower", actuator.control_lower) + bound("control_upper", actuator.control_upper);
    out += bound("force_lower", actuator.force_lower) + bound("force_upper", actuator.force_upper);
    return component(ids.make(actuator.name), "Constraint/Actuator", out);
}

}  // namespace plab::import
