// What resists that bodies roll on one another and spin about their normal (plab::RollingResistance).
#include "plab/rotation.h"
#include "problem.h"

namespace plab::managers
{
namespace
{

/// The middle of the points of a pair, with the mean normal.
Contact middle_of(std::span<const Contact> pair)
{
    Contact out = pair.front();
    out.point = out.normal = out.impulse = {};
    for (const Contact& c : pair) out.point += c.point, out.normal += c.normal, out.impulse += c.impulse;
    out.point *= 1.0 / static_cast<double>(pair.size());
    const double size = length(out.normal);
    out.normal = size > 0 ? out.normal * (1 / size) : pair.front().normal;
    return out;
}

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
/// undetermined.
void Problem::add_resistances(const Island& island, const Bodies& bodies)
{
    rollers_.clear();
    for (const RollingResistance& pair : island.resistances)
    {
        const std::span<const Contact> contacts = contacts_.subspan(pair.first, pair.end - pair.first);
        const Contact middle = middle_of(contacts);
        const Vec3& n = middle.normal;
        if (contacts.size() == 1 || middle.friction == 0) add_resistance(pair, n, pair.spinning);
        if (contacts.size() == 2)
        {
            const Vec3 along = contacts[1].point - contacts[0].point, edge = along - n * dot(n, along);
            add_resistance(pair, edge == Vec3{} ? any_perpendicular(n) : normalized(edge), pair.rolling);
        }
        const Vec3 axis = any_perpendicular(n);
        if (contacts.size() > 1 || !add_resistance(pair, axis, pair.rolling)) continue;
        add_resistance(pair, cross(n, axis), pair.rolling);
        add_roller(pair, middle, bodies);
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
    const Vec3 spin = spin_of(bodies, middle.b) - spin_of(bodies, middle.a);
    roller.rolled = spin - middle.normal * dot(middle.normal, spin);
    if (roller.at.a == kNoIndex) given -= velocity_of(bodies, middle.a, middle.point), roller.given_spin -= spin_of(bodies, middle.a);
    roller.at.given = to_contact(roller.at, given);
}

/// rad/s: how b would spin relative to a, along the surface, if the point stuck as far as friction holds it and nothing resisted. `load`
/// becomes the normal impulse that goes with it, N s, or that of the last step, if it was larger.
Vec3 Problem::rolling_without(const Roller& roller, double& load) const
{
    const Point& p = roller.at;
    Vec3 u, w = roller.given_spin;
    if (p.b != kNoIndex) u += anchors[p.b].v + cross(anchors[p.b].w, p.r_b), w += anchors[p.b].w;
    if (p.a != kNoIndex) u -= anchors[p.a].v + cross(anchors[p.a].w, p.r_a), w -= anchors[p.a].w;
    Vec3 j = inverse(p.K) * (to_contact(p, u) + p.given) * -1.0;
    load = std::max(roller.pressed, j.z);
    j.z = std::max(0.0, j.z);
    const Vec3 j_W = to_world(p, within_disc(j, p.friction * load));
    if (p.b != kNoIndex) w += movers[p.b].inverse_inertia * cross(p.r_b, j_W);
    if (p.a != kNoIndex) w += movers[p.a].inverse_inertia * cross(p.r_a, j_W);
    return w - p.n * dot(p.n, w);
}

/// The couple opposes the rolling that there will be, whichever way forces turn it within the step, so that is one of its two axes. What
/// surely rolls on is not held about the other one: where other contacts turn its path otherwise, it may follow.
void Problem::aim_resistances()
{
    constexpr double kSurely = 2;  // the load may be another one
    for (Roller& roller : rollers_)
    {
        Point& p = roller.at;
        set_mobility(p);
        double load = 0;
        const Vec3 rolls = rolling_without(roller, load);
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
