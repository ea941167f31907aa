#include "import/sdf_link.h"

#include <charconv>
#include <cmath>

#include "import/link_shapes.h"
#include "import/mesh_file.h"
#include "import/sdf_text.h"
#include "import/solid_shapes.h"
#include "objects/shapes/volume_integration.h"

namespace plab::import
{
namespace
{

/// Files write "infinite" as they like.
constexpr double kMostFriction = 1e6;

class LinkReader
{
public:
    LinkReader(const std::string& scope, const std::string& full, SdfFrames& frames, const SdfFiles& files, Document& document)
        : scope_(scope), full_(full), frames_(frames), files_(files), document_(document)
    {
    }

    RobotBody read(const XmlElement& e, bool fixed)
    {
        document_.list_attributes(e, {"name"});
        document_.list_children(e, {"pose", "inertial", "collision", "visual", "gravity", "self_collide", "enable_wind", "kinematic"});
        document_.list_repeated(e, {"collision", "visual"});
        RobotBody body;
        body.name = full_, body.where = e.where;
        body.weightless = !sdf_truth(e, "gravity", true, document_);
        for (const char* const name : {"enable_wind", "kinematic"})
            if (sdf_truth(e, name, false, document_)) document_.lost(*find_child(e, name), "is not carried over");
        std::vector<RobotShape> seen, felt;
        std::vector<MassProperties> solids;
        const XmlElement* const inertial = find_child(e, "inertial");
        const bool by_shapes = inertial && document_.text(*inertial, "auto") == "true";
        for (const XmlElement& child : e.children)
        {
            if (child.name != "visual" && child.name != "collision") continue;
            auto shape = read_shape(child);
            if (!shape) continue;
            if (by_shapes && shape->collides) add_solid(child, *shape, *inertial, solids);
            (child.name == "visual" ? seen : felt).push_back(std::move(*shape));
        }
        body.shapes = joined_shapes(std::move(seen), std::move(felt), full_, document_);
        if (by_shapes)
            body.mass = solids.empty() ? MassProperties{} : shapes::joined(solids);
        else if (!fixed)
            body.mass = read_inertial(inertial);
        return body;
    }

private:
    /// X_LF of a pose whose default frame is the link's.
    Pose in_link(const XmlElement& e)
    {
        const SdfPose given = sdf_pose(e, document_);
        if (given.relative_to.empty()) return given.pose;
        const auto base = frames_.find(scope_, given.relative_to, e.where, Document::title_of(e));
        return base ? inverse(frames_.in_world(full_)) * frames_.in_world(*base) * given.pose : given.pose;
    }

    /// A link without <inertial> has the format's defaults: 1 kg and 1 kg m^2 about each axis.
    MassProperties read_inertial(const XmlElement* e)
    {
        MassProperties out{1, {}, Mat3::identity()};
        if (!e) return out;
        document_.list_attributes(*e, {"auto"});
        document_.list_children(*e, {"pose", "mass", "inertia", "density"});
        out.mass = sdf_number(*e, "mass", 1, document_);
        const XmlElement* const inertia = find_child(*e, "inertia");
        if (inertia)
        {
            document_.list_children(*inertia, {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"});
            const auto value = [&](const char* name, double otherwise) { return sdf_number(*inertia, name, otherwise, document_); };
            const double xx = value("ixx", 1), xy = value("ixy", 0), xz = value("ixz", 0), yy = value("iyy", 1), yz = value("iyz", 0);
            out.inertia = {{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, value("izz", 1)}}};
        }
        if (!document_.failed()) document_.check_mass(e->where, "<inertial> of link '" + full_ + "'", out.mass, out.inertia);
        const Pose X = in_link(*e);
        const Mat3 R = rotation_matrix(X.q);
        return {out.mass, X.p, R * out.inertia * transposed(R)};
    }

    void add_solid(const XmlElement& collision, const RobotShape& shape, const XmlElement& inertial, std::vector<MassProperties>& out)
    {
        const double density = sdf_number(collision, "density", sdf_number(inertial, "density", 1000, document_), document_);
        if (!(density > 0)) return document_.error(collision, "density must be positive");
        const auto solid = solid_of(shape);
        if (!solid) return document_.error(collision, solid.error().reason);
        if (solid->mass == 0) return;
        MassProperties part = shapes::posed(*solid, shape.pose);
        part.mass *= density, part.inertia = part.inertia * density;
        out.push_back(part);
    }

    std::optional<RobotShape> read_shape(const XmlElement& e)
    {
        const bool seen = e.name == "visual";
        document_.list_attributes(e, {"name"});
        document_.list_children(e, seen ? std::initializer_list<std::string_view>{"pose", "geometry", "material", "cast_shadows"}
                                        : std::initializer_list<std::string_view>{"pose", "geometry", "surface", "density"});
        RobotShape shape;
        shape.where = e.where, shape.collides = !seen;
        shape.contact_type = shape.contact_affinity = 0xffff;
        shape.pose = in_link(e);
        if (const XmlElement* const material = find_child(e, "material")) read_material(*material, shape);
        if (const XmlElement* const surface = find_child(e, "surface")) read_surface(*surface, shape);
        const XmlElement* const geometry = find_child(e, "geometry");
        if (!geometry || geometry->children.empty()) return document_.error(e, "needs a <geometry>"), std::nullopt;
        return read_form(geometry->children.front(), shape) ? std::optional(shape) : std::nullopt;
    }

    bool positive(const XmlElement& e, const char* name, double& out)
    {
        out = sdf_number(e, name, 0, document_);
        return out > 0 || (document_.error(e, std::string("needs a positive <") + name + ">"), false);
    }

    bool read_form(const XmlElement& e, RobotShape& shape)
    {
        if (e.name == "empty") return false;
        if (e.name == "mesh") return read_mesh(e, shape);
        if (e.name == "plane") return read_plane(e, shape);
        double radius = 0, length = 0;
        if (e.name == "sphere") return shape.kind = ShapeKind::Sphere, positive(e, "radius", shape.size.x);
        if (e.name == "cylinder" || e.name == "capsule")
        {
            shape.kind = e.name == "cylinder" ? ShapeKind::Cylinder : ShapeKind::Capsule;
            if (!positive(e, "radius", radius) || !positive(e, "length", length)) return false;
            return shape.size = {radius, 0, length / 2}, true;
        }
        const bool box = e.name == "box";
        if (!box && e.name != "ellipsoid") return document_.lost(e, "is not carried over: pLab has no such shape"), false;
        shape.kind = box ? ShapeKind::Box : ShapeKind::Ellipsoid;
        shape.size = sdf_vector(e, box ? "size" : "radii", {}, document_) * (box ? 0.5 : 1);
        if (shape.size.x > 0 && shape.size.y > 0 && shape.size.z > 0) return true;
        return document_.error(e, std::string(box ? "size" : "radii") + " must be three positive numbers"), false;
    }

    /// Of infinite extent, as the planes that worlds stand on are meant.
    bool read_plane(const XmlElement& e, RobotShape& shape)
    {
        const Vec3 normal = normalized(sdf_vector(e, "normal", {0, 0, 1}, document_));
        if (normal == Vec3{}) return document_.error(e, "normal must be a direction, not the zero vector"), false;
        shape.kind = ShapeKind::Plane;
        shape.pose.q = normalized(shape.pose.q * rotation_from_z(normal));
        return true;
    }

    bool read_mesh(const XmlElement& e, RobotShape& shape)
    {
        document_.list_children(e, {"uri", "scale"});
        const std::string uri = sdf_text(e, "uri"), path = files_.find(uri, e);
        if (path.empty())
            return document_.lost(e, "the mesh '" + uri + "' is missing: the shape is left out (--import-path names folders)"), false;
        auto mesh = read_mesh_file(path, sdf_vector(e, "scale", {1, 1, 1}, document_));
        if (!mesh) return document_.lost(e, mesh.error().reason + ": the shape is left out"), false;
        shape.kind = ShapeKind::Mesh, shape.mesh = mesh.take();
        return true;
    }

    void read_material(const XmlElement& e, RobotShape& shape)
    {
        document_.list_children(e, {"ambient", "diffuse"});
        const XmlElement* color = find_child(e, "diffuse");
        if (!color) color = find_child(e, "ambient");
        double c[4];
        if (!color || document_.numbers_inside(*color, c, 3) < 3) return;
        for (double& x : c) x = std::fmin(1, std::fmax(0, x));
        shape.color = Vec3{c[0], c[1], c[2]};
    }

    void read_surface(const XmlElement& e, RobotShape& shape)
    {
        document_.list_children(e, {"friction", "bounce", "contact"});
        if (const XmlElement* const friction = find_child(e, "friction")) read_friction(*friction, shape);
        if (const XmlElement* const bounce = find_child(e, "bounce")) read_bounce(*bounce, shape);
        if (const XmlElement* const contact = find_child(e, "contact")) read_masks(*contact, shape);
    }

    /// The first coefficient of friction; Gazebo's default is 1.
    void read_friction(const XmlElement& e, RobotShape& shape)
    {
        document_.list_children(e, {"ode"});
        const XmlElement* const ode = find_child(e, "ode");
        if (!ode) return;
        document_.list_children(*ode, {"mu", "mu2"});
        shape.surface.friction = std::fmin(sdf_number(*ode, "mu", 1, document_), kMostFriction);
        if (shape.surface.friction < 0) return document_.error(*ode, "mu must not be negative");
        const double other = std::fmin(sdf_number(*ode, "mu2", shape.surface.friction, document_), kMostFriction);
        if (other != shape.surface.friction)
            document_.lost(*find_child(*ode, "mu2"), "is not carried over: friction is the same in all directions");
    }

    void read_bounce(const XmlElement& e, RobotShape& shape)
    {
        document_.list_children(e, {"restitution_coefficient"});
        shape.surface.restitution = sdf_number(e, "restitution_coefficient", 0, document_);
        if (!(shape.surface.restitution >= 0 && shape.surface.restitution <= 1))
            document_.error(e, "restitution_coefficient must be from 0 to 1");
    }

    /// Shapes collide if the category of one has a bit of the mask of the other; collide_bitmask alone stands for both.
    void read_masks(const XmlElement& e, RobotShape& shape)
    {
        document_.list_children(e, {"collide_bitmask", "category_bitmask"});
        const auto word = [&](const char* name, std::uint32_t otherwise)
        {
            const std::string text = sdf_text(e, name);
            if (text.empty()) return otherwise;
            const bool hex = text.starts_with("0x") || text.starts_with("0X");
            std::uint32_t value = 0;
            const char *const begin = text.data() + (hex ? 2 : 0), *const end = text.data() + text.size();
            const auto [at, fault] = std::from_chars(begin, end, value, hex ? 16 : 10);
            if (fault != std::errc() || at != end) document_.error(e, std::string(name) + " must be a whole number of 32 bits");
            return value;
        };
        shape.contact_affinity = word("collide_bitmask", 0xffff);
        shape.contact_type = word("category_bitmask", shape.contact_affinity);
    }

    const std::string &scope_, &full_;
    SdfFrames& frames_;
    const SdfFiles& files_;
    Document& document_;
};

}  // namespace

RobotBody read_sdf_link(const XmlElement& e, const std::string& scope, const std::string& full, bool fixed, SdfFrames& frames,
                        const SdfFiles& files, Document& document)
{
    return LinkReader(scope, full, frames, files, document).read(e, fixed);
}

}  // namespace plab::import
