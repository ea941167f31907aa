#include "import/mjcf.h"

#include <algorithm>
#include <iterator>
#include <set>

#include "import/mjcf_actuator.h"
#include "import/mjcf_cable.h"
#include "import/mjcf_geom.h"
#include "import/mjcf_include.h"
#include "import/mjcf_settings.h"
#include "import/mjcf_tendon.h"
#include "objects/shapes/volume_integration.h"

namespace plab::import
{
namespace
{

class MjcfReader
{
public:
    MjcfReader(const XmlElement& root, bool fixed_base, Document& document)
        : root_(root), fixed_base_(fixed_base), document_(document), settings_(root, document)
    {
    }

    Robot read()
    {
        document_.list_attributes(root_, {"model"});
        document_.list_children(root_,
                                {"compiler", "option", "default", "asset", "worldbody", "contact", "equality", "tendon", "actuator"});
        robot_.title = document_.text(root_, "model");
        robot_.step = settings_.step(), robot_.gravity = settings_.gravity(), robot_.base_collides = robot_.fixed_parents_collide = true;
        robot_.surface_rule = SurfaceRule::MuJoCo, robot_.fixed_meshes_are_surfaces = false;
        bool world = false;
        for (const XmlElement& e : root_.children)
        {
            if (e.name == "worldbody") read_body(e, kWorld, ""), world = true;
            if (e.name == "actuator") read_actuators(e, settings_, robot_.actuators, document_);
        }
        if (!world) document_.error(root_, "has no <worldbody>");
        set_total_mass();
        for (const XmlElement& e : root_.children)
            if (e.name == "equality")
                for (const XmlElement& child : e.children) read_equality(child);
            else if (e.name == "contact")
                for (const XmlElement& child : e.children) read_contact(child);
        std::vector<FixedTendon> tendons;
        for (const XmlElement& e : root_.children)
            if (e.name == "tendon") std::ranges::move(read_tendons(e, document_), std::back_inserter(tendons)), read_cables(e);
        put_on_joints(robot_, tendons, document_);
        sites_.list_unused(document_);
        return std::move(robot_);
    }

private:
    static constexpr std::size_t kMostBodies = 100'000;

    std::string name_of(const XmlElement& e, const std::string& otherwise) const
    {
        const std::string name = document_.text(e, "name");
        return name.empty() ? otherwise : name;
    }

    // ---- bodies

    /// <worldbody>, or <body> with everything in it.
    void read_body(const XmlElement& e, std::size_t parent, const std::string& inherited)
    {
        const bool world = e.name == "worldbody";
        const std::size_t index = robot_.bodies.size();
        if (index >= kMostBodies) return document_.error(e, "is one body too many: 100,000 are allowed");
        RobotBody body;
        body.name = world ? "world" : name_of(e, "body." + std::to_string(index)), body.where = e.where, body.parent = parent;
        if (!body_names_.insert(body.name).second) document_.error(e, "there are two bodies of this name");
        std::string childclass = document_.text(e, "childclass");
        if (childclass.empty()) childclass = inherited;
        document_.list_attributes(e, {"name", "pos", "quat", "axisangle", "euler", "xyaxes", "zaxis", "childclass", "gravcomp"});
        read_gravity(e, body);
        document_.list_children(e, {"inertial", "joint", "freejoint", "geom", "site", "body"});
        document_.list_repeated(e, {"joint", "freejoint", "geom", "site", "body"});
        body.pose = settings_.pose(e);
        read_joints(e, childclass, body);
        read_mass_and_shapes(e, childclass, body);
        for (const XmlElement& child : e.children)
            if (child.name == "site") sites_.read(child, childclass, body.name, settings_, document_);
        robot_.bodies.push_back(std::move(body));
        for (const XmlElement& child : e.children)
            if (child.name == "body") read_body(child, index, childclass);
    }

    /// gravcomp: the share of gravity that does not act.
    void read_gravity(const XmlElement& e, RobotBody& body)
    {
        const double share = document_.number(e, "gravcomp", 0);
        body.weightless = share == 1;
        if (share != 0 && share != 1) document_.lost(e, "gravcomp is carried over only if it is 1: gravity acts");
    }

    void set_total_mass()
    {
        double sum = 0;
        for (const RobotBody& body : robot_.bodies) sum += body.mass.mass;
        const double factor = settings_.total_mass() / sum;
        if (!(sum > 0 && settings_.total_mass() > 0)) return;
        for (RobotBody& body : robot_.bodies) body.mass.mass *= factor, body.mass.inertia = body.mass.inertia * factor;
    }

    void read_joints(const XmlElement& e, const std::string& childclass, RobotBody& body)
    {
        for (const XmlElement& child : e.children)
        {
            const bool free = child.name == "freejoint" || (child.name == "joint" && document_.text(child, "type") == "free");
            if (child.name != "joint" && !free) continue;
            if (e.name == "worldbody") return document_.error(child, "the world cannot move");
            if (!free)
                read_joint(child, childclass, body);
            else
            {
                list_free_joint(child, childclass);
                if (body.parent != 0) document_.error(child, "a body that moves freely must be a child of <worldbody>");
                body.free = !fixed_base_;
                if (fixed_base_) document_.lost(child, "does not move: --fixed-base");
            }
        }
        if (body.free && !body.joints.empty()) document_.error(e, "has other joints beside a free one");
    }

    /// What acts on a free joint of MuJoCo, and is not zero. Its pose and its range count for nothing there either.
    void list_free_joint(const XmlElement& own, const std::string& childclass)
    {
        document_.list_attributes(own, {"name", "type", "class", "pos", "align", "limited", "range", "margin", "group", "armature",
                                        "damping", "stiffness", "frictionloss"});
        const XmlElement e = own.name == "joint" ? settings_.resolved(own, childclass) : own;
        for (const char* const name : {"armature", "damping", "stiffness", "frictionloss"})
            if (document_.number(e, name, 0) != 0)
                document_.lost(own, std::string(name) + "='" + document_.text(e, name) + "' of a free joint is not carried over");
    }

    void read_joint(const XmlElement& own, const std::string& childclass, RobotBody& body)
    {
        list_unused_attributes(own, document_);
        const XmlElement e = settings_.resolved(own, childclass);
        const std::string type = document_.text(e, "type");
        if (!type.empty() && type != "hinge" && type != "slide" && type != "ball")
            return document_.error(e, "type must be one of free, ball, slide, hinge, not '" + type + "'");
        Joint joint;
        joint.name = name_of(e, body.name + ".joint" + (body.joints.empty() ? "" : "." + std::to_string(body.joints.size())));
        joint.where = e.where;
        joint.kind = type == "ball" ? JointKind::Ball : type == "slide" ? JointKind::Slide : JointKind::Hinge;
        joint.anchor = document_.vector(e, "pos", {});
        joint.axis = document_.direction(e, "axis", {0, 0, 1});
        const auto unit = [&](double x) { return joint.kind == JointKind::Hinge ? settings_.angle(x) : x; };
        joint.zero = joint.start = unit(document_.number(e, "ref", 0));
        joint.rest = unit(document_.number(e, "springref", 0));
        joint.stiffness = document_.number(e, "stiffness", 0), joint.damping = document_.number(e, "damping", 0);
        joint.friction = document_.number(e, "frictionloss", 0), joint.armature = document_.number(e, "armature", 0);
        if (joint.stiffness < 0 || joint.damping < 0 || joint.friction < 0 || joint.armature < 0)
            document_.error(e, "stiffness, damping, frictionloss and armature must not be negative");
        if (!joint_names_.insert(joint.name).second) document_.error(e, "there are two joints of this name");
        read_range(e, unit, joint);
        if (joint.kind == JointKind::Ball && (joint.stiffness > 0 || joint.damping > 0 || joint.friction > 0))
            document_.lost(e, "stiffness, damping and friction of a ball joint are not carried over");
        body.joints.push_back(std::move(joint));
    }

    template <class Unit>
    void read_range(const XmlElement& e, Unit unit, Joint& joint)
    {
        double range[2] = {0, 0};
        const bool given = document_.numbers(e, "range", range, 2) == 2;
        const std::string limited = document_.text(e, "limited");
        if (limited == "false" || (limited != "true" && !(given && settings_.auto_limits()))) return;
        if (!given) return document_.error(e, "is limited, but has no range");
        if (joint.kind == JointKind::Ball) return document_.lost(e, "the range of a ball joint is not carried over");
        if (!(range[0] < range[1])) return document_.error(e, "range must be two ascending numbers");
        joint.lower = unit(range[0]), joint.upper = unit(range[1]);
        joint.start = std::clamp(joint.zero, joint.lower, joint.upper);
        if (joint.start != joint.zero)
            document_.lost(
                e, "the pose of the file is outside its range: it begins at the nearest bound, as a stop of pLab would throw it there");
    }

    void read_mass_and_shapes(const XmlElement& e, const std::string& childclass, RobotBody& body)
    {
        const XmlElement* const inertial = find_child(e, "inertial");
        const bool from_shapes = settings_.inertia_from_shapes() || (!inertial && !settings_.inertia_never_from_shapes());
        std::vector<MassProperties> parts;
        for (const XmlElement& child : e.children)
        {
            if (child.name != "geom") continue;
            list_unused_attributes(child, document_);
            auto geom = read_geom(settings_.resolved(child, childclass), from_shapes && e.name == "body", settings_, document_);
            if (!geom) continue;
            if (geom->mass.mass > 0) parts.push_back(geom->mass);
            geom->shape.collides = geom->shape.collides && settings_.collisions();
            body.shapes.push_back(std::move(geom->shape));
        }
        if (e.name == "worldbody") return;
        if (from_shapes && !parts.empty()) body.mass = shapes::joined(parts);
        if (inertial && from_shapes) document_.lost(*inertial, "is not used: inertiafromgeom=\"true\"");
        if (inertial && !from_shapes) body.mass = read_inertial(*inertial, body.name);
    }

    MassProperties read_inertial(const XmlElement& e, const std::string& body)
    {
        document_.list_attributes(e, {"pos", "quat", "axisangle", "euler", "xyaxes", "zaxis", "mass", "diaginertia", "fullinertia"});
        double v[6];
        Mat3 local;
        if (document_.numbers(e, "diaginertia", std::span(v, 3), 3) == 3) local = Mat3::diagonal(v[0], v[1], v[2]);
        if (document_.numbers(e, "fullinertia", v, 6) == 6)
        {
            if (settings_.turned(e)) document_.error(e, "fullinertia excludes an orientation");
            local = {{{v[0], v[3], v[4]}, {v[3], v[1], v[5]}, {v[4], v[5], v[2]}}};
        }
        if (!e.find_attribute("diaginertia") && !e.find_attribute("fullinertia")) document_.error(e, "needs diaginertia or fullinertia");
        const Pose X = settings_.pose(e);
        const Mat3 R = rotation_matrix(X.q);
        const double mass = document_.positive(e, "mass");
        if (!document_.failed()) document_.check_mass(e.where, "<inertial> of body '" + body + "'", mass, local);
        return {mass, X.p, R * local * transposed(R)};
    }

    // ---- between bodies

    void read_equality(const XmlElement& e)
    {
        Coupling c;
        c.where = e.where;
        c.name = name_of(e, "equality." + std::to_string(robot_.couplings.size()));
        if (document_.text(e, "active") == "false") return document_.lost(e, "is not active, and not carried over");
        if (e.name == "connect" || e.name == "weld")
        {
            const bool point = e.name == "connect";
            document_.list_attributes(e, {"name", "active", "body1", "body2", point ? "anchor" : "body1"});
            if (!e.find_attribute("body1") || (point && !e.find_attribute("anchor")))
                return document_.lost(e, "is not carried over: only body1, body2 and anchor are read");
            c.kind = point ? CouplingKind::Point : CouplingKind::Weld;
            c.first = document_.text(e, "body1"), c.second = document_.text(e, "body2");
            c.anchor = document_.vector(e, "anchor", {});
            robot_.couplings.push_back(std::move(c));
        }
        else if (e.name == "joint")
            read_equal_joints(e, std::move(c));
        else
            document_.lost(e, "is not carried over");
    }

    /// q1 = ref1 + c0 + c1 (q2 - ref2) + ...
    void read_equal_joints(const XmlElement& e, Coupling c)
    {
        document_.list_attributes(e, {"name", "active", "joint1", "joint2", "polycoef"});
        double coefficients[5] = {0, 1, 0, 0, 0};
        document_.numbers(e, "polycoef", coefficients, 1);
        c.second = document_.text(e, "joint1"), c.first = document_.text(e, "joint2"), c.factor = coefficients[1];
        const bool linear = coefficients[0] == 0 && coefficients[2] == 0 && coefficients[3] == 0 && coefficients[4] == 0;
        if (c.first.empty() || c.second.empty() || !linear)
            return document_.lost(e, "is not carried over: only two joints at a ratio are (polycoef=\"0 RATIO 0 0 0\")");
        robot_.couplings.push_back(std::move(c));
    }

    void read_cables(const XmlElement& section)
    {
        for (const XmlElement& e : section.children)
            if (e.name == "spatial")
            {
                auto cable = read_cable(e, sites_, settings_, document_);
                const bool is_named = e.find_attribute("name") != nullptr;
                if (cable && is_named && std::ranges::find(robot_.cables, cable->name, &Cable::name) != robot_.cables.end())
                    document_.error(e, "there are two tendons of this name");
                if (cable) robot_.cables.push_back(std::move(*cable));
            }
            else if (e.name != "fixed")
                document_.lost(e, "is not carried over");
    }

    void read_contact(const XmlElement& e)
    {
        const bool exclude = e.name == "exclude";
        if (!exclude && e.name != "pair") return document_.lost(e, "is not carried over");
        const char *const first = exclude ? "body1" : "geom1", *const second = exclude ? "body2" : "geom2";
        document_.list_attributes(e, {"name", "class", first, second, exclude ? first : "friction"});
        if (!e.find_attribute(first) || !e.find_attribute(second))
            return document_.error(e, std::string("needs ") + first + " and " + second);
        if (exclude)
            robot_.exclusions.push_back({document_.text(e, first), document_.text(e, second), e.where});
        else if (settings_.collisions())
            read_pair(e);
    }

    void read_pair(const XmlElement& e)
    {
        CollidingPair pair{document_.text(e, "geom1"), document_.text(e, "geom2"), {}, e.where};
        double friction[5] = {1, 1, 0, 0, 0};
        const std::size_t given = document_.numbers(e, "friction", friction, 1);
        if (friction[0] < 0) document_.error(e, "friction must not be negative");
        if (given > 0) pair.friction = friction[0];
        if (given > 2 || (given > 1 && friction[1] != friction[0]))
            document_.lost(e, "friction: only the first number is carried over, that of sliding");
        robot_.pairs.push_back(std::move(pair));
    }

    const XmlElement& root_;
    bool fixed_base_;
    Document& document_;
    MjcfSettings settings_;
    Robot robot_;
    Sites sites_;
    std::set<std::string> body_names_, joint_names_;
};

}  // namespace

Robot read_mjcf(XmlElement root, bool fixed_base, Document& document)
{
    put_together(root, document);
    return MjcfReader(root, fixed_base, document).read();
}

}  // namespace plab::import
