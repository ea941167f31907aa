// Pendulums: a shaft with the moment of its weight, and a body that hangs on a hinge or a ball.
#include <cmath>

#include "exact/facts.h"
#include "exact/motions.h"
#include "model/numbers.h"
#include "plab/rotation.h"

namespace plab::exact
{
namespace
{

std::string words_of(const PendulumMotion& motion)
{
    return "closed form of the pendulum: sqrt(w/J) = " + model::format_real(motion.frequency()) +
           " rad/s, k^2 = " + model::format_real(motion.k2());
}

class ShaftPendulum final : public Solution
{
public:
    ShaftPendulum(std::string id, const PendulumMotion& motion) : id_(std::move(id)), motion_(motion) {}
    bool state(const std::string& id, double t, State& out) const override
    {
        if (id != id_) return false;
        motion_.at(t, out.angle, out.speed);
        return true;
    }
    double precision(double until) const override { return precision_after(motion_.fastest() * until); }
    std::string words() const override { return words_of(motion_); }

private:
    std::string id_;
    PendulumMotion motion_;
};

/// A body that turns about the axis n through a fixed point.
class Hung final : public Solution
{
public:
    Hung(std::string id, const State& start, const Vec3& pivot, const Vec3& n, double theta, const PendulumMotion& motion)
        : id_(std::move(id)), start_(start), pivot_(pivot), n_(n), theta_(theta), motion_(motion)
    {
    }
    bool state(const std::string& id, double t, State& out) const override
    {
        if (id != id_) return false;
        double theta = 0, speed = 0;
        motion_.at(t, theta, speed);
        const Quat turn = exp_rotation(n_ * (theta - theta_));
        const Vec3 lever = rotate(turn, start_.position - pivot_);
        out = start_;
        out.position = pivot_ + lever, out.orientation = turn * start_.orientation;
        out.angular_velocity = n_ * speed, out.velocity = cross(out.angular_velocity, lever);
        return true;
    }
    double precision(double until) const override { return precision_after(motion_.fastest() * until); }
    std::string words() const override { return words_of(motion_); }

private:
    std::string id_;
    State start_;
    Vec3 pivot_, n_;
    double theta_;
    PendulumMotion motion_;
};

/// A unit vector across both; across the first where they are parallel.
Vec3 across(const Vec3& a, const Vec3& b)
{
    Vec3 n = cross(a, b);
    if (length(n) <= 1e-12 * length(a) * length(b)) n = cross(a, std::fabs(a.x) < 0.7 * length(a) ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
    return n / length(n);
}

Result<std::unique_ptr<Solution>> make_hung(const SceneFacts& facts, std::uint32_t object)
{
    const std::string id = facts.world().id_of(object);
    const std::vector<std::uint32_t> hinges = facts.of_type("Constraint/Hinge"), balls = facts.of_type("Constraint/Ball");
    if (hinges.size() + balls.size() != 1)
        return reason(id + " is not attached to a joint of its own: one Constraint/Hinge or one Constraint/Ball");
    const bool on_hinge = !hinges.empty();
    const std::uint32_t joint = on_hinge ? hinges.front() : balls.front();
    if (const auto other = facts.foreign_force({"Field/Gravity", "Constraint/Hinge", "Constraint/Ball"}); !other.empty())
        return reason(other + " acts too; only Field/Gravity and the joint may");
    const std::uint32_t row = facts.world().component(object).host_index;
    const Bodies& bodies = facts.bodies();
    const State start = present(facts, object);
    const Vec3 pivot = start.position + rotate(start.orientation, vector_of(facts, joint, "point_b") - bodies.center_B[row]);
    const Vec3 lever = start.position - pivot, g = facts.gravity(), w = start.angular_velocity;
    const Value frame = facts.world().get(joint, "frame_b");
    Vec3 n = length(w) > 0 ? w / length(w) : across(g, lever);
    if (on_hinge) n = rotate(start.orientation * std::get<Quat>(frame), Vec3{0, 0, 1});
    const Vec3 r = lever - n * dot(n, lever), down = g - n * dot(n, g);
    if (!(length(r) > 0) || !(length(down) > 0)) return reason("its weight has no moment about the joint");
    const Vec3 Ln = rotate(start.orientation, bodies.inertia_B[row] * rotate(conjugate(start.orientation), n));
    const bool plane = std::fabs(dot(n, lever)) < 1e-12 * length(lever) && std::fabs(dot(n, g)) < 1e-12 * length(g) &&
                       length(cross(Ln, n)) < 1e-12 * length(Ln);
    if (!on_hinge && !plane) return reason("on its ball joint it does not stay in a plane: turn it about a level principal axis only");
    if (length(cross(w, n)) > 1e-12 * length(w)) return reason("it turns about another axis than the hinge's");
    if (length(start.velocity - cross(w, lever)) > 1e-9 * (length(w) * length(lever) + 1e-3))
        return reason("its velocity is not a rotation about the joint");
    const double J = dot(n, Ln) + bodies.mass[row] * length_squared(r), moment = bodies.mass[row] * length(r) * length(down);
    const double theta = std::atan2(dot(n, cross(down, r)), dot(down, r));
    return std::unique_ptr<Solution>(
        std::make_unique<Hung>(id, start, pivot, n, theta, PendulumMotion(std::sqrt(moment / J), theta, dot(n, w))));
}

}  // namespace

Result<std::unique_ptr<Solution>> make_pendulum(const SceneFacts& facts, double)
{
    const auto object = only_object(facts);
    if (!object) return object.errors();
    const world::Component& c = facts.world().component(*object);
    if (c.facet == Facet::Body) return make_hung(facts, *object);
    const auto w = facts.number("weight_moment");
    if (!w || !(*w > 0)) return missing_number("weight_moment", "m g l, N m, positive");
    const double inertia = facts.shafts().inertia[c.host_index];
    return std::unique_ptr<Solution>(std::make_unique<ShaftPendulum>(
        c.id, PendulumMotion(std::sqrt(*w / inertia), facts.shafts().angle[c.host_index], facts.shafts().speed[c.host_index])));
}

}  // namespace plab::exact
