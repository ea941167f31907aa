#include "export/mechanism.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "export/components.h"

namespace plab::exported
{
namespace
{

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kParallel = 1e-6;  ///< |a x b| of unit vectors

/// A joint component between two bodies, before it is known which of them is nearer to the root.
struct FoundJoint
{
    ComponentView view;
    JointKind kind;
    std::uint32_t a, b;  ///< host indices; kNoIndex: the world
    bool in_tree = false;
};

JointKind kind_of(const std::string& type)
{
    if (type == "Constraint/Hinge") return JointKind::Hinge;
    if (type == "Constraint/Slider") return JointKind::Slide;
    if (type == "Constraint/Ball") return JointKind::Ball;
    return type == "Constraint/Fixed" ? JointKind::None : JointKind::Free;
}

class MechanismReader
{
public:
    explicit MechanismReader(const world::World& world) : world_(world), bodies_(world.host().bodies) {}

    Mechanism read()
    {
        for (const ComponentView& c : components_of(world_))
        {
            if (c.facet() == Facet::Body) numbers_[c.host()] = body_components_.size(), body_components_.push_back(c);
            if (const JointKind kind = kind_of(c.type()); kind != JointKind::Free)
                joints_.push_back({c, kind, moving(c.participant("a")), moving(c.participant("b"))});
        }
        for (std::size_t j = 0; j < joints_.size(); ++j)
            for (const std::uint32_t host : {joints_[j].a, joints_[j].b})
                if (host != kNoIndex) joints_of_[host].push_back(j);
        grow_trees();
        for (FoundJoint& joint : joints_)
            if (!joint.in_tree) close_loop(joint);
        for (const ComponentView& c : components_of(world_)) read_component(c);
        list_velocities();
        for (Body& body : out_.bodies) body.weightless = !body.is_static && !heavy_.contains(body.host);
        return std::move(out_);
    }

private:
    static constexpr std::size_t kMostExclusions = 20'000;

    void lost(const ComponentView& c, const std::string& why) { out_.losses.push_back({{}, c.id() + " (" + c.type() + ")", why}); }

    /// kNoIndex for the world, and for what is no body or does not move by forces.
    std::uint32_t moving(Ref ref) const
    {
        return ref.valid() && ref.facet == Facet::Body && bodies_.dynamic(ref.index) ? ref.index : kNoIndex;
    }

    // ---- trees

    void grow_trees()
    {
        for (const ComponentView& c : body_components_)
            if (!bodies_.dynamic(c.host())) add_body(c.host(), c, kWorld, nullptr);
        // First what hangs on the world, then what hangs on that, then what is free.
        std::vector<std::uint32_t> waiting;
        for (FoundJoint& joint : joints_)
        {
            const std::uint32_t child = joint.a == kNoIndex ? joint.b : joint.a;
            if ((joint.a == kNoIndex) == (joint.b == kNoIndex) || rows_.contains(child)) continue;  // between bodies, or closes a loop
            joint.in_tree = true;
            add_body(child, component_of(child), kWorld, &joint), waiting.push_back(child);
        }
        grow_from(std::move(waiting));
        // A free tree begins where its joints begin: with a body that is the b of none of them.
        std::set<std::uint32_t> held;
        for (const FoundJoint& joint : joints_) held.insert(joint.b);
        for (const bool any : {false, true})
            for (const ComponentView& c : body_components_)
                if (!rows_.contains(c.host()) && (any || !held.contains(c.host())))
                    add_body(c.host(), c, kWorld, nullptr), grow_from({c.host()});
    }

    /// Breadth first.
    void grow_from(std::vector<std::uint32_t> waiting)
    {
        for (std::size_t next = 0; next < waiting.size(); ++next)
            for (const std::size_t j : joints_of_[waiting[next]])
            {
                FoundJoint& joint = joints_[j];
                const std::uint32_t at = waiting[next], other = joint.a == at ? joint.b : joint.a;
                if (joint.in_tree || other == kNoIndex || rows_.contains(other)) continue;
                joint.in_tree = true;
                add_body(other, component_of(other), rows_.at(at), &joint);
                waiting.push_back(other);
            }
    }

    const ComponentView& component_of(std::uint32_t host) const { return body_components_[numbers_.at(host)]; }

    void add_body(std::uint32_t host, const ComponentView& c, std::size_t parent, const FoundJoint* joint)
    {
        Body body;
        body.name = c.id(), body.host = host, body.parent = parent, body.is_static = !bodies_.dynamic(host);
        const Pose X_WB = bodies_.pose(host);
        body.X_PB = parent == kWorld ? X_WB : inverse(bodies_.pose(out_.bodies[parent].host)) * X_WB;
        body.joint.lower = -kInfinity, body.joint.upper = kInfinity;
        if (body.is_static) body.joint.kind = JointKind::None;
        if (bodies_.motion[host] == Motion::Kinematic) lost(c, "moves as it is told: here it stands still");
        if (joint) body.joint = joint_of(*joint, host == joint->b);
        rows_[host] = out_.bodies.size();
        out_.bodies.push_back(std::move(body));
    }

    /// `forward`: the body is the joint's b, so that its coordinate is that of the component.
    Joint joint_of(const FoundJoint& found, bool forward) const
    {
        Joint out;
        out.name = found.view.id(), out.kind = found.kind, out.lower = -kInfinity, out.upper = kInfinity;
        out.anchor = found.view.vector(forward ? "point_b" : "point_a");
        if (found.kind != JointKind::Hinge && found.kind != JointKind::Slide) return out;
        out.axis = rotate(found.view.rotation(forward ? "frame_b" : "frame_a"), {0, 0, 1}) * (forward ? 1 : -1);
        out.value = found.view.real(found.kind == JointKind::Hinge ? "angle" : "travelled");
        return out;
    }

    /// The present coordinate of a component along a joint: as it counts, rad or m.
    double present(const ComponentView& c) const
    {
        if (c.text("along") != "slide") return c.real("angle");
        const std::uint32_t a = moving(c.participant("a")), b = moving(c.participant("b"));
        const Pose X_WA = frame_of_a(c, a), X_WB = b == kNoIndex ? Pose{} : bodies_.pose(b);
        return dot(X_WB * c.vector("point_b") - X_WA * c.vector("point_a"), rotate(X_WA.q, c.vector("travel_axis")));
    }

    /// The body of role a, which may be one that does not move.
    Pose frame_of_a(const ComponentView& c, std::uint32_t a) const
    {
        if (a != kNoIndex) return bodies_.pose(a);
        const Ref ref = c.participant("a");
        return ref.valid() && ref.facet == Facet::Body ? bodies_.pose(ref.index) : Pose{};
    }

    void close_loop(const FoundJoint& joint)
    {
        const bool b_moves = joint.b != kNoIndex;
        if (!b_moves && joint.a == kNoIndex) return lost(joint.view, "holds nothing that moves");
        Equality e;
        const std::uint32_t first = b_moves ? joint.b : joint.a, second = b_moves ? joint.a : joint.b;
        e.name = joint.view.id(), e.first = component_of(first).id();
        if (second != kNoIndex) e.second = component_of(second).id();
        e.anchor = joint.view.vector(b_moves ? "point_b" : "point_a");
        e.kind = joint.kind == JointKind::None ? Equality::Kind::Weld : Equality::Kind::Connect;
        if (joint.kind == JointKind::Slide) return lost(joint.view, "closes a loop: MJCF has no such constraint for a slider");
        out_.equalities.push_back(e);
        if (joint.kind != JointKind::Hinge) return;
        // Two points of the axis make a hinge.
        e.name += ".2", e.anchor += rotate(joint.view.rotation(b_moves ? "frame_b" : "frame_a"), {0, 0, 0.1});
        out_.equalities.push_back(std::move(e));
    }

    // ---- what acts along joints

    /// The joint of the tree along which a component acts that has roles a and b, or null; `sign`: of its coordinate against the joint's.
    Joint* joint_along(const ComponentView& c, double& sign)
    {
        const std::uint32_t a = moving(c.participant("a")), b = moving(c.participant("b"));
        const bool slides = c.text("along") == "slide";
        for (Body& body : out_.bodies)
        {
            const std::uint32_t parent =
                body.parent == kWorld || out_.bodies[body.parent].is_static ? kNoIndex : out_.bodies[body.parent].host;
            const bool forward = body.host == b && parent == a, backward = body.host == a && parent == b;
            if (body.joint.kind != (slides ? JointKind::Slide : JointKind::Hinge) || !(forward || backward)) continue;
            const Vec3 axis_W = rotate(bodies_.orientation[body.host], body.joint.axis);
            const Vec3 own = slides ? rotate(frame_of_a(c, a).q, c.vector("travel_axis"))
                                    : rotate(bodies_.orientation[b], rotate(c.rotation("frame"), {0, 0, 1}));
            if (length(cross(axis_W, own)) > kParallel) continue;
            return sign = dot(axis_W, own) * (forward ? 1 : -1) > 0 ? 1 : -1, &body.joint;
        }
        return nullptr;
    }

    /// q of the joint where the component's coordinate is x.
    double on_joint(const ComponentView& c, const Joint& joint, double sign, double x) const
    {
        return joint.value + sign * (x - present(c));
    }

    void read_component(const ComponentView& c)
    {
        const std::string& type = c.type();
        if (kind_of(type) != JointKind::Free || c.facet() == Facet::Body || type.starts_with("Shape/") || c.facet() == Facet::Shape) return;
        if (type == "Field/Gravity") return read_gravity(c);
        if (type == "CDetection/ODE") return read_detection(c);
        if (type == "Collision/Exclude") return read_exclusion(c);
        if (type == "Constraint/Gear") return read_gear(c);
        if (c.facet() == Facet::Shaft) return;                                                           // with its gear
        if (type == "Material/Pair" || type == "Response/Automatic" || type == "Response/Rows") return;  // with the detection
        double sign = 1;
        Joint* const joint =
            type == "Constraint/Limit" || type == "Constraint/TorsionSpring" || type == "Constraint/Motor" || type == "Constraint/Actuator"
                ? joint_along(c, sign)
                : nullptr;
        if (!joint) return lost(c, "has no counterpart in MJCF");
        read_along(c, *joint, sign);
    }

    void read_along(const ComponentView& c, Joint& joint, double sign)
    {
        if (c.type() == "Constraint/Limit")
        {
            const double one = on_joint(c, joint, sign, c.real("lower")), other = on_joint(c, joint, sign, c.real("upper"));
            joint.lower = std::fmin(one, other), joint.upper = std::fmax(one, other);
            if (c.real("restitution") != 0) lost(c, "restitution of a stop is not carried over");
        }
        else if (c.type() == "Constraint/TorsionSpring")
            joint.stiffness = c.real("stiffness"), joint.damping = c.real("damping"), joint.rest = on_joint(c, joint, sign, c.real("rest"));
        else if (c.type() == "Constraint/Actuator")
            read_actuator(c, joint, sign);
        else if (c.real("speed") == 0 && c.text("mode") == "rate" && std::isfinite(c.real("max_effort")))
            joint.friction = c.real("max_effort");
        else
            lost(c, "has no counterpart in MJCF: only a motor that stands still and may slip, which is dry friction");
    }

    void read_actuator(const ComponentView& c, const Joint& joint, double sign)
    {
        Actuator a;
        a.name = c.id(), a.joint = joint.name, a.gear = sign * c.real("gear"), a.gain = c.real("gain"), a.bias = c.vector("bias");
        a.bias.x -= a.bias.y * a.gear * on_joint(c, joint, sign, 0);
        a.control_lower = c.real("control_lower"), a.control_upper = c.real("control_upper");
        a.force_lower = c.real("force_lower"), a.force_upper = c.real("force_upper");
        if (c.real("control") != 0) lost(c, "its control is 0 in MJCF at the beginning");
        out_.actuators.push_back(std::move(a));
    }

    struct SpunJoint
    {
        Joint* joint = nullptr;
        double sign = 1;  ///< of the spin against the joint's coordinate
    };

    /// The hinge of the tree about which a body spins relative to the carrier, if its axle lies along it. `frame`: the axle's frame in the
    /// body.
    SpunJoint joint_of_spin(Ref ref, std::uint32_t carrier, const Quat& frame)
    {
        if (ref.facet != Facet::Body) return {};
        const Vec3 axle = rotate(bodies_.orientation[ref.index], rotate(frame, {0, 0, 1}));
        for (Body& body : out_.bodies)
        {
            const std::uint32_t parent = body.parent == kWorld ? kNoIndex : out_.bodies[body.parent].host;
            const bool forward = body.host == ref.index && parent == carrier, backward = body.host == carrier && parent == ref.index;
            const Vec3 axis = rotate(bodies_.orientation[body.host], body.joint.axis);
            if (body.joint.kind != JointKind::Hinge || !(forward || backward) || length(cross(axis, axle)) > kParallel) continue;
            return {&body.joint, dot(axis, axle) * (forward ? 1 : -1) > 0 ? 1.0 : -1.0};
        }
        return {};
    }

    /// A shaft geared to a hinge is a rotor; two hinges on the same body are coupled.
    void read_gear(const ComponentView& c)
    {
        const Ref driver = c.participant("driver"), driven = c.participant("driven");
        const std::uint32_t carrier = moving(c.participant("carrier"));
        const SpunJoint first = joint_of_spin(driver, carrier, c.rotation("driver_frame"));
        const double factor = c.real("velocity_factor");
        if (std::get<std::int64_t>(world_.get(c.index(), "driver_teeth")) != 0 || !first.joint)
            return lost(c, "has no counterpart in MJCF: it is no rotor of a hinge");
        if (driven.facet == Facet::Shaft)
            return void(first.joint->armature +=
                        factor * factor * ComponentView(world_, world_.host().component_of(driven)).real("inertia"));
        const SpunJoint second = joint_of_spin(driven, carrier, c.rotation("driven_frame"));
        if (!second.joint) return lost(c, "couples what are no hinges on the same body");
        out_.equalities.push_back(
            {Equality::Kind::Ratio, c.id(), first.joint->name, second.joint->name, {}, factor * first.sign * second.sign});
    }

    void read_gravity(const ComponentView& c)
    {
        if (length(out_.gravity) > 0) return lost(c, "is a second gravity");
        out_.gravity = c.vector("acceleration");
        for (const Ref ref : c.participants("between"))
            if (ref.facet == Facet::Body) heavy_.insert(ref.index);
    }

    /// `between` collide with one another and with `against`, which do not with one another: one bit for each detection.
    void read_detection(const ComponentView& c)
    {
        if (detections_ >= 31) return lost(c, "is one detection too many");
        const std::uint32_t bit = 1U << detections_++;
        const Ref response = c.participant("response");
        const double friction = response.valid() ? ComponentView(world_, world_.host().component_of(response)).real("friction") : 0;
        for (const char* const role : {"between", "against"})
            for (const Ref ref : c.participants(role))
            {
                const auto row = ref.facet == Facet::Body ? rows_.find(ref.index) : rows_.end();
                if (row == rows_.end()) continue;
                Body& body = out_.bodies[row->second];
                body.type |= bit;
                if (role == std::string_view("between")) body.affinity |= bit;
                const std::uint32_t material = bodies_.material[ref.index];
                const SurfaceLaw* const own = world_.host().materials.find_pair(material, material);
                body.friction = own ? own->friction : friction;
            }
    }

    /// MuJoCo leaves out the pair of a body and the one that it hangs on by itself, unless that one never moves.
    void read_exclusion(const ComponentView& c)
    {
        const std::vector<std::size_t> within = excluded(c, "within"), a = excluded(c, "a"), b = excluded(c, "b");
        if (within.size() * within.size() / 2 + a.size() * b.size() + out_.exclusions.size() > kMostExclusions)
            return lost(c, "excludes more pairs of bodies than a model can list");
        for (std::size_t i = 0; i < within.size(); ++i)
            for (std::size_t k = i + 1; k < within.size(); ++k) add_exclusion(within[i], within[k]);
        for (const std::size_t i : a)
            for (const std::size_t k : b) add_exclusion(i, k);
    }

    std::vector<std::size_t> excluded(const ComponentView& c, const char* role)
    {
        std::vector<std::size_t> out;
        for (const Ref ref : c.participants(role))
        {
            const auto row = ref.facet == Facet::Body ? rows_.find(ref.index) : rows_.end();
            if (row != rows_.end()) out.push_back(row->second);
        }
        if (out.size() < c.participants(role).size()) lost(c, "excludes single shapes, which MJCF cannot");
        return out;
    }

    void add_exclusion(std::size_t i, std::size_t k)
    {
        const auto hangs_on = [&](std::size_t child, std::size_t parent)
        { return out_.bodies[child].parent == parent && !out_.bodies[parent].is_static; };
        if (i == k || (out_.bodies[i].is_static && out_.bodies[k].is_static) || hangs_on(i, k) || hangs_on(k, i)) return;
        out_.exclusions.emplace_back(out_.bodies[i].name, out_.bodies[k].name);
    }

    void list_velocities()
    {
        for (const Body& body : out_.bodies)
            if (!body.is_static && (length(bodies_.velocity[body.host]) > 0 || length(bodies_.angular_velocity[body.host]) > 0))
                lost(component_of(body.host), "begins at rest in MJCF");
    }

    const world::World& world_;
    const Bodies& bodies_;
    Mechanism out_;
    std::vector<ComponentView> body_components_;
    std::vector<FoundJoint> joints_;
    std::map<std::uint32_t, std::size_t> numbers_;                 ///< of body components, by host index
    std::map<std::uint32_t, std::vector<std::size_t>> joints_of_;  ///< by host index of a body
    std::map<std::uint32_t, std::size_t> rows_;                    ///< rows of bodies by host index
    std::set<std::uint32_t> heavy_;
    std::uint32_t detections_ = 0;
};

}  // namespace

Mechanism mechanism_of(const world::World& world) { return MechanismReader(world).read(); }

}  // namespace plab::exported
