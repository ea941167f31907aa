/// The data that leaves a running scene, as plain structs: the step thread fills them, other threads send or write them.
/// The bus maps the fields to the types of idl/plab.idl, where units and meanings are documented.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "model/type_summary.h"
#include "plab/context.h"
#include "plab/vector.h"
#include "simulation/requests/requests.h"

namespace plab::publish
{

struct BodyState
{
    std::uint32_t handle = 0;
    Vec3 position;
    Quat orientation;
    Vec3 linear_velocity;
    Vec3 angular_velocity;
};

struct ShaftState
{
    std::uint32_t handle = 0;
    double angle = 0;
    double speed = 0;
};

struct Frame
{
    std::uint64_t run = 0, revision = 0;
    std::uint64_t number = 0;  ///< counts frames handed to this observer
    Tick step = 0;
    double time = 0;
    std::int64_t stamp_ns = 0;
    std::vector<BodyState> bodies;
    std::vector<ShaftState> shafts;
};

struct Parameter
{
    std::string name, text, unit, kind;
};

struct ObjectEntry
{
    std::string component, name, type;
    std::uint32_t handle = 0;
    std::uint64_t run = 0;
    bool is_shaft = false;
    Motion motion = Motion::Static;
    double mass = 0;
    Pose pose;  ///< X_WB, or X_WA of a shaft's axle
    Vec3 color{-1, -1, -1};
    std::vector<std::string> shapes;
    bool quarantined = false;
    std::vector<Parameter> parameters;
};

struct ShapeEntry
{
    std::string component, type;
    Geometry geometry;
};

struct InteractionEntry
{
    std::string component, name, type, family;
    std::uint64_t run = 0;
    Tick since = 0;
    struct Participants
    {
        std::string role;
        std::vector<std::string> members;
    };
    std::vector<Participants> roles;
    bool quarantined = false;
    std::vector<Parameter> parameters;
};

struct SceneEntry
{
    std::uint64_t run = 0;
    std::string file, title;
    double dt = 0;
    std::uint64_t seed = 0;
    std::uint32_t objects = 0, interactions = 0;
    std::vector<model::Camera> cameras;
};

/// What changed in the catalogue.
struct CatalogueChange
{
    bool everything = false;  ///< components that are not listed here no longer exist
    SceneEntry scene;
    std::vector<ObjectEntry> objects;
    std::vector<ShapeEntry> shapes;
    std::vector<InteractionEntry> interactions;
    std::vector<model::TypeSummary> types;  ///< empty: unchanged
    std::vector<std::string> gone;          ///< ids of components of any kind
};

struct CollisionRecord
{
    const char* kind = "";  ///< "begin", "impact", "rest", "end"
    double time = 0;
    std::string detector, a, b;
    Vec3 position, normal, impulse;
    double depth = 0;
};

struct EventRecord
{
    std::string kind;
    Severity severity = Severity::Info;
    double time = 0;
    std::string component, a, b, message;
    std::vector<double> values;
};

/// The events of one step.
template <class T>
struct Batch
{
    std::uint64_t run = 0;
    std::uint64_t first = 0;  ///< sequence number of the first entry
    Tick step = 0;
    std::vector<T> entries;
};

struct InteractionMetrics
{
    std::string component, requested, resolved;
    double cost_ns = 0;  ///< median of the last steps; 0 before the first
    double error = 0;    ///< 0 if none is known: then there is no account of it
    double work = 0;
    bool quarantined = false;
    /// Outputs, and accounts (kind "account") that explain the figures above: cost_quartiles (ns), cost_steps (number of steps
    /// of the median), cost_shared_by (number of components of its type that share the cost of the type; 1: measured
    /// individually), and error (its unit; the text is its meaning) or, if none is known, no_error (the reason).
    std::vector<Parameter> outputs;
};

struct Metrics
{
    std::uint64_t run = 0, revision = 0;
    Tick step = 0;
    double time = 0;
    double step_ns = 0;           ///< median of the last steps; 0 until the first one of a run
    double real_time_factor = 0;  ///< 0: not known yet
    double kinetic = 0, stored = 0, work = 0, of_requests = 0, unexplained = 0;
    Vec3 momentum, angular_momentum;
    double residual = 0, deepest = 0;
    std::uint32_t contacts = 0;
    std::vector<InteractionMetrics> interactions;
};

/// A snapshot that is kept under a name.
struct KeptSnapshot
{
    std::string name;
    std::uint64_t run = 0;
    Tick step = 0;
    double time = 0;
    std::uint64_t bytes = 0;
    friend bool operator==(const KeptSnapshot&, const KeptSnapshot&) = default;
};

/// What the server writes to a file.
struct RecordingStatus
{
    std::string file;
    std::uint64_t bytes = 0, messages = 0, dropped = 0;
    std::string trouble;
};

/// The server's own state.
struct Status
{
    std::string scene_file;
    std::uint64_t run = 0, revision = 0;
    Tick step = 0;
    double time = 0, dt = 0;
    bool paused = false;
    double rate_asked = 0, rate_reached = 0, slipped = 0;
    bool slipping = false;
    std::string busy;              ///< "" or the activity of a step or trial that takes long
    double states_per_second = 0;  ///< 0: each step
    std::uint32_t threads = 1;
    std::uint64_t last_event = 0, last_collision = 0;
    std::uint64_t requests_done = 0, requests_refused = 0;
    double rewind_from = -1;  ///< s; < 0: a rewind is not possible
    std::vector<KeptSnapshot> snapshots;
    RecordingStatus recording;
};

struct Image
{
    std::string camera;
    std::uint64_t run = 0;
    Tick step = 0;
    double time = 0;
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  ///< rows from the top
};

/// A request as received, in text; server/control converts it to operations.
struct OperationText
{
    std::string verb, target, argument, blueprint;
    std::vector<std::pair<std::string, std::string>> values;
};
using ClientId = std::array<std::uint8_t, 16>;
struct RequestText
{
    ClientId client{};
    std::uint64_t number = 0;
    std::int64_t at = -1, revision = -1;
    std::int64_t arrived_ns = 0;  ///< monotonic time
    std::vector<OperationText> operations;
};

/// A request that took effect.
struct JournalRecord
{
    std::uint64_t run = 0, revision = 0;
    std::uint64_t number = 0;  ///< counts entries
    Tick step = 0;
    double time = 0;
    const char* origin = "";  ///< "client", "command line"
    ClientId client{};
    std::uint64_t request = 0;  ///< the client's number
    std::vector<OperationText> operations;
};

/// State hashes of consecutive steps of one run.
struct HashRecord
{
    std::uint64_t run = 0;
    std::uint64_t first = 0;  ///< counts hashes
    Tick step = 0;
    std::vector<std::uint64_t> hashes;
};

/// Everything that a run needs to continue from there.
struct SnapshotRecord
{
    std::uint64_t run = 0, revision = 0;
    Tick step = 0;
    double time = 0;
    std::string name;
    const char* cause = "";  ///< "begin", "periodic", "request"
    std::uint64_t state_hash = 0;
    std::string blueprint;
    std::vector<std::uint8_t> data;
};

struct Answer
{
    ClientId client{};
    std::uint64_t number = 0;
    simulation::Reply reply;
    std::uint64_t run = 0;
    double time = 0;
    double waited_ns = 0;
};

}  // namespace plab::publish
