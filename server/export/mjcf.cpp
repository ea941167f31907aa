#include "export/mjcf.h"

#include <cmath>

#include "export/mechanism.h"
#include "import/component_text.h"
#include "model/numbers.h"

namespace plab::exported
{
namespace
{

using import::attribute;
using model::format_real;

std::string pose_attributes(const Pose& X)
{
    return (X.p == Vec3{} ? "" : attribute("pos", X.p)) + (X.q == Quat{} ? "" : attribute("quat", X.q));
}

class Writer
{
public:
    Writer(const world::World& world, double dt) : world_(world), dt_(dt), mechanism_(mechanism_of(world)) {}

    ExportedScene run()
    {
        children_.resize(mechanism_.bodies.size());
        for (std::size_t i = 0; i < mechanism_.bodies.size(); ++i)
            (mechanism_.bodies[i].parent == kWorld ? roots_ : children_[mechanism_.bodies[i].parent]).push_back(i);
        write_bodies();
        std::string out = "<mujoco" + attribute("model", title()) + ">\n  <compiler angle=\"radian\" autolimits=\"true\"/>\n  <option" +
                          attribute("timestep", dt_) + attribute("gravity", mechanism_.gravity) + "/>\n";
        if (!assets_.empty()) out += "  <asset>\n" + assets_ + "  </asset>\n";
        out += "  <worldbody>\n" + text_ + "  </worldbody>\n" + exclusions() + equalities() + actuators() + "</mujoco>\n";
        done_.text = std::move(out);
        for (Error& loss : mechanism_.losses) done_.losses.push_back(std::move(loss));
        return std::move(done_);
    }

private:
    std::string title() const
    {
        const std::string& title = world_.scene().settings.title;
        return title.empty() ? "scene" : title;
    }

    void lost(const std::string& id, const std::string& why) { done_.losses.push_back({{}, id, why}); }

    // ---- bodies

    /// Depth first, without recursion: chains may be long.
    void write_bodies()
    {
        struct Open
        {
            std::size_t body = 0, next = 0;
        };
        std::vector<Open> open;
        for (const std::size_t root : roots_)
        {
            // MuJoCo's world has this name, and shapes of its own.
            if (const Body& b = mechanism_.bodies[root]; b.is_static && b.name == "world")
            {
                for (const Ref shape : world_.host().bodies.shapes[b.host]) write_shape(b, shape.index, b.X_PB, indent(0));
                continue;
            }
            for (begin_body(root, 0), open.push_back({root, 0}); !open.empty();)
            {
                Open& top = open.back();
                if (top.next < children_[top.body].size())
                {
                    const std::size_t child = children_[top.body][top.next++];
                    begin_body(child, open.size()), open.push_back({child, 0});
                }
                else
                    open.pop_back(), text_ += indent(open.size()) + "</body>\n";
            }
        }
    }

    static std::string indent(std::size_t depth) { return std::string(4 + 2 * depth, ' '); }

    void begin_body(std::size_t index, std::size_t depth)
    {
        const Body& b = mechanism_.bodies[index];
        const std::string inner = indent(depth + 1);
        text_ += indent(depth) + "<body" + attribute("name", b.name) + pose_attributes(b.X_PB) +
                 (b.weightless ? attribute("gravcomp", 1) : "") + ">\n";
        if (!b.is_static) text_ += inner + inertial(b) + "\n", ++done_.bodies;
        if (b.joint.kind != JointKind::None) text_ += inner + joint(b) + "\n";
        if (b.joint.kind != JointKind::None && b.joint.kind != JointKind::Free) ++done_.joints;
        for (const Ref shape : world_.host().bodies.shapes[b.host]) write_shape(b, shape.index, {}, inner);
    }

    std::string inertial(const Body& b) const
    {
        const Bodies& bodies = world_.host().bodies;
        const Mat3& I = bodies.inertia_B[b.host];
        std::string moments;
        for (const double x : {I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2)})
            moments += (moments.empty() ? "" : " ") + format_real(x);
        return "<inertial" + attribute("pos", bodies.center_B[b.host]) + attribute("mass", bodies.mass[b.host]) +
               attribute("fullinertia", moments) + "/>";
    }

    static std::string joint(const Body& b)
    {
        const Joint& j = b.joint;
        if (j.kind == JointKind::Free) return "<freejoint" + attribute("name", b.name + ".free") + "/>";
        const char* const type = j.kind == JointKind::Ball ? "ball" : j.kind == JointKind::Slide ? "slide" : "hinge";
        std::string out = "<joint" + attribute("name", j.name) + attribute("type", type) + attribute("pos", j.anchor);
        if (j.kind == JointKind::Ball) return out + "/>";
        out += attribute("axis", j.axis);
        if (j.value != 0) out += attribute("ref", j.value);
        // MJCF has no bound on one side alone.
        constexpr double kFar = 1e6;
        if (std::isfinite(j.lower) || std::isfinite(j.upper))
            out += attribute("range", format_real(std::fmax(j.lower, -kFar)) + " " + format_real(std::fmin(j.upper, kFar)));
        if (j.stiffness != 0) out += attribute("stiffness", j.stiffness) + attribute("springref", j.rest);
        if (j.damping != 0) out += attribute("damping", j.damping);
        if (j.friction != 0) out += attribute("frictionloss", j.friction);
        if (j.armature != 0) out += attribute("armature", j.armature);
        return out + "/>";
    }

    // ---- shapes

    void write_shape(const Body& b, std::uint32_t index, const Pose& X, const std::string& inner)
    {
        const Geometry& g = world_.host().shapes.geometry[index];
        if (g.kind == GeometryKind::Compound)
        {
            for (const std::uint32_t part : g.parts) write_shape(b, part, X * g.pose, inner);
            return;
        }
        std::string form;
        bool collides = true;
        switch (g.kind)
        {
            case GeometryKind::Sphere:
                form = attribute("type", "sphere") + attribute("size", g.size.x);
                break;
            case GeometryKind::Box:
                form = attribute("type", "box") + attribute("size", g.size);
                break;
            case GeometryKind::Capsule:
            case GeometryKind::Cylinder:
                form = attribute("type", g.kind == GeometryKind::Capsule ? "capsule" : "cylinder") +
                       attribute("size", format_real(g.size.x) + " " + format_real(g.size.z));
                break;
            case GeometryKind::Plane:
                form = attribute("type", "plane") + attribute("size", "0 0 1");  // without bounds
                break;
            case GeometryKind::Mesh:
                form = attribute("type", "mesh") + attribute("mesh", mesh(g)), collides = g.hull_collides;
                break;
            default:
                return lost(b.name, "a shape of it has no counterpart in MJCF");
        }
        const bool felt = collides && (b.type != 0 || b.affinity != 0);
        text_ += inner + "<geom" + form + pose_attributes(X * g.pose) + attribute("contype", felt ? b.type : 0) +
                 attribute("conaffinity", felt ? b.affinity : 0) + (felt ? attribute("friction", b.friction) : "") + "/>\n";
    }

    /// Its name among the assets.
    std::string mesh(const Geometry& g)
    {
        const std::string name = "mesh." + std::to_string(meshes_++);
        std::string points, corners;
        for (const Vec3& v : g.vertices)
            for (int k = 0; k < 3; ++k) points += (points.empty() ? "" : " ") + format_real(v[k]);
        for (const std::uint32_t i : g.triangles) corners += (corners.empty() ? "" : " ") + std::to_string(i);
        assets_ += "    <mesh" + attribute("name", name) + attribute("vertex", points) + attribute("face", corners) + "/>\n";
        return name;
    }

    // ---- between bodies

    std::string exclusions() const
    {
        std::string out;
        for (const auto& [first, second] : mechanism_.exclusions)
            out += "    <exclude" + attribute("body1", first) + attribute("body2", second) + "/>\n";
        return out.empty() ? out : "  <contact>\n" + out + "  </contact>\n";
    }

    std::string equalities() const
    {
        std::string out;
        for (const Equality& e : mechanism_.equalities)
            if (e.kind == Equality::Kind::Ratio)
                out += "    <joint" + attribute("name", e.name) + attribute("joint1", e.second) + attribute("joint2", e.first) +
                       attribute("polycoef", "0 " + format_real(e.factor) + " 0 0 0") + "/>\n";
            else
                out += std::string("    <") + (e.kind == Equality::Kind::Weld ? "weld" : "connect") + attribute("name", e.name) +
                       attribute("body1", e.first) + (e.second.empty() ? "" : attribute("body2", e.second)) +
                       (e.kind == Equality::Kind::Weld ? "" : attribute("anchor", e.anchor)) + "/>\n";
        return out.empty() ? out : "  <equality>\n" + out + "  </equality>\n";
    }

    /// A range; "" if neither bound is there.
    static std::string range(const char* name, double lower, double upper)
    {
        constexpr double kFar = 1e10;
        if (!std::isfinite(lower) && !std::isfinite(upper)) return {};
        return attribute(name, format_real(std::fmax(lower, -kFar)) + " " + format_real(std::fmin(upper, kFar)));
    }

    std::string actuators() const
    {
        std::string out;
        for (const Actuator& a : mechanism_.actuators)
        {
            const bool motor = a.gain == 1 && a.bias == Vec3{};
            out += std::string("    <") + (motor ? "motor" : "general") + attribute("name", a.name) + attribute("joint", a.joint) +
                   attribute("gear", a.gear) + range("ctrlrange", a.control_lower, a.control_upper) +
                   range("forcerange", a.force_lower, a.force_upper);
            if (!motor) out += attribute("gainprm", a.gain) + attribute("biastype", "affine") + attribute("biasprm", a.bias);
            out += "/>\n";
        }
        return out.empty() ? out : "  <actuator>\n" + out + "  </actuator>\n";
    }

    const world::World& world_;
    double dt_;
    Mechanism mechanism_;
    ExportedScene done_;
    std::vector<std::vector<std::size_t>> children_;
    std::vector<std::size_t> roots_;
    std::string text_, assets_;
    std::size_t meshes_ = 0;
};

}  // namespace

ExportedScene write_mjcf(const world::World& world, double dt) { return Writer(world, dt).run(); }

}  // namespace plab::exported
