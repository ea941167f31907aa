// What resists that bodies roll on one another and spin about their normal (plab::RollingResistance).
#include <algorithm>

#include "plab/rotation.h"
#include "problem.h"

namespace plab::managers
{
namespace
{

/// The middle of the points of a pair that press, or of all of them if none does.
struct Middle
{
    /// `gap`: m, of points that count as touching.
    Middle(std::span<const Contact> pair, double gap) : contact(pair.front())
    {
        const auto presses = [gap](const Contact& c) { return c.depth >= -gap || c.impulse != Vec3{}; };
        const bool all = std::ranges::none_of(pair, presses);
        Vec3 point, normal, impulse, first;
        for (const Contact& c : pair)
        {
            if (!all && !presses(c)) continue;
            if (points++ == 0) first = c.point;
            point += c.point, normal += c.normal, impulse += c.impulse, extent = c.point - first;
        }
        contact.point = point * (1.0 / points), contact.impulse = impulse;
        if (const double size = length(normal); size > 0) contact.normal = normal * (1 / size);
    }

    Contact contact;  ///< with the mean normal and the sum of impulses
    int points = 0;
    Vec3 extent;  ///< m, from the first to the last of them
};

Vec3 spin_of(const Bodies& bodies, Ref body)
{
    return bodies.motion[body.index] == Motion::Static ? Vec3{} : bodies.angular_velocity[body.index];
}
Vec3 velocity_of(const Bodies& bodies, Ref body, const Vec3& point)
{
    return bodies.motion[body.index] == Motion::Static ? Vec3{} : bodies.velocity_at(body.index, point);
}

}  // namespace

const ConstraintRow Problem::kNoRate{.kind = RowKind::Rate};

/// One point can spin and roll in all directions. Two points of a line or an edge roll about it alone, and more of a face not at all: what
/// else they could do is held by the friction and the normal impulses of the points, and how these and a couple shared the load would be
/// undetermined. Points that are apart do not count, unless all are.
void Problem::add_resistances(const Island& island, const Bodies& bodies)
{
    const double near = 0x1p-20 * island.size;
    make_room(lines, lines.size() + 3 * island.resistances.size()), make_room(rollers_, island.resistances.size());
    rollers_.clear();
    for (const RollingResistance& pair : island.resistances)
    {
        const std::span<const Contact> contacts = contacts_.subspan(pair.first, pair.end - pair.first);
        const Middle middle(contacts, near);
        const Vec3 &n = middle.contact.normal, edge = middle.extent - n * dot(n, middle.extent);
        const bool is_point = middle.points == 1 || (middle.points == 2 && length(edge) <= near);
        if (is_point || middle.contact.friction == 0) add_resistance(pair, n, pair.spinning);
        if (!is_point && middle.points == 2) add_resistance(pair, normalized(edge), pair.rolling);
        const Vec3 axis = any_perpendicular(n);
        if (is_point && add_resistance(pair, axis, pair.rolling) && add_resistance(pair, cross(n, axis), pair.rolling))
            add_roller(pair, middle.contact, bodies);
    }
}

/// False if nothing is resisted, or nothing that is may turn.
bool Problem::add_resistance(const RollingResistance& pair, const Vec3& axis, double lever)
{
    const Contact& c = contacts_[pair.first];
    Line line;
    line.row = kNoIndex, line.lever = lever;
    line.first_point = pair.first, line.end_point = pair.end;
    for (const Ref body : {c.a, c.b})
        if (const std::uint32_t mover = mover_of(body); mover != kNoIndex) line.mover[line.count++] = mover;
    line.a_moves = mover_of(c.a) != kNoIndex;
    turn_resistance(line, axis);
    if (!(lever > 0 && line.mobility > 0)) return false;
    lines.push_back(line);
    return true;
}

void Problem::turn_resistance(Line& line, const Vec3& axis)
{
    for (std::uint32_t k = 0; k < line.count; ++k) line.angular[k] = k == 0 && line.a_moves ? -axis : axis;
    set_mobility(line);
}

void Problem::add_roller(const RollingResistance& pair, const Contact& middle, const Bodies& bodies)
{
    Roller& roller = rollers_.emplace_back();
    set_point(roller.at, middle, bodies);
    roller.pressed = roller.at.impulse.z, roller.lever = pair.rolling;
    roller.first = static_cast<std::uint32_t>(lines.size() - 2);
    Vec3 given;
    if (roller.at.b == kNoIndex) given += velocity_of(bodies, middle.b, middle.point), roller.given_spin += spin_of(bodies, middle.b);
    roller.a = middle.a, roller.b = middle.b;
    if (roller.at.a == kNoIndex) given -= velocity_of(bodies, middle.a, middle.point), roller.given_spin -= spin_of(bodies, middle.a);
    roller.at.given = to_contact(roller.at, given);
}

void Problem::note_rolling(const Bodies& bodies)
{
    for (Roller& roller : rollers_)
    {
        const Vec3 spin = spin_of(bodies, roller.b) - spin_of(bodies, roller.a);
        roller.rolled = spin - roller.at.n * dot(roller.at.n, spin);
    }
}

/// rad/s: how b would spin relative to a, along the surface, if the point stuck as far as friction holds it and nothing resisted. `share`:
/// of the step, that is to be made; `load` becomes the normal impulse that goes with it, N s, or that of the last step, if it was larger.
Vec3 Problem::rolling_without(const Roller& roller, double share, double& load) const
{
    const Point& p = roller.at;
    Vec3 u, w = roller.given_spin;
    if (p.b != kNoIndex) u += anchors[p.b].v + cross(anchors[p.b].w, p.r_b), w += anchors[p.b].w;
    if (p.a != kNoIndex) u -= anchors[p.a].v + cross(anchors[p.a].w, p.r_a), w -= anchors[p.a].w;
    Vec3 j = inverse(p.K) * (to_contact(p, u) + p.given) * -1.0;
    load = std::max(share * roller.pressed, j.z);
    j.z = std::max(0.0, j.z);
    const Vec3 j_W = to_world(p, within_disc(j, p.friction * load));
    if (p.b != kNoIndex) w += movers[p.b].inverse_inertia * cross(p.r_b, j_W);
    if (p.a != kNoIndex) w += movers[p.a].inverse_inertia * cross(p.r_a, j_W);
    return w - p.n * dot(p.n, w);
}

/// The couple opposes the rolling that there will be, whichever way forces turn it within the step, so that is one of its two axes. What
/// surely rolls on is not held about the other one: where other contacts turn its path otherwise, it may follow.
void Problem::aim_resistances(double share)
{
    constexpr double kSurely = 2;  // the load may be another one
    for (Roller& roller : rollers_)
    {
        Point& p = roller.at;
        set_mobility(p);
        double load = 0;
        const Vec3 rolls = rolling_without(roller, share, load);
        const double speed = length(rolls);
        if (!(speed > 0)) continue;
        // Over the step the couple turns with the rolling: that of the middle makes it right to second order.
        const Vec3 middle = rolls + roller.rolled;
        const bool turns_back = !(length(middle) > speed);
        Line &along = lines[roller.first], &across = lines[roller.first + 1];
        const auto couple = [](const Line& line) { return line.angular[line.count - 1] * line.impulse; };
        const Vec3 before = couple(along) + couple(across), axis = turns_back ? rolls * (1 / speed) : normalized(middle),
                   other = cross(p.n, axis);
        const bool a_alone = along.a_moves && along.count == 1;
        turn_resistance(along, axis), turn_resistance(across, other);
        along.given = dot(axis, roller.given_spin), across.given = dot(other, roller.given_spin);
        along.impulse = dot(before, axis) * (a_alone ? -1 : 1), across.impulse = dot(before, other) * (a_alone ? -1 : 1);
        across.lever = speed > kSurely * roller.lever * load * along.mobility ? 0.0 : roller.lever;
    }
}

double Problem::given_of_resistance(const Line& line, const Bodies& bodies) const
{
    const Contact& c = contacts_[line.first_point];
    const bool a_alone = line.a_moves && line.count == 1;
    const Vec3 axis = line.angular[line.count - 1] * (a_alone ? -1.0 : 1.0);
    double given = 0;
    if (line.count == 1) given = a_alone ? dot(axis, spin_of(bodies, c.b)) : -dot(axis, spin_of(bodies, c.a));
    return given;
}

}  // namespace plab::managers
