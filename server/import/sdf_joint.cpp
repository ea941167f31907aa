#include "import/sdf_joint.h"

#include <algorithm>
#include <cmath>

#include "import/sdf_text.h"

namespace plab::import
{
namespace
{

class JointReader
{
public:
    JointReader(const std::string& scope, double version, SdfFrames& frames, Document& document)
        : scope_(scope), version_(version), frames_(frames), document_(document)
    {
    }

    std::optional<SdfJoint> read(const XmlElement& e, const std::string& full)
    {
        SdfJoint out;
        out.full = full, out.scope = scope_, out.where = e.where;
        document_.list_attributes(e, {"name", "type"});
        const auto parent = link(e, "parent"), child = link(e, "child");
        if (!parent || !child) return {};
        out.parent = *parent, out.child = *child;
        if (out.child.empty()) return document_.error(e, "its child cannot be the world"), std::nullopt;
        if (out.parent == out.child) return document_.error(e, "joins a link to itself"), std::nullopt;
        X_WB_ = frames_.in_world(out.child), X_WJ_ = frames_.in_world(full);
        if (!read_kind(e, out)) return {};
        return out;
    }

private:
    /// The link to which the frame is attached that the child element names.
    std::optional<std::string> link(const XmlElement& e, const char* role)
    {
        const std::string name = sdf_text(e, role);
        if (name.empty()) return document_.error(e, std::string("needs a <") + role + ">"), std::nullopt;
        const auto frame = frames_.find(scope_, name, e.where, Document::title_of(e));
        return frame ? frames_.link_of(*frame) : std::nullopt;
    }

    bool read_kind(const XmlElement& e, SdfJoint& out)
    {
        const std::string type = document_.text(e, "type");
        if (type == "fixed") return document_.list_children(e, {"pose", "parent", "child", "axis"}), true;
        Joint joint;
        joint.name = out.full, joint.where = e.where;
        joint.anchor = (inverse(X_WB_) * X_WJ_).p;
        if (type == "ball")
        {
            document_.list_children(e, {"pose", "parent", "child"});
            joint.kind = JointKind::Ball;
            return out.joints.push_back(joint), true;
        }
        const bool two = type == "universal" || type == "revolute2";
        const bool known = two || type == "revolute" || type == "continuous" || type == "prismatic";
        if (!known && type != "screw" && type != "gearbox")
            return document_.error(e, "type must be one of revolute, continuous, prismatic, ball, universal, fixed, not '" + type + "'"),
                   false;
        if (type == "screw") joint.lead = read_lead(e);
        if (type == "gearbox") document_.lost(e, "turns freely: the ratio of a gearbox is not carried over");
        using Names = std::initializer_list<std::string_view>;
        document_.list_children(e, two               ? Names{"pose", "parent", "child", "axis", "axis2"}
                                   : type == "screw" ? Names{"pose", "parent", "child", "axis", "screw_thread_pitch", "thread_pitch"}
                                                     : Names{"pose", "parent", "child", "axis"});
        joint.kind = type == "prismatic" ? JointKind::Slide : JointKind::Hinge;
        for (const char* const name : {"axis", "axis2"})
        {
            if (name == std::string("axis2") && !two) break;
            const XmlElement* const axis = find_child(e, name);
            if (!axis) return document_.error(e, std::string("needs an <") + name + ">"), false;
            Joint one = joint;
            if (name == std::string("axis2")) one.name += ".2";
            read_axis(*axis, type != "continuous", one);
            if (const XmlElement* const mimic = find_child(*axis, "mimic")) read_mimic(*mimic, one.name, out);
            out.joints.push_back(std::move(one));
        }
        return true;
    }

    /// m for a turn, 1 if nothing is said. Before SDF 1.10 the thread was given in rad/m, positive for one that is left-handed.
    double read_lead(const XmlElement& e)
    {
        constexpr double kTurn = 6.283185307179586;
        const double lead = sdf_number(e, "screw_thread_pitch", 1, document_), per_metre = sdf_number(e, "thread_pitch", 0, document_);
        const bool is_old = find_child(e, "thread_pitch") && !find_child(e, "screw_thread_pitch");
        if ((is_old ? per_metre : lead) == 0) document_.error(e, "the pitch of a screw must not be 0");
        return is_old ? -kTurn / per_metre : lead;
    }

    void read_axis(const XmlElement& e, bool bounded, Joint& joint)
    {
        document_.list_children(e, {"xyz", "limit", "dynamics", "use_parent_model_frame", "mimic"});
        const XmlElement* const xyz = find_child(e, "xyz");
        const Vec3 given = normalized(sdf_vector(e, "xyz", {0, 0, 1}, document_));
        if (given == Vec3{}) return document_.error(e, "xyz must be a direction, not the zero vector");
        std::string in = xyz ? document_.text(*xyz, "expressed_in") : "";
        if (sdf_truth(e, "use_parent_model_frame", version_ < 1.5, document_)) in = "__model__";
        Quat q = X_WJ_.q;
        if (!in.empty())
            if (const auto frame = frames_.find(scope_, in, e.where, Document::title_of(e))) q = frames_.in_world(*frame).q;
        joint.axis = normalized(rotate_back(X_WB_.q, rotate(q, given)));
        if (const XmlElement* const dynamics = find_child(e, "dynamics")) read_dynamics(*dynamics, joint);
        if (const XmlElement* const limit = find_child(e, "limit")) read_limit(*limit, bounded, joint);
    }

    void read_mimic(const XmlElement& e, const std::string& follower, SdfJoint& out)
    {
        document_.list_attributes(e, {"joint", "axis"});
        document_.list_children(e, {"multiplier", "offset", "reference"});
        const std::string leader = document_.text(e, "joint");
        if (leader.empty()) return document_.error(e, "needs the name of a joint");
        out.mimics.push_back({SdfFrames::full_name(scope_, leader) + (document_.text(e, "axis") == "axis2" ? ".2" : ""), follower,
                              sdf_number(e, "multiplier", 1, document_), sdf_number(e, "offset", 0, document_),
                              sdf_number(e, "reference", 0, document_), e.where});
    }

    void read_dynamics(const XmlElement& e, Joint& joint)
    {
        document_.list_children(e, {"damping", "friction", "spring_reference", "spring_stiffness"});
        joint.damping = sdf_number(e, "damping", 0, document_), joint.friction = sdf_number(e, "friction", 0, document_);
        joint.stiffness = sdf_number(e, "spring_stiffness", 0, document_), joint.rest = sdf_number(e, "spring_reference", 0, document_);
        if (joint.damping < 0 || joint.friction < 0 || joint.stiffness < 0)
            document_.error(e, "damping, friction and spring_stiffness must not be negative");
    }

    /// Bounds of 1e16 are the format's way to write that there are none. A joint begins at 0, or at its bound that is nearest to 0.
    void read_limit(const XmlElement& e, bool bounded, Joint& joint)
    {
        constexpr double kNone = 1e15;
        const double lower = sdf_number(e, "lower", -kInfinity, document_), upper = sdf_number(e, "upper", kInfinity, document_);
        for (const char* const name : {"effort", "velocity"})
            if (const double most = sdf_number(e, name, kInfinity, document_); most >= 0 && most < kNone)
                document_.lost(*find_child(e, name), "is not carried over");
        document_.list_children(e, {"lower", "upper", "effort", "velocity"});
        if (!bounded) return;
        if (lower > upper) return document_.error(e, "lower must not be greater than upper");
        if (lower > -kNone) joint.lower = lower;
        if (upper < kNone) joint.upper = upper;
        joint.start = std::clamp(0.0, joint.lower, joint.upper);
    }

    const std::string& scope_;
    double version_;
    SdfFrames& frames_;
    Document& document_;
    Pose X_WB_, X_WJ_;  ///< of the child, of the joint
};

}  // namespace

std::optional<SdfJoint> read_sdf_joint(const XmlElement& e, const std::string& scope, const std::string& full, double version,
                                       SdfFrames& frames, Document& document)
{
    return JointReader(scope, version, frames, document).read(e, full);
}

}  // namespace plab::import
