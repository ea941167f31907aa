#include "import/write_blueprint.h"

#include <algorithm>
#include <map>
#include <set>

#include "import/cable_text.h"
#include "import/component_text.h"
#include "import/joint_text.h"
#include "import/surface_law.h"
#include "model/numbers.h"
#include "plab/symmetric.h"

namespace plab::import
{
namespace
{

/// A body that moves by several joints gets bodies between them, of this share of its mass and largest moment. Lighter ones would cost
/// digits where a rotor is geared to them: rows on loops have a compliance relative to the mobility of what they hold.
constexpr double kBetweenShare = 1e-5;

class Writer
{
public:
    Writer(const Robot& robot, const Assembly& assembly, std::span<const CollisionExclusion> exclusions, const std::string& group,
           Document& document)
        : robot_(robot),
          assembly_(assembly),
          exclusions_(exclusions),
          group_(group),
          document_(document),
          ids_(group.empty() ? "" : group + "/")
    {
        for (const char* own : {"manager", "gravity", "contact", "contact.resolution", "contact.response", "solver"}) ids_.make(own);
    }

    WrittenScene run()
    {
        for (const PlacedBody& body : assembly_.bodies) body_ids_.push_back(ids_.make(body.name));
        read_materials();
        shape_ids_.resize(assembly_.bodies.size());
        for (std::size_t i = 0; i < assembly_.bodies.size(); ++i) write_body(i);
        for (std::size_t i = 0; i < assembly_.bodies.size(); ++i) write_joints(i);
        for (const Coupling& coupling : robot_.couplings) write_coupling(coupling);
        for (const Cable& cable : robot_.cables) write_cable(cable);
        for (const Actuator& actuator : robot_.actuators) write_actuator(actuator);
        for (const CollisionExclusion& exclusion : exclusions_) write_exclusion(exclusion);
        if (!body_ids_.empty()) out_.root = body_ids_.front();
        if (!group_.empty()) return write_group();
        write_gravity();
        write_contacts();
        write_manager();
        const std::string settings =
            (robot_.title.empty() ? "" : attribute("title", robot_.title)) + (robot_.step.empty() ? "" : attribute("dt", robot_.step));
        out_.blueprint = "<plab version=\"1\">\n  <scene" + settings + ">" + camera(assembly_) + "</scene>\n" + text_ + "</plab>\n";
        return std::move(out_);
    }

private:
    WrittenScene write_group()
    {
        write_manager();
        out_.blueprint = "<component" + attribute("id", group_) + ">\n" + text_ + "</component>\n";
        return std::move(out_);
    }
    void write_manager()
    {
        if (manager_) line("<component" + attribute("id", ids_.prefix() + "manager") + " type=\"Manager/Automatic\"/>");
    }

    void line(const std::string& component) { text_ += "  " + component + "\n"; }
    const PlacedBody& body(std::size_t i) const { return assembly_.bodies[i]; }
    static std::string quoted(const std::string& name) { return "'" + name + "'"; }
    static bool collides(const PlacedBody& b) { return std::ranges::any_of(b.shapes, &RobotShape::collides); }

    // ---- bodies

    /// Without friction of twisting and rolling if no surface has any: they would differ in what does not count.
    static Surface used(Surface surface, bool turns)
    {
        const Surface usual;
        if (!turns) surface.twisting = usual.twisting, surface.rolling = usual.rolling;
        return surface;
    }

    /// Each body's surface is that of its roughest shape.
    void read_materials()
    {
        const auto resists = [](const RobotShape& s) { return s.collides && s.surface.dimensions > 3; };
        const bool turns =
            std::ranges::any_of(assembly_.bodies, [&](const PlacedBody& b) { return std::ranges::any_of(b.shapes, resists); });
        for (const PlacedBody& b : assembly_.bodies)
        {
            Surface least, most;
            least.friction = kInfinity, most.friction = -kInfinity;
            for (const RobotShape& s : b.shapes)
                if (s.collides) least = std::min(least, used(s.surface, turns)), most = std::max(most, used(s.surface, turns));
            if (collides(b) && most != least)
                document_.lost(b.where, quoted(b.name),
                               "its shapes have different surfaces: pLab has one material for a body, and takes that of the roughest, with "
                               "friction " +
                                   model::format_real(most.friction));
            surface_.push_back(most);
        }
        read_pairs();
        for (std::size_t i = 0; i < assembly_.bodies.size(); ++i)
            if (collides(body(i))) surfaces_.insert(surface_[i]);
    }

    /// Bodies of pairs with a friction of their own get a surface that no other body has.
    void read_pairs()
    {
        std::map<std::string, std::size_t> owners;
        for (std::size_t i = 0; i < assembly_.bodies.size() && !robot_.pairs.empty(); ++i)
            for (const RobotShape& s : body(i).shapes)
                if (!s.name.empty()) owners[s.name] = i;
        for (const CollidingPair& pair : robot_.pairs)
        {
            if (!pair.friction) continue;
            const std::size_t a = owners.at(pair.first), b = owners.at(pair.second);
            if (pair_laws_.size() >= kMostPairLaws)
                return document_.lost(pair.where, "<pair>", "its friction is not carried over: 50 pairs may have their own");
            for (const std::size_t i : {a, b})
                if (surface_[i].own = body_ids_[i]; std::ranges::count_if(body(i).shapes, &RobotShape::collides) > 1)
                    document_.lost(pair.where, "<pair>", "its friction is that of all shapes of " + quoted(body(i).name));
            pair_laws_[std::minmax(body_ids_[a], body_ids_[b])] = *pair.friction;
        }
    }

    static std::string material_of(const Surface& s)
    {
        const Surface usual;
        return "friction " + model::format_real(s.friction) +
               (s.restitution > 0 ? " restitution " + model::format_real(s.restitution) : "") +
               (s.solref == usual.solref ? ""
                                         : " solref " + model::format_real(s.solref.first) + " " + model::format_real(s.solref.second)) +
               (s.priority != 0 ? " priority " + std::to_string(s.priority) : "") + (s.dimensions < 3 ? " without friction" : "") +
               (s.dimensions > 3 ? " condim " + std::to_string(s.dimensions) : "") +
               (s.twisting == usual.twisting ? "" : " twisting " + model::format_real(s.twisting)) +
               (s.rolling == usual.rolling ? "" : " rolling " + model::format_real(s.rolling)) + (s.own.empty() ? "" : " of " + s.own);
    }

    SurfaceLaw law_of(const Surface& a, const Surface& b) const
    {
        SurfaceLaw law = surface_law(a, b, robot_.surface_rule);
        if (const auto own = pair_laws_.find(std::minmax(a.own, b.own)); own != pair_laws_.end())
            law.friction = own->second, law.rolling_friction = law.spinning_friction = 0;
        return law;
    }

    void write_body(std::size_t i)
    {
        const PlacedBody& b = body(i);
        if (b.fixed && b.shapes.empty()) return;
        std::string head = "<component" + attribute("id", body_ids_[i]) + attribute("type", b.fixed ? "State/Static" : "State/RigidBody");
        if (!(b.X_WB.p == Vec3{})) head += attribute("position", b.X_WB.p);
        if (!(b.X_WB.q == Quat{})) head += attribute("orientation", b.X_WB.q);
        if (!b.fixed) head += mass_attributes(b.mass);
        if (!b.fixed && !b.weightless) heavy_.push_back(body_ids_[i]);
        if (surfaces_.size() > 1 && collides(b)) head += attribute("material", material_of(surface_[i]));
        std::vector<RobotShape> shapes = b.shapes;
        if (const auto color = take_color(shapes)) head += attribute("color", *color);
        line(head + (b.shapes.empty() ? "/>" : ">"));
        for (RobotShape& shape : shapes)
        {
            shape.is_surface = b.fixed && robot_.fixed_meshes_are_surfaces && shape.collides && shape.mesh && !is_convex(*shape.mesh);
            shape_ids_[i].push_back(ids_.make(body_ids_[i] + ".shape"));
            line("  " + shape_component(shape, shape_ids_[i].back()));
        }
        if (!b.shapes.empty()) line("</component>");
        out_.bodies += b.fixed ? 0 : 1;
    }

    // ---- joints

    /// "" for the world and bodies that never move.
    std::string base_of(std::size_t i) const { return i == kWorld || body(i).fixed ? std::string() : body_ids_[i]; }
    std::string base_role(std::size_t i) const
    {
        const std::string base = base_of(i);
        return base.empty() ? base : attribute("a", base);
    }

    void write_joints(std::size_t i)
    {
        const PlacedBody& b = body(i);
        std::string base = base_of(b.parent);
        for (std::size_t k = 0; k < b.joints.size(); ++k)
        {
            const PlacedJoint& placed = b.joints[k];
            const std::string held = k + 1 == b.joints.size() ? body_ids_[i] : write_between(i, placed.joint);
            write_joint(placed, base, held);
            base = held;
            ++out_.joints;
        }
    }

    /// A light body on which the next joint of body i sits.
    std::string write_between(std::size_t i, const Joint& joint)
    {
        const PlacedBody& b = body(i);
        const Vec3 moments = symmetric_axes(b.mass.inertia).values;
        const double moment = kBetweenShare * std::max({moments.x, moments.y, moments.z});
        const MassProperties light{kBetweenShare * b.mass.mass, joint.anchor, Mat3::diagonal(moment, moment, moment)};
        const std::string id = ids_.make(body_ids_[i] + "." + joint.name);
        line("<component" + attribute("id", id) + attribute("type", "State/RigidBody") + attribute("position", b.X_WB.p) +
             attribute("orientation", b.X_WB.q) + mass_attributes(light) + "/>");
        if (!b.weightless) heavy_.push_back(id);
        document_.lost(joint.where, "<joint> " + quoted(joint.name),
                       quoted(b.name) + " moves by several joints: between them is a body of " + model::format_real(light.mass) + " kg");
        return id;
    }

    void write_joint(const PlacedJoint& placed, const std::string& base, const std::string& held)
    {
        const Joint& j = placed.joint;
        JointText text = joint_text(placed, base, held, ids_);
        for (const std::string& component : text.lines) line(component);
        manager_ = manager_ || text.needs_manager;
        if (j.armature > 0 && j.kind == JointKind::Ball)
            document_.lost(j.where, "<joint> " + quoted(j.name), "armature of a ball joint is not carried over");
        places_[j.name] = {std::move(text.place), j.start};
    }

    std::optional<PlacedEnd> placed(const Cable& cable, const Cable::End& end) const
    {
        const auto at = assembly_.frames.find(end.body);
        if (at == assembly_.frames.end())
            return document_.error(cable.where, quoted(cable.name), "there is no body " + quoted(end.body)), std::nullopt;
        const PlacedBody& b = body(at->second.body);
        const Vec3 point = at->second.pose * end.point;
        if (b.fixed) return PlacedEnd{"", b.X_WB * point, b.X_WB * point};
        return PlacedEnd{body_ids_[at->second.body], point, b.X_WB * point};
    }

    void write_cable(const Cable& cable)
    {
        std::vector<PlacedPart> parts;
        for (const Cable::Part& part : cable.parts)
        {
            auto a = placed(cable, part.a), b = placed(cable, part.b);
            if (!a || !b) return;
            parts.push_back({std::move(*a), std::move(*b), part.divisor});
        }
        const CableText text = cable_text(cable, parts, ids_);
        for (const std::string& component : text.lines) line(component);
        manager_ = manager_ || text.needs_manager;
        if (!text.lost.empty()) document_.lost(cable.where, quoted(cable.name), text.lost);
        cables_[cable.name] = text.along;
    }

    void write_actuator_of_cable(Actuator a)
    {
        const auto& along = cables_[a.tendon];
        if (!along) return document_.lost(a.where, quoted(a.name), "is not carried over: its tendon is not between two points");
        a.gear *= along->ratio;
        line(actuator_text(a, along->place, along->start, ids_));
    }

    void write_actuator(const Actuator& a)
    {
        if (a.joint.empty()) return write_actuator_of_cable(a);
        const auto found = places_.find(a.joint);
        if (found == places_.end()) return document_.error(a.where, quoted(a.name), "there is no joint " + quoted(a.joint));
        if (found->second.text.empty())
            return document_.lost(a.where, quoted(a.name), "is not carried over: the ball joint " + quoted(a.joint) + " has no axis");
        const auto lost = [&](const std::string& coupling) { return lost_couplings_.contains(coupling); };
        if (std::ranges::any_of(a.relies_on, lost))
            return document_.lost(a.where, quoted(a.name), "is not carried over: the joints of its tendon do not follow one another here");
        line(actuator_text(a, found->second.text, found->second.start, ids_));
    }

    void write_gravity()
    {
        std::string on;
        for (const std::string& id : heavy_) on += (on.empty() ? "" : " ") + id;
        const bool all = std::ranges::none_of(assembly_.bodies, [](const PlacedBody& b) { return !b.fixed && b.weightless; });
        if (heavy_.empty()) return;
        line("<component id=\"gravity\" type=\"Field/Gravity\"" + attribute("between", all ? "*" : on) +
             attribute("acceleration", robot_.gravity) + "/>");
    }

    // ---- couplings

    void write_coupling(const Coupling& c)
    {
        if (c.kind == CouplingKind::Gear) return write_ratio(c);
        const auto first = assembly_.frames.find(c.first), second = assembly_.frames.find(c.second);
        const auto none = assembly_.frames.end();
        if (first == none || (second == none && !c.second.empty()))
            return document_.error(c.where, quoted(c.name), "there is no body " + quoted(first == none ? c.first : c.second));
        const Vec3 anchor = body(first->second.body).X_WB * (first->second.pose * c.anchor);
        std::size_t a = second == none ? kWorld : second->second.body, b = first->second.body;
        if (body(b).fixed && a != kWorld) std::swap(a, b);
        if (body(b).fixed || a == b)
            return document_.lost(c.where, quoted(c.name), "holds bodies that do not move relative to one another");
        if (c.kind == CouplingKind::Loop)
        {
            // The coordinate counts from the other body if that one is the base.
            const Vec3 axis = rotate(body(first->second.body).X_WB.q * first->second.pose.q, c.joint.axis);
            const PlacedJoint placed{c.joint, anchor, b == first->second.body ? axis : -axis};
            return ++out_.joints, write_joint(placed, base_of(a), body_ids_[b]);
        }
        line("<component" + attribute("id", ids_.make(c.name)) +
             attribute("type", c.kind == CouplingKind::Point ? "Constraint/Ball" : "Constraint/Fixed") + base_role(a) +
             attribute("b", body_ids_[b]) + attribute("anchor", anchor) + "/>");
    }

    void write_ratio(const Coupling& c)
    {
        const auto first = assembly_.moved.find(c.first), second = assembly_.moved.find(c.second);
        if (first == assembly_.moved.end() || second == assembly_.moved.end())
            return document_.error(c.where, quoted(c.name),
                                   "there is no joint " + quoted(first == assembly_.moved.end() ? c.first : c.second));
        const PlacedBody &driver = body(first->second), &driven = body(second->second);
        const auto is = [](const PlacedBody& b, JointKind kind) { return b.joints.size() == 1 && b.joints.front().joint.kind == kind; };
        const auto moves = [&](const PlacedBody& b) { return is(b, JointKind::Hinge) || is(b, JointKind::Slide); };
        const auto base = [&](const PlacedBody& b) { return b.parent == kWorld || body(b.parent).fixed ? kWorld : b.parent; };
        const bool beside = base(driver) == base(driven), in_chain = base(driven) == first->second;
        if (c.factor == 0 || !moves(driver) || !moves(driven) || (!beside && !in_chain))
        {
            lost_couplings_.insert(c.name);
            return document_.lost(c.where, quoted(c.name),
                                  "is not carried over: a Constraint/Coupler couples hinges and sliders that are the only joint of their "
                                  "bodies, on the same body or one after the other, with a factor that is not zero");
        }
        const std::string carrier = base(driver) == kWorld ? "" : attribute("carrier", body_ids_[base(driver)]);
        const std::string axes =
            attribute("driver_axis", driver.joints.front().axis_W) + attribute("driven_axis", driven.joints.front().axis_W) + "/>";
        const std::string sides = attribute("driver", body_ids_[first->second]) + attribute("driven", body_ids_[second->second]);
        const std::string start = "<component" + attribute("id", ids_.make(c.name));
        if (is(driver, JointKind::Hinge) && is(driven, JointKind::Hinge) && beside)
            return line(start + " type=\"Constraint/Gear\"" + sides + carrier + attribute("velocity_factor", c.factor) + axes);
        const auto along = [&](const std::string& name, const PlacedBody& b)
        { return is(b, JointKind::Slide) ? attribute(name, "slide") : std::string(); };
        line(start + " type=\"Constraint/Coupler\"" + sides + carrier + (in_chain ? " in_chain=\"true\"" : "") +
             along("driver_along", driver) + along("driven_along", driven) + attribute("factor", c.factor) + axes);
    }

    // ---- contacts

    static void add_id(std::string& list, const std::string& id) { list += (list.empty() ? "" : " ") + id; }

    std::string ids_of(const std::vector<CollisionMember>& members) const
    {
        std::string out;
        for (const CollisionMember& m : members)
            add_id(out, m.shape == CollisionMember::kAll ? body_ids_[m.body] : shape_ids_[m.body][m.shape]);
        return out;
    }

    void write_exclusion(const CollisionExclusion& e)
    {
        std::string roles;
        if (!e.within.empty()) roles += attribute("within", ids_of(e.within));
        if (!e.a.empty()) roles += attribute("a", ids_of(e.a)) + attribute("b", ids_of(e.b));
        line("<component" + attribute("id", ids_.make("apart")) + " type=\"Collision/Exclude\"" + roles + "/>");
    }

    /// What moves collides with all but what is excluded.
    void write_contacts()
    {
        std::string between, against;
        bool trees = false;
        std::size_t moving = 0;
        for (std::size_t i = 0; i < assembly_.bodies.size(); ++i)
        {
            const PlacedBody& b = body(i);
            if (!collides(b) || (b.fixed && !robot_.base_collides)) continue;
            add_id(b.fixed ? against : between, body_ids_[i]);
            moving += b.fixed ? 0 : 1, trees = trees || !b.joints.empty();
        }
        const bool excluded = exclusions_.size() == 1 && exclusions_.front().within.size() >= moving;
        if (moving == 0 || (against.empty() && (moving == 1 || excluded))) return;
        line("<component id=\"contact\" type=\"CDetection/ODE\"" + attribute("between", between) +
             (against.empty() ? "" : attribute("against", against)) + (trees ? attribute("resolution", "contact.resolution") : "") +
             attribute("response", "contact.response") + "/>");
        // A tree of joints moves as one: to go back for each of its impacts, one by one, costs more than all else.
        if (trees) line("<component id=\"contact.resolution\" type=\"Resolution/Speculative\"/>");
        const Surface& roughest = *surfaces_.rbegin();
        const SurfaceLaw law = law_of(roughest, roughest);
        line("<component id=\"contact.response\" type=\"Response/Automatic\" manager=\"manager\"" + attribute("friction", law.friction) +
             (law.restitution > 0 ? attribute("restitution", law.restitution) : "") + turning_attributes(law) + "/>");
        manager_ = true;
        write_surface_laws();
    }

    static std::string turning_attributes(const SurfaceLaw& law)
    {
        return (law.rolling_friction > 0 ? attribute("rolling_friction", law.rolling_friction) : "") +
               (law.spinning_friction > 0 ? attribute("spinning_friction", law.spinning_friction) : "");
    }

    void write_surface_laws()
    {
        if (surfaces_.size() < 2) return;
        std::size_t n = 0;
        for (auto a = surfaces_.begin(); a != surfaces_.end(); ++a)
            for (auto b = surfaces_.begin(); b != std::next(a); ++b)
            {
                const SurfaceLaw law = law_of(*a, *b);
                line("<component" + attribute("id", ids_.make("materials." + std::to_string(n++))) + " type=\"Material/Pair\"" +
                     attribute("a", material_of(*b)) + attribute("b", material_of(*a)) + attribute("friction", law.friction) +
                     attribute("restitution", law.restitution) + turning_attributes(law) + "/>");
            }
    }

    const Robot& robot_;
    const Assembly& assembly_;
    std::span<const CollisionExclusion> exclusions_;
    std::string group_;
    Document& document_;
    Ids ids_;
    std::vector<std::string> body_ids_;
    std::vector<std::vector<std::string>> shape_ids_;  ///< by body
    static constexpr std::size_t kMostPairLaws = 50;
    std::vector<Surface> surface_;                                     ///< of each body
    std::set<Surface> surfaces_;                                       ///< of bodies that collide
    std::map<std::pair<std::string, std::string>, double> pair_laws_;  ///< friction, by the ids of two bodies
    std::string text_;
    struct Place
    {
        std::string text;  ///< attributes
        double start = 0;
    };
    std::map<std::string, Place> places_;  ///< by joint
    std::map<std::string, std::optional<CableText::Along>> cables_;
    std::vector<std::string> heavy_;  ///< ids of the bodies that gravity acts on
    bool manager_ = false;
    std::set<std::string> lost_couplings_;
    WrittenScene out_;
};

}  // namespace

WrittenScene write_blueprint(const Robot& robot, const Assembly& assembly, std::span<const CollisionExclusion> exclusions,
                             const std::string& group, Document& document)
{
    return Writer(robot, assembly, exclusions, group, document).run();
}

}  // namespace plab::import
