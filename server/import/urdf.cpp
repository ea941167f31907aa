#include "import/urdf.h"

#include <algorithm>
#include <map>
#include <numbers>

#include "import/link_shapes.h"
#include "import/mesh_file.h"
#include "import/sdf_text.h"
#include "import/urdf_joint.h"

namespace plab::import
{
namespace
{

/// URDF's angles are about the fixed axes x, y, z, in this order.
Pose read_origin(const XmlElement& parent, Document& document)
{
    const XmlElement* const origin = find_child(parent, "origin");
    if (!origin) return {};
    document.list_all_but(*origin, {"xyz", "rpy"});
    const Vec3 rpy = document.vector(*origin, "rpy", {});
    const Quat q = rotation_about({0, 0, 1}, rpy.z) * rotation_about({0, 1, 0}, rpy.y) * rotation_about({1, 0, 0}, rpy.x);
    return {document.vector(*origin, "xyz", {}), normalized(q)};
}

class UrdfReader
{
public:
    UrdfReader(const XmlElement& root, bool fixed_base, bool self_collide, Document& document)
        : root_(root), fixed_base_(fixed_base), self_collide_(self_collide), document_(document)
    {
    }

    Robot read()
    {
        if (refuse_macros(root_)) return {};
        document_.list_attributes(root_, {"name", "version", "xmlns:xacro"});
        document_.list_children(root_, {"link", "joint", "material", "gazebo"});
        robot_.title = document_.text(root_, "name");
        for (const XmlElement& e : root_.children)
        {
            if (e.name == "material") read_material(e);
        }
        for (const XmlElement& e : root_.children)
            if (e.name == "link") read_link(e);
        for (const XmlElement& e : root_.children)
            if (e.name == "gazebo") read_gazebo(e);
        for (const XmlElement& e : root_.children)
            if (e.name == "joint") read_joint(e);
        if (links_.empty()) document_.error(root_, "has no <link>");
        if (!document_.failed()) order();
        if (!document_.failed()) start_mimics();
        return std::move(robot_);
    }

private:
    struct Link
    {
        RobotBody body;
        bool inertial = false;
        const UrdfJoint* joint = nullptr;  ///< to its parent
        std::vector<std::string> children;
        bool placed = false;
    };

    /// The first thing that only xacro understands, as an error: without it, the robot would be another one.
    bool refuse_macros(const XmlElement& e)
    {
        constexpr const char* kExpand = ": expand the file with xacro first";
        if (e.name.starts_with("xacro:")) return document_.error(e, std::string("is a macro") + kExpand), true;
        for (const auto& a : e.attributes)
            if (a.value.find("${") != std::string::npos || a.value.find("$(") != std::string::npos)
                return document_.error(e, a.name + "=\"" + a.value.substr(0, 60) + "\" is for xacro" + kExpand), true;
        return std::ranges::any_of(e.children, [&](const XmlElement& child) { return refuse_macros(child); });
    }

    /// A material's colour; a definition inside a link holds for the whole file.
    std::optional<Vec3> read_material(const XmlElement& e)
    {
        const std::string name = document_.text(e, "name");
        document_.list_attributes(e, {"name"});
        document_.list_children(e, {"color"});
        document_.list_repeated(e, {});
        if (const XmlElement* const color = find_child(e, "color"))
        {
            document_.list_all_but(*color, {"rgba"});
            double c[4] = {1, 1, 1, 1};
            if (document_.numbers(*color, "rgba", c, 4) == 4)
            {
                if (c[3] != 1) document_.lost(*color, "is opaque in pLab");
                const auto within = [](double x) { return std::fmin(1, std::fmax(0, x)); };
                return materials_[name] = Vec3{within(c[0]), within(c[1]), within(c[2])};
            }
        }
        const auto found = materials_.find(name);
        return found == materials_.end() ? std::nullopt : std::optional(found->second);
    }

    void read_link(const XmlElement& e)
    {
        const std::string name = document_.text(e, "name");
        if (name.empty()) return document_.error(e, "needs a name");
        document_.list_attributes(e, {"name"});
        document_.list_children(e, {"inertial", "visual", "collision", "contact"});
        document_.list_repeated(e, {"visual", "collision"});
        Link link;
        link.body.name = name, link.body.where = e.where, link.body.self_collide = self_collide_;
        if (const XmlElement* const inertial = find_child(e, "inertial"))
            link.inertial = true, link.body.mass = read_inertial(*inertial, name);
        const Surface surface = read_surface(e);
        std::vector<RobotShape> seen, felt;
        for (const XmlElement& child : e.children)
            if (child.name == "visual" || child.name == "collision")
                if (auto shape = read_shape(child, surface)) (child.name == "visual" ? seen : felt).push_back(std::move(*shape));
        link.body.shapes = joined_shapes(std::move(seen), std::move(felt), name, document_);
        if (!links_.emplace(name, std::move(link)).second) return document_.error(e, "there are two links of this name");
        names_.push_back(name);
    }

    /// Gazebo's own extension, of a link or of the whole robot.
    void read_gazebo(const XmlElement& e)
    {
        const std::string reference = document_.text(e, "reference");
        const auto link = links_.find(reference);
        const XmlElement* given = find_child(e, "selfCollide");
        if (!given) given = find_child(e, "self_collide");
        const XmlElement* const mu = find_child(e, "mu1");
        if ((!given && !mu) || (!reference.empty() && link == links_.end())) return document_.lost(e, "is not carried over");
        document_.list_attributes(e, {"reference"});
        document_.list_children(e, {"selfCollide", "self_collide", "mu1", "mu2"});
        const bool collide = given && sdf_truth(e, given->name, false, document_);
        const double friction = sdf_number(e, "mu1", 1, document_);
        if (!(friction >= 0)) document_.error(e, "mu1 must not be negative");
        if (const XmlElement* const other = find_child(e, "mu2"); other && sdf_number(e, "mu2", friction, document_) != friction)
            document_.lost(*other, "is not carried over: friction is the same in all directions");
        for (auto& [name, one] : links_)
        {
            if (!reference.empty() && name != reference) continue;
            one.body.self_collide = one.body.self_collide || collide;
            for (RobotShape& s : one.body.shapes)
                if (mu) s.surface.friction = std::fmin(friction, 1e6);
        }
    }

    MassProperties read_inertial(const XmlElement& e, const std::string& link)
    {
        document_.list_attributes(e, {});
        document_.list_children(e, {"origin", "mass", "inertia"});
        document_.list_repeated(e, {});
        const XmlElement* const mass = find_child(e, "mass");
        const XmlElement* const inertia = find_child(e, "inertia");
        if (!mass || !inertia) return document_.error(e, "needs <mass> and <inertia>"), MassProperties{};
        document_.list_all_but(*mass, {"value"});
        document_.list_all_but(*inertia, {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"});
        MassProperties out;
        out.mass = document_.number(*mass, "value", 0);
        const auto value = [&](const char* name) { return document_.number(*inertia, name, 0); };
        const double xx = value("ixx"), xy = value("ixy"), xz = value("ixz"), yy = value("iyy"), yz = value("iyz"), zz = value("izz");
        const Mat3 local{{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}}};
        const Pose X = read_origin(e, document_);
        out.center = X.p;
        const Mat3 R = rotation_matrix(X.q);
        out.inertia = R * local * transposed(R);
        if (!document_.failed()) document_.check_mass(e.where, "<inertial> of link '" + link + "'", out.mass, local);
        return out;
    }

    /// URDF has no contact parameters; <contact> is Bullet's extension.
    Surface read_surface(const XmlElement& link)
    {
        Surface out;
        const XmlElement* const contact = find_child(link, "contact");
        if (!contact) return out;
        document_.list_attributes(*contact, {});
        document_.list_children(*contact, {"lateral_friction", "restitution"});
        if (const XmlElement* const e = find_child(*contact, "lateral_friction"))
            document_.list_all_but(*e, {"value"}), out.friction = document_.number(*e, "value", 1);
        if (const XmlElement* const e = find_child(*contact, "restitution"))
            document_.list_all_but(*e, {"value"}), out.restitution = document_.number(*e, "value", 0);
        if (out.friction < 0 || !(out.restitution >= 0 && out.restitution <= 1))
            document_.error(*contact, "lateral_friction must not be negative, and restitution from 0 to 1");
        return out;
    }

    std::optional<RobotShape> read_shape(const XmlElement& e, const Surface& surface)
    {
        document_.list_attributes(e, {"name"});
        document_.list_children(e, {"origin", "geometry", "material"});
        document_.list_repeated(e, {});
        const XmlElement* const geometry = find_child(e, "geometry");
        if (!geometry || geometry->children.empty()) return document_.error(e, "needs a <geometry> with a shape in it"), std::nullopt;
        RobotShape shape;
        shape.where = e.where;
        shape.pose = read_origin(e, document_);
        shape.collides = e.name == "collision", shape.surface = surface;
        if (const XmlElement* const material = find_child(e, "material")) shape.color = read_material(*material);
        for (std::size_t i = 1; i < geometry->children.size(); ++i)
            document_.lost(geometry->children[i], "is not carried over: a geometry has one shape");
        return read_form(geometry->children.front(), shape) ? std::optional(shape) : std::nullopt;
    }

    bool read_form(const XmlElement& e, RobotShape& shape)
    {
        if (e.name == "box")
        {
            document_.list_all_but(e, {"size"});
            shape.kind = ShapeKind::Box, shape.size = document_.vector(e, "size", {}) * 0.5;
            if (!(shape.size.x > 0 && shape.size.y > 0 && shape.size.z > 0))
                return document_.error(e, "size must be three positive numbers"), false;
            return true;
        }
        if (e.name == "sphere" || e.name == "cylinder" || e.name == "capsule")
            document_.list_all_but(e, {"radius", e.name == "sphere" ? "radius" : "length"});
        if (e.name == "sphere") return shape.kind = ShapeKind::Sphere, (shape.size.x = document_.positive(e, "radius")) > 0;
        if (e.name == "cylinder" || e.name == "capsule")
        {
            shape.kind = e.name == "cylinder" ? ShapeKind::Cylinder : ShapeKind::Capsule;
            shape.size = {document_.positive(e, "radius"), 0, document_.positive(e, "length") / 2};
            return shape.size.x > 0 && shape.size.z > 0;
        }
        if (e.name == "mesh") return read_mesh(e, shape);
        return document_.lost(e, "is not carried over: pLab has no such shape"), false;
    }

    bool read_mesh(const XmlElement& e, RobotShape& shape)
    {
        document_.list_all_but(e, {"filename", "scale"});
        const std::string name = document_.text(e, "filename");
        const std::string path = find_mesh_file(document_.file(), "", name);
        if (path.empty()) return document_.lost(e, "the mesh '" + name + "' is missing: the shape is left out"), false;
        auto mesh = read_mesh_file(path, document_.vector(e, "scale", {1, 1, 1}));
        if (!mesh) return document_.lost(e, mesh.error().reason + ": the shape is left out"), false;
        shape.kind = ShapeKind::Mesh, shape.mesh = mesh.take();
        return true;
    }

    void read_joint(const XmlElement& e)
    {
        auto joint = read_urdf_joint(e, document_);
        if (!joint) return;
        joint->pose = read_origin(e, document_);
        const auto parent = links_.find(joint->parent), child = links_.find(joint->child);
        if (parent == links_.end()) return document_.error(e, "there is no link '" + joint->parent + "'");
        if (child == links_.end()) return document_.error(e, "there is no link '" + joint->child + "'");
        if (child->second.joint) return document_.error(e, "the link '" + joint->child + "' has two parents");
        if (joints_.contains(joint->name)) return document_.error(e, "there are two joints of this name");
        const UrdfJoint& kept = joints_.emplace(joint->name, std::move(*joint)).first->second;
        child->second.joint = &kept;
        parent->second.children.push_back(kept.child);
    }

    /// Puts parents before their children.
    void order()
    {
        std::map<std::string, std::size_t> rows;
        std::vector<std::string> waiting;
        for (const std::string& name : names_)
        {
            if (links_.at(name).joint) continue;
            if (!waiting.empty() || !robot_.bodies.empty())
                return document_.error(links_.at(name).body.where, "<link> '" + name + "'", "is a second link without parent");
            for (waiting.push_back(name); !waiting.empty();)
            {
                const std::string next = waiting.back();
                waiting.pop_back();
                rows[next] = robot_.bodies.size();
                place(links_.at(next), rows);
                const auto& children = links_.at(next).children;
                waiting.insert(waiting.end(), children.rbegin(), children.rend());
            }
        }
        for (const std::string& name : names_)
            if (!rows.contains(name)) return document_.error(links_.at(name).body.where, "<link> '" + name + "'", "is its own ancestor");
    }

    void place(Link& link, const std::map<std::string, std::size_t>& rows)
    {
        RobotBody body = std::move(link.body);
        if (link.joint)
        {
            const UrdfJoint& joint = *link.joint;
            body.parent = rows.at(joint.parent), body.pose = joint.pose, body.free = joint.floating, body.joints = joint.joints;
        }
        else
            body.free = !fixed_base_ && !(body.name == "world" && !link.inertial);
        robot_.base_collides = robot_.base_collides || body.self_collide;
        robot_.bodies.push_back(std::move(body));
    }

    /// A joint that mimics another begins where that one puts it, and follows it as a gear.
    void start_mimics()
    {
        std::map<std::string, Joint*> by_name;
        for (RobotBody& body : robot_.bodies)
            for (Joint& joint : body.joints) by_name[joint.name] = &joint;
        for (auto& [name, joint] : joints_)
        {
            if (joint.mimics.empty()) continue;
            const auto lead = by_name.find(joint.mimics), follower = by_name.find(name);
            if (lead == by_name.end() || follower == by_name.end() || joint.mimics == name)
            {
                document_.error(joint.where, "<joint> '" + name + "'",
                                "cannot mimic '" + joint.mimics + "': it has to be another moving joint");
                continue;
            }
            follower->second->start = joint.multiplier * lead->second->start + joint.offset;
            robot_.couplings.push_back({CouplingKind::Gear, name + ".mimic", joint.mimics, name, joint.multiplier, {}, {}, joint.where});
        }
    }

    const XmlElement& root_;
    bool fixed_base_, self_collide_;
    Document& document_;
    Robot robot_;
    std::map<std::string, Vec3> materials_;
    std::map<std::string, Link> links_;
    std::vector<std::string> names_;  ///< of the links, in the order of the file
    std::map<std::string, UrdfJoint> joints_;
};

}  // namespace

Robot read_urdf(const XmlElement& root, bool fixed_base, bool self_collide, Document& document)
{
    return UrdfReader(root, fixed_base, self_collide, document).read();
}

}  // namespace plab::import
