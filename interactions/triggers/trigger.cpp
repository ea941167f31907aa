#include "trigger.h"

#include "plab/point_distance.h"

namespace plab::triggers
{

void TriggerRows::describe(Schema& schema, bool needs_object)
{
    schema.role(user, "user", {Facet::Body}, "users, any of whom can do it");
    RoleBuilder what = schema.role(object, "object", {Facet::Body}, "what it happens to");
    if (!needs_object) what.optional();
    schema.param(verb, "verb", unit::one, "of the request, such as swap, set, push or pause");
    schema.param(target, "target", unit::one, "of the request: id of a component").or_else("");
    schema.param(argument, "argument", unit::one, "of the request: the new type; of a set, name=value").or_else("");
    schema.param(reason, "reason", unit::one, "why, in words").or_else("");
    schema.param(dwell, "dwell", unit::second, "for how long it must go on").or_else(0).not_negative();
    schema.param(rearm, "rearm", unit::second, "after how long it may happen again, at the earliest").or_else(0).not_negative();
    schema.state(held_for, "held_for", unit::second, "for how long it has been going on");
    schema.state(since, "since", unit::second, "since it happened last");
    schema.state(fired, "fired", unit::one, "it has happened and has not ended yet");
    schema.state(pending, "pending", unit::one, "the request is made before the next step");
    schema.state(times, "times", unit::one, "how often it has happened");
    schema.state(by, "by", unit::one, "the user by whom it happened last");
}

void TouchedRows::describe(Schema& schema) { TriggerRows::describe(schema, true); }

void NearRows::describe(Schema& schema)
{
    TriggerRows::describe(schema, true);
    schema.param(distance, "distance", unit::metre, "from the user's origin to the object's surface").or_else(0.5).not_negative();
}

void PointedAtRows::describe(Schema& schema)
{
    TriggerRows::describe(schema, true);
    schema.param(range, "range", unit::metre, "length of the ray").or_else(10).positive();
}

void KeyRows::describe(Schema& schema)
{
    TriggerRows::describe(schema, false);
    schema.param(button, "button", unit::one, "bits of the buttons, all of which must be pressed: powers of 2").or_else(1).at_least(1);
}

Result<void> prepare_trigger(Row row, const TriggerRows& triggers)
{
    const std::string& verb = triggers.verb[row];
    if (verb.empty()) return reason("verb must not be empty");
    for (const char* const alone : {"load", "reset", "restore", "rewind", "shutdown", "cancel"})
        if (verb == alone) return reason("verb: a trigger cannot ask for '" + verb + "'");
    return {};
}

namespace
{

/// Whether the user is there: a State/User that nobody moves, or that is gone, does nothing.
bool is_there(const StepContext& context, Ref user)
{
    const Value present = context.lookup->value_of(user, "present"), gone = context.lookup->value_of(user, "gone");
    const bool* here = std::get_if<bool>(&present);
    const bool* away = std::get_if<bool>(&gone);
    return !(here && !*here) && !(away && *away);
}

/// Takes note of whether the condition holds at the end of the step, by whom.
void follow(const StepContext& context, Row row, TriggerRows& triggers, Ref by)
{
    triggers.since[row] += context.dt;
    if (!by.valid())
    {
        triggers.held_for[row] = 0;
        if (triggers.since[row] >= triggers.rearm[row]) triggers.fired[row] = false;
        return;
    }
    triggers.held_for[row] += context.dt;
    // Half a step of tolerance: sums of steps are rounded.
    if (triggers.fired[row] || triggers.held_for[row] + 0.5 * context.dt < triggers.dwell[row]) return;
    triggers.fired[row] = triggers.pending[row] = true;
    triggers.since[row] = 0, ++triggers.times[row], triggers.by[row] = context.lookup->id_of(by);
    context.emit(row, "trigger.fired", Severity::Info, "by " + triggers.by[row]);
}

/// The first user, in the order of ids, for whom the condition holds.
template <class Condition>
Ref first_of(const StepContext& context, const RefList& users, Condition holds)
{
    for (const Ref user : users)
        if (is_there(context, user) && holds(user)) return user;
    return {};
}

/// Whether a ray meets a body, by sphere tracing (J. C. Hart, Sphere tracing, 1996): the distance to the surface is a step that cannot
/// miss.
bool meets(const Bodies& bodies, const Shapes& shapes, std::uint32_t body, const Vec3& from, const Vec3& along, double range)
{
    constexpr int kMost = 256;
    constexpr double kClose = 1e-6;  // of the range
    double t = 0;
    for (int i = 0; i < kMost && t <= range; ++i)
    {
        const double d = distance_to_body(bodies, shapes, body, from + t * along);
        if (d <= kClose * range) return true;
        t += d;
    }
    return false;
}

}  // namespace

void watch_touch(const StepContext& context, Rows rows, TouchedRows& triggers, const Touches& touches)
{
    for (const Row row : rows)
    {
        const auto touched = touches.of(triggers.object[row]);
        follow(context, row, triggers,
               first_of(context, triggers.user[row],
                        [&](Ref user)
                        { return std::any_of(touched.begin(), touched.end(), [&](const TouchPoint& t) { return t.other == user; }); }));
    }
}

void watch_nearness(const StepContext& context, Rows rows, NearRows& triggers, const Bodies& bodies, const Shapes& shapes)
{
    for (const Row row : rows)
        follow(context, row, triggers,
               first_of(context, triggers.user[row],
                        [&](Ref user) {
                            return distance_to_body(bodies, shapes, triggers.object[row].index, bodies.pose(user.index).p) <=
                                   triggers.distance[row];
                        }));
}

void watch_ray(const StepContext& context, Rows rows, PointedAtRows& triggers, const Bodies& bodies, const Shapes& shapes)
{
    for (const Row row : rows)
        follow(context, row, triggers,
               first_of(context, triggers.user[row],
                        [&](Ref user)
                        {
                            const Pose X = bodies.pose(user.index);
                            return meets(bodies, shapes, triggers.object[row].index, X.p, rotate(X.q, {1, 0, 0}), triggers.range[row]);
                        }));
}

void watch_key(const StepContext& context, Rows rows, KeyRows& triggers)
{
    for (const Row row : rows)
        follow(context, row, triggers,
               first_of(context, triggers.user[row],
                        [&](Ref user)
                        {
                            const Value buttons = context.lookup->value_of(user, "buttons");
                            const auto* pressed = std::get_if<std::int64_t>(&buttons);
                            return pressed && (*pressed & triggers.button[row]) == triggers.button[row];
                        }));
}

void ask_for_requests(Rows rows, TriggerRows& triggers, RequestSink& requests)
{
    for (const Row row : rows)
    {
        if (!triggers.pending[row]) continue;
        triggers.pending[row] = false;
        const std::string& words = triggers.reason[row];
        requests.ask(row, triggers.verb[row], triggers.target[row], triggers.argument[row],
                     (words.empty() ? std::string("triggered") : words) + " by " + triggers.by[row]);
    }
}

}  // namespace plab::triggers
