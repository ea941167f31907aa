/// Trigger/*: when something happens between a user and an object, a request is made in the name of the component, as a client would make
/// it: verb, target and argument as in server/docs/requests.md.
///
/// What happens is a condition c(t), looked at at the end of each step. It has happened when c has held for `dwell`; then the request is
/// made before the next step, once. The trigger is armed again when c no longer holds and `rearm` has passed since.
///
///   Touched     a user's body touches the object's (or had an impact with it in the step)
///   Near        the origin of a user is within `distance` of the object's surface
///   PointedAt   the ray from a user's origin along its own x axis meets the object's surface within `range`
///   Key         a user presses a button
#pragma once

#include "plab/registrar.h"

namespace plab::triggers
{

/// What all triggers have.
struct TriggerRows
{
    Column<RefList> user;
    Column<Ref> object;
    Column<std::string> verb, target, argument, reason;
    Column<double> dwell, rearm;  ///< s
    // States
    Column<double> held_for, since;  ///< s: the condition has held, or time since it happened last
    Column<bool> fired, pending;     ///< not armed; the request is to be made
    Column<std::int64_t> times;
    Column<std::string> by;  ///< id of the user by whom it happened last

    void describe(Schema& schema, bool needs_object);
};

struct TouchedRows : TriggerRows
{
    void describe(Schema& schema);
};
struct NearRows : TriggerRows
{
    Column<double> distance;  ///< m
    void describe(Schema& schema);
};
struct PointedAtRows : TriggerRows
{
    Column<double> range;  ///< m
    void describe(Schema& schema);
};
struct KeyRows : TriggerRows
{
    Column<std::int64_t> button;  ///< bits, all of which must be pressed
    void describe(Schema& schema);
};

// Phase::Finish: looks at the condition.
void watch_touch(const StepContext& context, Rows rows, TouchedRows& triggers, const Touches& touches);
void watch_nearness(const StepContext& context, Rows rows, NearRows& triggers, const Bodies& bodies, const Shapes& shapes);
void watch_ray(const StepContext& context, Rows rows, PointedAtRows& triggers, const Bodies& bodies, const Shapes& shapes);
void watch_key(const StepContext& context, Rows rows, KeyRows& triggers);

/// Phase::Prepare: what no request can be made of is refused.
Result<void> prepare_trigger(Row row, const TriggerRows& triggers);
/// Phase::Decide: makes the requests.
void ask_for_requests(Rows rows, TriggerRows& triggers, RequestSink& requests);
template <class Table>
Result<void> prepare(Row row, const Table& triggers)
{
    return prepare_trigger(row, triggers);
}
template <class Table>
void ask(Rows rows, Table& triggers, RequestSink& requests)
{
    ask_for_requests(rows, triggers, requests);
}

}  // namespace plab::triggers
