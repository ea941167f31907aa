// Contact points in the middle of the step (Problem::put_pivots_midway).
#include <algorithm>

#include "plab/free_rotation.h"
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
    constexpr double kLittle = 0x1p-20;  // rad
    const double turn = length(w) * half;
    if (!(turn > kLittle)) return Turn::Little;
    return turn < kFarthestTurn ? Turn::Some : Turn::Far;
}

/// Whether the point that is fixed in the body is beside its centre of mass, and not only by rounding.
bool is_lever(const Vec3& fixed, const Vec3& r)
{
    constexpr double kRounding = 0x1p-20;
    return length_squared(fixed) > kRounding * kRounding * length_squared(r);
}

/// Whether a radius or a lever has turned by no more than kFarthestTurn.
bool is_near(const Vec3& arm, const Vec3& before)
{
    return length_squared(arm - before) <= kFarthestTurn * kFarthestTurn * length_squared(before);
}

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

/// rad/s: of the normal n, from the wall to the body, as a point moves along the wall at v.
Vec3 turn_of_normal(const Hollow& hollow, const Vec3& n, const Vec3& v)
{
    const Vec3 bend = hollow.vector(), about = cross(v, n);
    const double curvature = length(bend);
    return is_sphere(bend, n) ? about * curvature : bend * (dot(bend, about) / curvature);
}

void turn_axes(Point& p, const Quat& by)
{
    p.n = rotate(by, p.n), p.t1 = rotate(by, p.t1);
    p.t2 = cross(p.n, p.t1);
}

/// How a body turns within half of h (s) and all of it without torques, in W. Its spin at the start says too little: that of a slender
/// body about its axis turns with it.
std::pair<Quat, Quat> free_turns(const Bodies& bodies, std::uint32_t b, double h)
{
    constexpr double kSeries = 0.05;  // rad
    const Quat& start = bodies.orientation[b];
    const Mat3& inverse_B = bodies.inverse_inertia_B[b];
    const Vec3 momentum_B = rotate_back(start, bodies.angular_momentum[b]);
    const auto in_W = [&](const Quat& turn_B) { return start * turn_B * conjugate(start); };
    if (length(momentum_B) * h * (inverse_B(0, 0) + inverse_B(1, 1) + inverse_B(2, 2)) < kSeries)
        return {in_W(slow_turn(inverse_B, momentum_B, 0.5 * h)), in_W(slow_turn(inverse_B, momentum_B, h))};
    const PrincipalAxes axes = principal_axes({start, bodies.inertia_B[b], inverse_B, bodies.mass[b], bodies.needle[b] != 0});
    const FreeTop top(axes, transposed_times(axes.axes, momentum_B));
    const auto to_B = [&](const Quat& turn)
    {
        const Vec3 axis = axes.axes * Vec3{turn.x, turn.y, turn.z};
        return Quat{turn.w, axis.x, axis.y, axis.z};
    };
    return {in_W(to_B(top.turn(0.5 * h))), in_W(to_B(top.turn(h)))};
}

/// Whether R A R^T differs from A by more than a share of its largest entry.
bool changes_by_more(const Mat3& A, const Quat& turn, double share)
{
    const Mat3 R = rotation_matrix(turn), turned = R * A * transposed(R);
    double largest = 0, change = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = i; j < 3; ++j)
            largest = std::max(largest, std::fabs(A(i, j))), change = std::max(change, std::fabs(turned(i, j) - A(i, j)));
    return change > share * largest;
}

}  // namespace

/// A slender body that turned about the middle of its axis with the inertia of the start would be given spin about the axis itself. Free
/// rotation turns the inertia, while the momentum L stays: L = I w.
void Problem::put_inertia_midway(std::size_t i, const Bodies& bodies, double h)
{
    constexpr double kLittle = 0x1p-40;  // of w: rounding
    // Of its size, what the inertia may change in half a step: as far as levers may turn, or those of joints (HeldMotion::put_rows_midway).
    // What spins about its own axis keeps its inertia, however fast.
    constexpr double kMostWithRows = 0x1p-6;
    const double most = has_rows() ? kMostWithRows : kFarthestTurn;
    Mover& m = movers[i];
    Anchor& anchor = anchors[i];
    const std::uint32_t b = anchor.host;
    anchor.swings = {};
    if (anchor.shaft || m.isotropic) return;
    const Vec3 &w = bodies.angular_velocity[b], &momentum = bodies.angular_momentum[b];
    if (turn_of(w, 0.5 * h) == Turn::Little) return;
    const auto [half_turn, turn] = free_turns(bodies, b, h);
    if (length(w) * 0.5 * h > most && changes_by_more(m.inverse_inertia, half_turn, most)) return;
    const Vec3 at_end = rotate(turn, m.inverse_inertia * rotate_back(turn, momentum));
    anchor.midway = true, anchor.half_turn = half_turn;
    turn_inertia(i, half_turn);
    const Vec3 swings = at_end - m.inverse_inertia * momentum;
    if (length_squared(swings) > kLittle * kLittle * length_squared(w)) anchor.swings = swings;
}

void Problem::put_pivots_midway(const Bodies& bodies, double h)
{
    for (std::size_t i = 0; i < movers.size(); ++i) put_inertia_midway(i, bodies, h);
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
            // In a bowl a body turns as it slides, whatever it stands on.
            if (stands && contacts_[i].pivot.hollow.is_flat())
                carry_midway(p, contacts_[i], bodies, 0.5 * h);
            else if (contacts_[i].pivot.of != Pivot::Of::Neither)
                put_midway(p, contacts_[i], bodies, 0.5 * h);
            take_midway_inertias(p);
        }
    }
}

Quat Problem::half_turn_of(std::uint32_t mover, const Vec3& w, double half) const
{
    return mover != kNoIndex && anchors[mover].midway ? anchors[mover].half_turn : exp_rotation(w * half);
}

/// The mobility of a point whose bodies have the inertias of the middle of the step, and what free rotation adds to u by the end.
void Problem::take_midway_inertias(Point& p) const
{
    const bool is_midway = (p.a != kNoIndex && anchors[p.a].midway) || (p.b != kNoIndex && anchors[p.b].midway);
    if (!is_midway) return;
    Vec3 swings;  // m/s
    if (p.b != kNoIndex) swings += cross(anchors[p.b].swings, p.r_b);
    if (p.a != kNoIndex) swings -= cross(anchors[p.a].swings, p.r_a);
    if (swings != Vec3{}) p.turning += to_contact(p, swings);
    set_mobility(p);
}

void Problem::put_lines_midway(double h)
{
    turn_lines();
    for (Line& line : lines)
    {
        const ConstraintRow& row = row_of(line);
        // The rate of a servo follows the state: that of the middle is safer than one that is extrapolated to the end.
        if (row.kind == RowKind::Rate || row.kind == RowKind::ForceChange) continue;
        line.turning = -0.5 * h * row.bias;
        for (std::uint32_t k = 0; k < line.count; ++k) line.turning += dot(line.angular[k], anchors[line.mover[k]].swings);
    }
}

void Problem::forget_turning()
{
    for (Point& p : points) p.turning = {};
    for (Line& line : lines) line.turning = 0;
}

/// `half`: s, half of the step.
void Problem::put_midway(Point& p, const Contact& c, const Bodies& bodies, double half) const
{
    const bool of_b = c.pivot.of == Pivot::Of::B, on_rim = c.pivot.kind == Pivot::Arm::OnRim;
    const Movement own = movement_of(bodies, of_b ? c.b : c.a), other = movement_of(bodies, of_b ? c.a : c.b);
    if (!p.mobile()) return;
    Vec3 &r = of_b ? p.r_b : p.r_a, &r_other = of_b ? p.r_a : p.r_b;
    const Vec3 fixed = r - c.pivot.arm;
    const bool on_lever = is_lever(fixed, r);
    const double sign = of_b ? 1 : -1;  // of u
    // How the normal turns: with the face, and as the fixed point moves along a hollow one.
    Vec3 bends;
    if (!c.pivot.hollow.is_flat())
    {
        const Vec3 along = own.v + cross(own.w, fixed) - other.v - cross(other.w, r_other - c.pivot.arm);
        bends = turn_of_normal(c.pivot.hollow, p.n * sign, along);
    }
    const Vec3 normal_w = other.w + bends;
    const Turn turn = on_rim || on_lever ? turn_of(own.w, half) : Turn::Little, turn_of_face = turn_of(normal_w, half);
    if (turn_of_face == Turn::Far || (turn == Turn::Little && turn_of_face == Turn::Little)) return;
    const std::uint32_t mover = of_b ? p.b : p.a;
    // What tumbles so far has another axis by then.
    const bool tumbles = mover != kNoIndex && !anchors[mover].midway && !movers[mover].isotropic;
    if (turn == Turn::Far && tumbles) return;
    const Quat turned = half_turn_of(mover, own.w, half);
    Quat turned_face = half_turn_of(of_b ? p.a : p.b, other.w, half);
    if (!c.pivot.hollow.is_flat()) turned_face = exp_rotation(bends * half) * turned_face;
    const Vec3 arm = turned_arm(c.pivot, p.n * -sign, turned, turned_face);
    // What spins about its own axis, as a capsule or a coin that rolls, takes its lever along, however fast.
    if (!is_near(arm, c.pivot.arm) || (on_lever && !is_near(rotate(turned, fixed), fixed))) return;

    const Vec3 slides = own.v + cross(own.w, r) - other.v - cross(other.w, r_other);
    const Vec3 around = cross(own.w, fixed) + (arm - c.pivot.arm) / half;  // m/s of the point, about the centre of mass
    const Vec3 passing = own.v + around - other.v;
    const Vec3 turning = own.parts * cross(own.w, around) - other.parts * cross(other.w, passing);
    r = rotate(turned, fixed) + arm, r_other += passing * half;
    const double tilting = dot(cross(normal_w, p.n), slides);
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
