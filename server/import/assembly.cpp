#include "import/assembly.h"

#include "objects/shapes/volume_integration.h"

namespace plab::import
{
namespace
{

/// X_BB' of a joint that has moved from `zero` to `start`; the axis stays where it is.
Pose displacement(const Joint& joint)
{
    const double q = joint.start - joint.zero;
    if (q == 0 || joint.kind == JointKind::Ball) return {};
    if (joint.kind == JointKind::Slide) return {joint.axis * q, {}};
    const Quat turn = rotation_about(joint.axis, q);
    return {joint.anchor - rotate(turn, joint.anchor), turn};
}

MassProperties sum(const MassProperties& a, const MassProperties& b)
{
    if (a.mass == 0) return b;
    if (b.mass == 0) return a;
    const MassProperties both[] = {a, b};
    return shapes::joined(both);
}

class Assembler
{
public:
    Assembler(const Robot& robot, Document& document) : robot_(robot), document_(document) {}

    Assembly run()
    {
        for (std::size_t i = 0; i < robot_.bodies.size(); ++i) add(robot_.bodies[i]);
        for (std::size_t i = 0; i < out_.bodies.size(); ++i) settle(i);
        return std::move(out_);
    }

private:
    void add(const RobotBody& body)
    {
        const bool hangs = body.parent != kWorld;
        const Assembly::Frame parent = hangs ? frames_[body.parent] : Assembly::Frame{kWorld, {}};
        const Pose in_parent = parent.pose * body.pose;
        const bool welded = hangs && !body.free && body.joints.empty();
        const Assembly::Frame frame = welded ? Assembly::Frame{parent.body, in_parent} : Assembly::Frame{out_.bodies.size(), {}};
        frames_.push_back(frame);
        out_.frames[body.name] = frame;
        if (!welded) start_body(body, parent, in_parent);
        PlacedBody& target = out_.bodies[frame.body];
        if (body.mass.mass > 0 && target.mass.mass > 0 && body.weightless != target.weightless)
            document_.lost(body.where, "'" + body.name + "'",
                           "is fixed to '" + target.name + "', of which gravity acts on a part only: here on all of it");
        if (body.mass.mass > 0 && !body.weightless) target.weightless = false;
        target.self_collide = target.self_collide || body.self_collide;
        target.mass = sum(target.mass, body.mass.mass > 0 ? shapes::posed(body.mass, frame.pose) : MassProperties{});
        for (RobotShape shape : body.shapes)
        {
            shape.pose = frame.pose * shape.pose, shape.owner = body.name;
            target.shapes.push_back(std::move(shape));
        }
    }

    void start_body(const RobotBody& body, const Assembly::Frame& parent, const Pose& in_parent)
    {
        PlacedBody placed;
        placed.name = body.name, placed.where = body.where;
        placed.self_collide = body.self_collide, placed.model = body.model;
        placed.parent = body.free ? kWorld : parent.body;
        placed.fixed = !body.free && body.joints.empty();
        placed.X_WB = parent.body == kWorld ? in_parent : out_.bodies[parent.body].X_WB * in_parent;
        for (const Joint& joint : body.joints)
        {
            placed.X_WB = placed.X_WB * displacement(joint);
            placed.X_WB.q = normalized(placed.X_WB.q);
            placed.joints.push_back({joint, placed.X_WB * joint.anchor, rotate(placed.X_WB.q, joint.axis)});
            out_.moved[joint.name] = out_.bodies.size();
        }
        out_.bodies.push_back(std::move(placed));
    }

    /// Once its mass is known: what has none cannot move. Parents are settled first.
    void settle(std::size_t i)
    {
        PlacedBody& body = out_.bodies[i];
        if (!body.fixed && body.mass.mass == 0)
        {
            if (body.joints.empty())
            {
                body.fixed = true;
                document_.lost(body.where, "'" + body.name + "'", "has no mass, so it does not move: it is fixed to the world");
            }
            else
                document_.error(body.where, "'" + body.name + "'",
                                "has no mass, but the joint '" + body.joints.front().joint.name + "' moves it: give it an inertia");
        }
        const bool hangs = body.parent != kWorld && !out_.bodies[body.parent].fixed;
        body.tree = hangs ? out_.bodies[body.parent].tree : i;
    }

    const Robot& robot_;
    Document& document_;
    Assembly out_;
    std::vector<Assembly::Frame> frames_;
};

}  // namespace

Assembly assemble(const Robot& robot, Document& document) { return Assembler(robot, document).run(); }

}  // namespace plab::import
