// Contact points in the middle of the step (Problem::put_pivots_midway).
#include <algorithm>

#include "plab/pivot.h"
#include "problem.h"

namespace plab::managers
{
namespace
{

/// How far something turns in half a step.
enum class Turn : std::uint8_t
{
    Little,  ///< a body leaves its pivot by 2^-41 of the lever
    Some,
    Far,  ///< the middle of the step says little
};
Turn turn_of(const Vec3& w, double half)
{
    constexpr double kLittle = 0x1p-20, kFar = 0.05;  // rad
    const double turn = length(w) * half;
    if (!(turn > kLittle)) return Turn::Little;
    return turn < kFar ? Turn::Some : Turn::Far;
}

/// Whether the point that is fixed in the body is beside its centre of mass, and not only by rounding.
bool is_lever(const Vec3& fixed, const Vec3& r)
{
    constexpr double kRounding = 0x1p-20;
    return length_squared(fixed) > kRounding * kRounding * length_squared(r);
}

/// Whether a radius has turned by less than 0.05 rad.
bool is_near(const Vec3& arm, const Vec3& before) { return length_squared(arm - before) <= 0.05 * 0.05 * length_squared(before); }

/// How a body moves, and how many halves of a step its points have yet to go from where their velocity is taken: the levers of movers are
/// put midway, the velocity of other bodies is read where the step begins, and static bodies stay.
struct Movement
{
    Vec3 v, w;
    double parts = 0;
};
Movement movement_of(const Bodies& bodies, Ref body)
{
    const Motion motion = bodies.motion[body.index];
    if (motion == Motion::Static) return {};
    return {bodies.velocity[body.index], bodies.angular_velocity[body.index], motion == Motion::Kinematic ? 2.0 : 1.0};
}

void turn_axes(Point& p, const Quat& by)
{
    p.n = rotate(by, p.n), p.t1 = rotate(by, p.t1);
    p.t2 = cross(p.n, p.t1);
}

/// rad/s: how the spin w of a body without torque changes while it turns by w h. The momentum L stays, the inertia turns: L = I w.
Vec3 swing_of(const Bodies& bodies, std::uint32_t b, const Mat3& inverse_inertia, double h)
{
    constexpr double kLittle = 0x1p-40;  // of w: rounding
    constexpr double kMost = 0x1p-6;     // rad in half a step: beyond it a contact that begins to slip could give more than turning loses
    const Vec3& w = bodies.angular_velocity[b];
    if (turn_of(w, 0.5 * h) != Turn::Some || length(w) * 0.5 * h > kMost) return {};
    const Quat turned = exp_rotation(w * h);
    const Vec3 swings = rotate(turned, inverse_inertia * rotate_back(turned, bodies.angular_momentum[b])) - w;
    return length_squared(swings) > kLittle * kLittle * length_squared(w) ? swings : Vec3{};
}

}  // namespace

void Problem::put_pivots_midway(const Bodies& bodies, double h)
{
    bool any_swings = false;
    for (std::size_t i = 0; i < movers.size(); ++i)
    {
        Vec3& swings = anchors[i].swings;
        swings = anchors[i].shaft || movers[i].isotropic ? Vec3{} : swing_of(bodies, anchors[i].host, movers[i].inverse_inertia, h);
        any_swings = any_swings || swings != Vec3{};
    }
    // A body on more of its corners does not turn against what carries it, or its corners slide. If it stops, what they turn at its first
    // speed is no velocity of a rigid body, and they could not all stick.
    constexpr std::ptrdiff_t kOfEdge = 2;
    constexpr double kPresses = 0x1p-30;  // of the largest impulse of the pair: less is rounding
    for (std::size_t first = 0, end = 0; first < points.size(); first = end)
    {
        while (end < points.size() && contacts_[end].a == contacts_[first].a && contacts_[end].b == contacts_[first].b) ++end;
        const std::span<const Contact> pair = contacts_.subspan(first, end - first);
        double most = 0;
        for (const Contact& c : pair) most = std::max(most, length_squared(c.impulse));
        const auto presses = [&](const Contact& c) { return length_squared(c.impulse) > kPresses * kPresses * most; };
        const bool stands = std::ranges::count_if(pair, presses) > kOfEdge;
        for (std::size_t i = first; i < end; ++i)
        {
            Point& p = points[i];
            if (stands)
                carry_midway(p, contacts_[i], bodies, 0.5 * h);
            else if (contacts_[i].pivot.of != Pivot::Of::Neither)
                put_midway(p, contacts_[i], bodies, 0.5 * h);
            if (!any_swings) continue;
            Vec3 swings;  // m/s
            if (p.b != kNoIndex) swings += cross(anchors[p.b].swings, p.r_b);
            if (p.a != kNoIndex) swings -= cross(anchors[p.a].swings, p.r_a);
            if (swings != Vec3{}) p.turning += to_contact(p, swings);
        }
    }
}

/// `half`: s, half of the step.
void Problem::put_midway(Point& p, const Contact& c, const Bodies& bodies, double half) const
{
    const bool of_b = c.pivot.of == Pivot::Of::B, on_rim = c.pivot.kind == Pivot::Arm::OnRim;
    const Movement own = movement_of(bodies, of_b ? c.b : c.a), other = movement_of(bodies, of_b ? c.a : c.b);
    if (!p.mobile()) return;
    Vec3 &r = of_b ? p.r_b : p.r_a, &r_other = of_b ? p.r_a : p.r_b;
    const Vec3 fixed = r - c.pivot.arm;
    const Turn turn = on_rim || is_lever(fixed, r) ? turn_of(own.w, half) : Turn::Little, turn_of_face = turn_of(other.w, half);
    if (turn == Turn::Far || turn_of_face == Turn::Far || (turn == Turn::Little && turn_of_face == Turn::Little)) return;
    const double sign = of_b ? 1 : -1;  // of u
    const Quat turned = exp_rotation(own.w * half), turned_face = exp_rotation(other.w * half);
    const Vec3 arm = turned_arm(c.pivot, p.n * -sign, turned, turned_face);
    if (!is_near(arm, c.pivot.arm)) return;

    const Vec3 slides = own.v + cross(own.w, r) - other.v - cross(other.w, r_other);
    const Vec3 around = cross(own.w, fixed) + (arm - c.pivot.arm) / half;  // m/s of the point, about the centre of mass
    const Vec3 passing = own.v + around - other.v;
    const Vec3 turning = own.parts * cross(own.w, around) - other.parts * cross(other.w, passing);
    r = rotate(turned, fixed) + arm, r_other += passing * half;
    const double tilting = dot(cross(other.w, p.n), slides);
    if (turn_of_face == Turn::Some) turn_axes(p, turned_face);
    p.turning = to_contact(p, turning * (sign * half));
    p.turning.z += sign * half * tilting;
    set_mobility(p);
}

/// The same for a body that stands on another one: it is taken to move without turning, so all of its points can stick. Which of two
/// bodies counts as standing is the same for all points of the pair: with the pivots of each, a wall that was hit did not come to rest.
void Problem::carry_midway(Point& p, const Contact& c, const Bodies& bodies, double half) const
{
    const bool b_stands = bodies.dynamic(c.b.index);
    const Movement own = movement_of(bodies, b_stands ? c.b : c.a), other = movement_of(bodies, b_stands ? c.a : c.b);
    if (!p.mobile() || turn_of(other.w, half) != Turn::Some) return;
    const Vec3 passing = own.v - other.v;
    (b_stands ? p.r_a : p.r_b) += passing * half;
    p.turning = to_contact(p, cross(other.w, passing) * (other.parts * half * (b_stands ? -1 : 1)));
    set_mobility(p);
}

}  // namespace plab::managers
