/// The types of plab.idl as plain C++ values, for server and clients; no DDS. Names, units and meanings of the members are those of
/// plab.idl, and stand there. Each type has one list of its members: samples of the bus (idl/samples.h), bytes between plabd and
/// plab-bus, and JSON derive from it. A member that the list or plab.idl lacks does not compile.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "idl/values/members.h"
#include "idl/values/people.h"
#include "plab/vector.h"

namespace plab
{

PLAB_MEMBERS(Vec3, x, y, z)
PLAB_MEMBERS(Quat, w, x, y, z)

namespace wire
{

struct Parameter
{
    std::string name, text, unit, kind;
};
PLAB_MEMBERS(Parameter, name, text, unit, kind)

struct Participants
{
    std::string role;
    std::vector<std::string> members;
};
PLAB_MEMBERS(Participants, role, members)

// ---- Server ---------------------------------------------------------------------------------------------------------

struct DroppedSamples
{
    std::string topic;
    std::uint64_t samples = 0;
};
PLAB_MEMBERS(DroppedSamples, topic, samples)

struct KeptSnapshot
{
    std::string name;
    std::uint64_t run = 0;
    std::int64_t step = 0;
    double time = 0;
    std::uint64_t bytes = 0;
};
PLAB_MEMBERS(KeptSnapshot, name, run, step, time, bytes)

struct RecordingInfo
{
    std::string file;
    std::uint64_t bytes = 0, messages = 0, dropped = 0;
    std::string trouble;
};
PLAB_MEMBERS(RecordingInfo, file, bytes, messages, dropped, trouble)

struct Server
{
    std::string name, version, host;
    std::int32_t process = 0;
    std::int64_t started_ns = 0;
    std::string scene_file;
    std::uint64_t run = 0, revision = 0;
    std::int64_t step = 0;
    double time = 0, dt = 0;
    bool paused = false;
    double rate_asked = 0, rate_reached = 0, slipped = 0;
    std::string overload;
    double states_per_second = 0;
    std::uint32_t threads = 1;
    std::uint64_t last_event = 0, last_collision = 0;
    std::uint64_t requests_done = 0, requests_refused = 0;
    std::vector<DroppedSamples> dropped;
    std::string playback;
    double rewind_from = -1;
    std::vector<KeptSnapshot> snapshots;
    RecordingInfo recording;
};
PLAB_MEMBERS(Server, name, version, host, process, started_ns, scene_file, run, revision, step, time, dt, paused, rate_asked, rate_reached,
             slipped, overload, states_per_second, threads, last_event, last_collision, requests_done, requests_refused, dropped, playback,
             rewind_from, snapshots, recording)

// ---- Catalogue ------------------------------------------------------------------------------------------------------

struct View
{
    std::string name;
    Vec3 position, look_at, up;
    double field_of_view = 0;
};
PLAB_MEMBERS(View, name, position, look_at, up, field_of_view)

struct Scene
{
    std::string server_name;
    std::uint64_t run = 0;
    std::string file, title;
    double dt = 0;
    std::uint64_t seed = 0;
    std::uint32_t objects = 0, interactions = 0;
    std::vector<View> cameras;
};
PLAB_MEMBERS(Scene, server_name, run, file, title, dt, seed, objects, interactions, cameras)

struct SceneObject
{
    std::string component_id, name, type_name;
    std::uint32_t handle = 0;
    std::uint64_t run = 0;
    std::string shape_of, motion;
    double mass = 0;
    Vec3 position;
    Quat orientation;
    Vec3 color{-1, -1, -1};
    std::vector<std::string> shapes;
    bool quarantined = false;
    std::vector<Parameter> parameters;
};
PLAB_MEMBERS(SceneObject, component_id, name, type_name, handle, run, shape_of, motion, mass, position, orientation, color, shapes,
             quarantined, parameters)

struct Shape
{
    std::string component_id, type_name, form;
    Vec3 position;
    Quat orientation;
    Vec3 size;
    std::vector<Vec3> vertices;
    std::vector<std::uint32_t> triangles;
};
PLAB_MEMBERS(Shape, component_id, type_name, form, position, orientation, size, vertices, triangles)

struct Interaction
{
    std::string component_id, name, type_name, family;
    std::uint64_t run = 0;
    std::int64_t since = 0;
    std::vector<Participants> roles;
    bool quarantined = false;
    std::vector<Parameter> parameters;
};
PLAB_MEMBERS(Interaction, component_id, name, type_name, family, run, since, roles, quarantined, parameters)

struct FieldInfo
{
    std::string name, kind, value_type, unit, fallback;
    bool required = false;
    std::string rule, doc;
};
PLAB_MEMBERS(FieldInfo, name, kind, value_type, unit, fallback, required, rule, doc)

struct RoleInfo
{
    std::string name, accepts;
    std::uint32_t least = 0, most = 0;
    std::string doc;
};
PLAB_MEMBERS(RoleInfo, name, accepts, least, most, doc)
inline constexpr std::uint32_t kAnyNumber = 4294967295u;  ///< RoleInfo::most

struct Type
{
    std::string type_name, family, doc, plugin;
    bool is_loaded = false;
    std::int32_t order = 0;
    std::string accuracy, strengths, cost, limits, source;
    std::vector<RoleInfo> roles;
    std::vector<FieldInfo> fields;
};
PLAB_MEMBERS(Type, type_name, family, doc, plugin, is_loaded, order, accuracy, strengths, cost, limits, source, roles, fields)

// ---- States ---------------------------------------------------------------------------------------------------------
// Arrays of these have the layout of the samples' arrays, and are sent without a copy.

struct BodyState
{
    std::uint32_t handle = 0;
    Vec3 position;
    Quat orientation;
    Vec3 linear_velocity, angular_velocity;
};
PLAB_MEMBERS(BodyState, handle, position, orientation, linear_velocity, angular_velocity)

struct ShaftState
{
    std::uint32_t handle = 0;
    double angle = 0, speed = 0;
};
PLAB_MEMBERS(ShaftState, handle, angle, speed)

struct Frame
{
    std::uint64_t run = 0, revision = 0, sequence_number = 0;
    std::int64_t step = 0;
    double time = 0;
    std::int64_t stamp_ns = 0;
    std::vector<BodyState> bodies;
    std::vector<ShaftState> shafts;
};
PLAB_MEMBERS(Frame, run, revision, sequence_number, step, time, stamp_ns, bodies, shafts)

// ---- What happens ---------------------------------------------------------------------------------------------------

struct CollisionInfo
{
    std::string kind;
    double time = 0;
    std::string detector, a, b;
    Vec3 position, normal, impulse;
    double depth = 0;
};
PLAB_MEMBERS(CollisionInfo, kind, time, detector, a, b, position, normal, impulse, depth)

struct Collisions
{
    std::uint64_t run = 0, sequence_number = 0;
    std::int64_t step = 0;
    std::vector<CollisionInfo> entries;
};
PLAB_MEMBERS(Collisions, run, sequence_number, step, entries)

struct ContactPoint
{
    Vec3 position, normal;
    double depth = 0, normal_force = 0;
    Vec3 friction_force;
    bool is_impact = false;
};
PLAB_MEMBERS(ContactPoint, position, normal, depth, normal_force, friction_force, is_impact)

struct ContactInfo
{
    std::string detector, a, b;
    bool asleep = false;
    std::vector<ContactPoint> points;
};
PLAB_MEMBERS(ContactInfo, detector, a, b, asleep, points)

struct ContactForces
{
    std::uint64_t run = 0, sequence_number = 0;
    std::int64_t step = 0;
    double time = 0, step_length = 0;
    std::uint32_t left_out = 0;
    double force_left_out = 0;
    std::vector<ContactInfo> entries;
};
PLAB_MEMBERS(ContactForces, run, sequence_number, step, time, step_length, left_out, force_left_out, entries)

struct EventInfo
{
    std::string kind, severity;
    double time = 0;
    std::string component_id, a, b, message;
    std::vector<double> values;
};
PLAB_MEMBERS(EventInfo, kind, severity, time, component_id, a, b, message, values)

struct Events
{
    std::uint64_t run = 0, sequence_number = 0;
    std::int64_t step = 0;
    std::vector<EventInfo> entries;
};
PLAB_MEMBERS(Events, run, sequence_number, step, entries)

// ---- Metrics --------------------------------------------------------------------------------------------------------

struct InteractionMetrics
{
    std::string component_id, requested, resolved;
    double cost_ns = 0, error = 0, work = 0;
    bool quarantined = false;
    std::vector<Parameter> outputs;
};
PLAB_MEMBERS(InteractionMetrics, component_id, requested, resolved, cost_ns, error, work, quarantined, outputs)

struct EnergyLedger
{
    double kinetic = 0, stored = 0, work = 0, of_requests = 0, unexplained = 0;
};
PLAB_MEMBERS(EnergyLedger, kinetic, stored, work, of_requests, unexplained)

struct Metrics
{
    std::uint64_t run = 0, revision = 0;
    std::int64_t step = 0;
    double time = 0, step_ns = 0, real_time_factor = 0;
    EnergyLedger ledger;
    Vec3 momentum, angular_momentum;
    double residual = 0, deepest = 0;
    std::uint32_t contacts = 0;
    std::vector<InteractionMetrics> interactions;
};
PLAB_MEMBERS(Metrics, run, revision, step, time, step_ns, real_time_factor, ledger, momentum, angular_momentum, residual, deepest, contacts,
             interactions)

// ---- Requests -------------------------------------------------------------------------------------------------------

struct NamedText
{
    std::string name, text;
};
PLAB_MEMBERS(NamedText, name, text)

struct Operation
{
    std::string verb;
    std::string target = {}, argument = {}, blueprint = {};
    std::vector<NamedText> values = {};
};
PLAB_MEMBERS(Operation, verb, target, argument, blueprint, values)

struct Request
{
    ClientId client{};
    std::uint64_t number = 0;
    std::int64_t at = -1, revision = -1;
    std::vector<Operation> operations;
};
PLAB_MEMBERS(Request, client, number, at, revision, operations)

struct FieldFate
{
    std::string name, fate;
};
PLAB_MEMBERS(FieldFate, name, fate)

struct StepOutcome
{
    double energy = 0;
    Vec3 momentum;
    double error = 0, cost_ns = 0;
};
PLAB_MEMBERS(StepOutcome, energy, momentum, error, cost_ns)

struct SwapReport
{
    std::string component_id, from_type, to_type;
    std::vector<FieldFate> fields;
    double energy_before = 0;
    StepOutcome with_old, with_new;
};
PLAB_MEMBERS(SwapReport, component_id, from_type, to_type, fields, energy_before, with_old, with_new)

struct Reply
{
    ClientId client{};
    std::uint64_t number = 0;
    std::string outcome;
    bool repeated = false;
    std::vector<std::string> reasons;
    std::uint64_t run = 0, revision = 0;
    std::int64_t step = 0;
    double time = 0, pause_ns = 0, waited_ns = 0;
    std::string trial;
    std::vector<SwapReport> swaps;

    bool done() const { return outcome == "done"; }
};
PLAB_MEMBERS(Reply, client, number, outcome, repeated, reasons, run, revision, step, time, pause_ns, waited_ns, trial, swaps)

// ---- What a replay needs --------------------------------------------------------------------------------------------

/// Journal::origin of requests that the simulation made itself: what it measured by the clock, which a replay needs, and what a component
/// of the scene decided, which a replay decides again.
inline constexpr const char* kMeasured = "measurement";
inline constexpr const char* kDecidedByComponent = "component";

struct Journal
{
    std::uint64_t run = 0, revision = 0, sequence_number = 0;
    std::int64_t step = 0;
    double time = 0;
    std::string origin;
    ClientId client{};
    std::uint64_t number = 0;
    std::vector<Operation> operations;
};
PLAB_MEMBERS(Journal, run, revision, sequence_number, step, time, origin, client, number, operations)

struct Hashes
{
    std::uint64_t run = 0, sequence_number = 0;
    std::int64_t step = 0;
    std::vector<std::uint64_t> values;
};
PLAB_MEMBERS(Hashes, run, sequence_number, step, values)

struct Snapshot
{
    std::uint64_t run = 0, revision = 0;
    std::int64_t step = 0;
    double time = 0;
    std::string name, cause;
    std::uint64_t state_hash = 0;
    std::string blueprint;
    std::vector<std::uint8_t> data;
};
PLAB_MEMBERS(Snapshot, run, revision, step, time, name, cause, state_hash, blueprint, data)

struct Gone
{
    std::uint64_t run = 0;
    std::string topic_name, component_id;
};
PLAB_MEMBERS(Gone, run, topic_name, component_id)

struct Image
{
    std::string camera;
    std::uint64_t run = 0;
    std::int64_t step = 0;
    double time = 0;
    std::uint32_t width = 0, height = 0;
    std::string encoding;
    std::vector<std::uint8_t> data;
};
PLAB_MEMBERS(Image, camera, run, step, time, width, height, encoding, data)

template <Described T>
bool operator==(const T& a, const T& b)
{
    return same_members(a, b);
}

}  // namespace wire
}  // namespace plab
