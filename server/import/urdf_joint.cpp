#include "import/urdf_joint.h"

#include <algorithm>

namespace plab::import
{
namespace
{

/// Two slides and a turn: the plane is the one to which the axis is perpendicular.
std::vector<Joint> planar(const Joint& turn)
{
    const Vec3 x = any_perpendicular(turn.axis);
    std::vector<Joint> out(3, turn);
    out[0].name += ".x", out[0].axis = x, out[0].kind = JointKind::Slide;
    out[1].name += ".y", out[1].axis = cross(turn.axis, x), out[1].kind = JointKind::Slide;
    return out;
}

/// A joint begins at 0, or at its bound that is nearest to 0.
void read_limits(const XmlElement& e, const std::string& type, Joint& joint, Document& document)
{
    const XmlElement* const limit = find_child(e, "limit");
    const bool bounded = type == "revolute" || type == "prismatic";
    if (!limit)
    {
        if (bounded) document.error(e, "a joint of type " + type + " needs a <limit>");
        return;
    }
    if (!bounded) return document.list_all_but(*limit, {});
    document.list_all_but(*limit, {"lower", "upper"});
    joint.lower = document.number(*limit, "lower", 0), joint.upper = document.number(*limit, "upper", 0);
    if (joint.lower > joint.upper) return document.error(*limit, "lower must not be greater than upper");
    joint.start = std::clamp(0.0, joint.lower, joint.upper);
}

void read_dynamics(const XmlElement& e, Joint& joint, Document& document)
{
    const XmlElement* const dynamics = find_child(e, "dynamics");
    if (!dynamics) return;
    document.list_all_but(*dynamics, {"damping", "friction"});
    joint.damping = document.number(*dynamics, "damping", 0), joint.friction = document.number(*dynamics, "friction", 0);
    if (joint.damping < 0 || joint.friction < 0) document.error(*dynamics, "damping and friction must not be negative");
}

void read_mimic(const XmlElement& e, UrdfJoint& joint, Document& document)
{
    const XmlElement* const mimic = find_child(e, "mimic");
    if (!mimic) return;
    document.list_all_but(*mimic, {"joint", "multiplier", "offset"});
    joint.mimics = document.text(*mimic, "joint");
    joint.multiplier = document.number(*mimic, "multiplier", 1), joint.offset = document.number(*mimic, "offset", 0);
    if (joint.mimics.empty()) document.error(*mimic, "needs the name of a joint");
}

std::string link_of(const XmlElement& e, const char* role, Document& document)
{
    const XmlElement* const found = find_child(e, role);
    const std::string link = found ? document.text(*found, "link") : "";
    if (found) document.list_all_but(*found, {"link"});
    if (link.empty()) document.error(e, std::string("needs <") + role + " link=\"...\">");
    return link;
}

}  // namespace

std::optional<UrdfJoint> read_urdf_joint(const XmlElement& e, Document& document)
{
    UrdfJoint out;
    out.name = document.text(e, "name"), out.where = e.where;
    out.parent = link_of(e, "parent", document), out.child = link_of(e, "child", document);
    if (out.name.empty()) document.error(e, "needs a name");
    document.list_attributes(e, {"name", "type"});
    const std::string type = document.text(e, "type");
    if (type == "fixed" || type == "floating")
        document.list_children(e, {"origin", "parent", "child", "axis"});
    else
        document.list_children(e, {"origin", "parent", "child", "axis", "limit", "dynamics", "mimic"});
    document.list_repeated(e, {});
    if (out.name.empty() || out.parent.empty() || out.child.empty()) return {};
    if (type == "fixed") return out;
    if (type == "floating") return out.floating = true, out;
    if (type != "revolute" && type != "continuous" && type != "prismatic" && type != "planar")
        return document.error(e, "type must be one of fixed, revolute, continuous, prismatic, planar, floating, not '" + type + "'"),
               std::nullopt;
    Joint joint;
    joint.name = out.name, joint.where = e.where;
    joint.kind = type == "prismatic" ? JointKind::Slide : JointKind::Hinge;
    const XmlElement* const axis = find_child(e, "axis");
    if (axis) document.list_all_but(*axis, {"xyz"});
    joint.axis = axis ? document.direction(*axis, "xyz", {1, 0, 0}) : Vec3{1, 0, 0};
    read_limits(e, type, joint, document);
    read_dynamics(e, joint, document);
    read_mimic(e, out, document);
    out.joints = type == "planar" ? planar(joint) : std::vector{joint};
    return out;
}

}  // namespace plab::import
