#include "grab/grab.h"

#include <algorithm>
#include <numbers>

#include "plab/point_distance.h"
#include "plab/rotation.h"

namespace plab::constraints
{

void GrabRows::describe(Schema& s)
{
    s.role(user, "user", {Facet::Body}, "the hand; its grip is that of a State/User");
    s.role(body, "body", {Facet::Body}, "bodies that it may hold, one at a time").writes().independent();
    s.state(hold, "hold", unit::one, "id of a body to hold, whatever the grip is; empty: none").input();
    s.param(frequency, "frequency", unit::one, "w / 2 pi of the spring, Hz").or_else(8).positive();
    s.param(damping_ratio, "damping_ratio", unit::one, "zeta; 1: critically damped").or_else(1).not_negative();
    s.param(stiffness, "stiffness", unit::one, "k, N/m, instead of the frequency; 0: not given").or_else(0).not_negative();
    s.param(max_force, "max_force", unit::newton, "largest force").or_else(500).not_negative();
    s.param(max_torque, "max_torque", unit::newton_metre, "largest torque").or_else(50).not_negative();
    s.param(reach, "reach", unit::metre, "from the hand's origin to the surface of a body that it does not touch")
        .or_else(0)
        .not_negative();
    s.param(close_at, "close_at", unit::one, "grip at which it closes").or_else(0.6).at_least(0).at_most(1);
    s.param(open_at, "open_at", unit::one, "grip at which it opens").or_else(0.4).at_least(0).at_most(1);
    s.state(held, "held", unit::one, "id of the body that it holds");
    s.state(touched, "touched", unit::one, "id of the body that the hand touches");
    s.state(closed, "closed", unit::one, "whether the hand is closed");
    s.state(point, "point", unit::metre, "by which it holds the body, from its centre of mass, in its axes");
    s.state(attitude, "attitude", unit::one, "of the body in the hand when it was grabbed");
    s.output(force, "force", unit::newton, "on the body, in the world");
    s.output(torque, "torque", unit::newton_metre, "on the body, in the world");
    s.output(distance, "distance", unit::metre, "from the point by which it is held to the hand");
    s.scratch(now, "now", "the body that it holds");
}

namespace
{

constexpr double kTurn = 2 * std::numbers::pi;

Vec3 at_most(const Vec3& v, double most)
{
    const double n = length(v);
    return n > most ? v * (most / n) : v;
}

/// What a State/User says of itself; another body is a hand that is always there and never closes by itself.
struct Hand
{
    bool is_there = true;
    double grip = 0;
};

Hand hand_of(const StepContext& context, Ref user)
{
    Hand hand;
    const Value present = context.lookup->value_of(user, "present"), gone = context.lookup->value_of(user, "gone"),
                grip = context.lookup->value_of(user, "grip");
    if (const bool* there = std::get_if<bool>(&present)) hand.is_there = *there;
    if (const bool* away = std::get_if<bool>(&gone)) hand.is_there = hand.is_there && !*away;
    if (const double* how_far = std::get_if<double>(&grip)) hand.grip = *how_far;
    return hand;
}

bool may_hold(const GrabRows& grabs, Row row, const Bodies& bodies, Ref body)
{
    const RefList& all = grabs.body[row];
    return body.valid() && body != grabs.user[row] && body.facet == Facet::Body && bodies.dynamic(body.index) &&
           std::find(all.begin(), all.end(), body) != all.end();
}

/// The body whose surface is nearest to the hand's origin, within reach.
Ref nearest_of(const GrabRows& grabs, Row row, const Bodies& bodies, const Shapes& shapes)
{
    Ref nearest;
    double least = grabs.reach[row];
    const Vec3 p = bodies.position[grabs.user[row].index];
    for (const Ref body : grabs.body[row])
        if (may_hold(grabs, row, bodies, body))
            if (const double d = distance_to_body(bodies, shapes, body.index, p); d <= least && (!nearest.valid() || d < least))
                nearest = body, least = d;
    return nearest;
}

void let_go(const StepContext& context, Row row, GrabRows& grabs, std::string_view why)
{
    if (grabs.held[row].empty()) return;
    context.emit(row, "grab.released", Severity::Info, grabs.held[row] + ": " + std::string(why));
    grabs.held[row].clear();
}

void take_hold(const StepContext& context, Row row, GrabRows& grabs, const Bodies& bodies, Ref body, bool by_centre)
{
    const std::string_view id = context.lookup->id_of(body);
    if (grabs.held[row] == id) return;
    let_go(context, row, grabs, "another body is grabbed");
    const std::uint32_t b = body.index, h = grabs.user[row].index;
    grabs.held[row] = id;
    grabs.point[row] = by_centre ? Vec3{} : rotate_back(bodies.orientation[b], bodies.position[h] - bodies.position[b]);
    grabs.attitude[row] = conjugate(bodies.orientation[h]) * bodies.orientation[b];
    context.emit(row, "grab.holds", Severity::Info, std::string(id));
}

void decide(const StepContext& context, Row row, GrabRows& grabs, const Bodies& bodies, const Shapes& shapes)
{
    const Hand hand = hand_of(context, grabs.user[row]);
    const bool was_closed = grabs.closed[row];
    if (hand.grip >= grabs.close_at[row] || hand.grip <= grabs.open_at[row]) grabs.closed[row] = hand.grip >= grabs.close_at[row];
    if (!hand.is_there)
    {
        grabs.closed[row] = false;
        return let_go(context, row, grabs, "the user is gone");
    }
    if (!grabs.hold[row].empty())
    {
        const Ref named = context.lookup->find(grabs.hold[row]);
        if (may_hold(grabs, row, bodies, named)) return take_hold(context, row, grabs, bodies, named, true);
        context.emit(row, "grab.refused", Severity::Warning, grabs.hold[row] + " is no body that it may hold");
        grabs.hold[row].clear();
    }
    if (!grabs.closed[row]) return let_go(context, row, grabs, "the hand opens");
    if (was_closed) return;
    const Ref touched = context.lookup->find(grabs.touched[row]);
    const Ref found = may_hold(grabs, row, bodies, touched) ? touched : nearest_of(grabs, row, bodies, shapes);
    if (found.valid()) take_hold(context, row, grabs, bodies, found, false);
}

}  // namespace

void open_and_close(const StepContext& context, Rows rows, GrabRows& grabs, const Bodies& bodies, const Shapes& shapes)
{
    for (const Row row : rows)
    {
        decide(context, row, grabs, bodies, shapes);
        Ref held = grabs.held[row].empty() ? Ref{} : context.lookup->find(grabs.held[row]);
        if (!grabs.held[row].empty() && !may_hold(grabs, row, bodies, held))
        {
            let_go(context, row, grabs, "it is there no more");
            held = {};
        }
        grabs.now[row].body = held;
    }
}

Grasp grasp_of(const GrabRows& grabs, Row row, const Bodies& bodies)
{
    const std::uint32_t b = grabs.now[row].body.index, h = grabs.user[row].index;
    const double zeta = grabs.damping_ratio[row], m = bodies.mass[b], given = grabs.stiffness[row];
    const double w = given > 0 ? std::sqrt(given / m) : kTurn * grabs.frequency[row];
    Grasp out;
    out.p = bodies.position[b] + rotate(bodies.orientation[b], grabs.point[row]);
    const Vec3 stretch = bodies.position[h] - out.p, rate = bodies.velocity[h] - bodies.velocity_at(b, out.p);
    out.distance = length(stretch);
    out.force = at_most(m * (w * w * stretch + 2 * zeta * w * rate), grabs.max_force[row]);
    const Vec3 turn = log_rotation(bodies.orientation[h] * grabs.attitude[row] * conjugate(bodies.orientation[b]));
    const Mat3 R = rotation_matrix(bodies.orientation[b]);
    const Vec3 wanted = w * w * turn + 2 * zeta * w * (bodies.angular_velocity[h] - bodies.angular_velocity[b]);
    out.torque = at_most(R * (bodies.inertia_B[b] * transposed_times(R, wanted)), grabs.max_torque[row]);
    return out;
}

void pull(const StepContext& context, Rows rows, const GrabRows& grabs, const Bodies& bodies, Wrenches& wrenches)
{
    for (const Row row : rows)
    {
        const Ref body = grabs.now[row].body;
        if (!body.valid() || !bodies.dynamic(body.index) || !context.active(body)) continue;
        const Grasp grasp = grasp_of(grabs, row, bodies);
        wrenches.begin(context.component_of_row[row]);
        wrenches.add_force_at(body, grasp.force, grasp.p);
        wrenches.add_torque(body, grasp.torque);
    }
}

void finish_grab(const StepContext& context, Rows rows, GrabRows& grabs, const Bodies& bodies, Touches& touches)
{
    for (const Row row : rows)
    {
        Ref touched;
        for (const TouchPoint& t : touches.of(grabs.user[row]))
            if (!touched.valid() && t.persists && may_hold(grabs, row, bodies, t.other)) touched = t.other;
        if (const std::string_view id = touched.valid() ? context.lookup->id_of(touched) : std::string_view(); grabs.touched[row] != id)
            grabs.touched[row] = id;
        const Ref body = grabs.now[row].body;
        const bool holds = body.valid() && bodies.dynamic(body.index);
        const Grasp grasp = holds ? grasp_of(grabs, row, bodies) : Grasp{};
        grabs.force[row] = grasp.force, grabs.torque[row] = grasp.torque, grabs.distance[row] = grasp.distance;
        if (holds) touches.add(grabs.user[row], {body, grasp.p, {}, -context.dt * grasp.force, true, -context.dt * grasp.torque});
    }
}

}  // namespace plab::constraints
