/// What a server says of its scene, as plain structs: a snapshot that can be kept up to date.
///
///   auto catalogue = link::Catalogue::open(session);
///   if (catalogue->fetch(2s)) for (const auto& [id, object] : catalogue->now().objects) ...
///   while (running) { if (catalogue->update()) redraw(catalogue->now()); ... }
///
/// Units and meanings of the fields stand in idl/plab.idl.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>

#include "link/session.h"
#include "plab/vector.h"

namespace plab::link
{

struct Parameter
{
    std::string name, text, unit, kind;  ///< kind: "param", "state", "output"
};

struct Participants
{
    std::string role;
    std::vector<std::string> members;
};

struct Camera
{
    std::string name;
    Vec3 position, look_at, up;
    double field_of_view = 0;  ///< rad, vertical
};

struct Scene
{
    std::uint64_t run = 0;
    std::string file, title;
    double dt = 0;
    std::uint64_t seed = 0;
    std::uint32_t objects = 0, interactions = 0;
    std::vector<Camera> cameras;
};

struct Object
{
    std::string id, name, type;
    std::uint32_t handle = 0;  ///< what frames call it
    std::uint64_t run = 0;
    bool is_shaft = false;
    std::string motion;  ///< "static", "kinematic", "dynamic"
    double mass = 0;     ///< kg; of a shaft its inertia, kg m^2
    Vec3 position;
    Quat orientation;           ///< X_WB when this was written, or X_WA of a shaft's axle
    std::optional<Vec3> color;  ///< red, green, blue: 0 to 1
    std::vector<std::string> shapes;
    bool quarantined = false;
    std::vector<Parameter> parameters;
};

struct Shape
{
    std::string id, type;
    std::string form;  ///< "sphere", "box", "plane", "capsule", "cylinder", "mesh", "none"
    Vec3 position;
    Quat orientation;  ///< X_BS
    Vec3 size;         ///< sphere: x is the radius; box: half extents
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< each index is that of a vertex
};

struct Interaction
{
    std::string id, name, type, family;
    std::uint64_t run = 0;
    std::int64_t since = 0;  ///< step at which this algorithm took its place
    std::vector<Participants> roles;
    bool quarantined = false;
    std::vector<Parameter> parameters;
};

struct FieldInfo
{
    std::string name, kind, value_type, unit, fallback, rule, doc;
    bool required = false;
};

struct RoleInfo
{
    std::string name, accepts, doc;
    std::uint32_t least = 0, most = 0;  ///< most: kAnyNumber for no limit
};
inline constexpr std::uint32_t kAnyNumber = 4294967295u;

struct Type
{
    std::string name, family, doc, plugin;
    bool loaded = false;
    int order = 0;
    std::string accuracy, strengths, cost, limits, source;
    std::vector<RoleInfo> roles;
    std::vector<FieldInfo> fields;
};

struct InteractionMetrics
{
    std::string component, requested, resolved;
    double cost_ns = 0, error = 0, work = 0;
    bool quarantined = false;
    std::vector<Parameter> outputs;  ///< and accounts: what the figures above are

    /// What the server says of a figure; null if it says nothing.
    const Parameter* account(std::string_view name) const;
};

struct Metrics
{
    std::uint64_t run = 0, revision = 0;
    std::int64_t step = 0;
    double time = 0, step_ns = 0, real_time_factor = 0;
    double kinetic = 0, stored = 0, work = 0, of_requests = 0, unexplained = 0;  ///< J
    Vec3 momentum, angular_momentum;
    double residual = 0, deepest = 0;
    std::uint32_t contacts = 0;
    std::vector<InteractionMetrics> interactions;

    const InteractionMetrics* find(const std::string& component) const;
};

/// The sample as a plain struct, for those who read the topic themselves.
Metrics metrics_of(const plab_v2_Metrics& sample);

/// The topics that a catalogue reads. What is left out costs nothing.
enum class Part : unsigned
{
    Server = 1,
    Scene = 2,
    Objects = 4,
    Shapes = 8,
    Interactions = 16,
    Types = 32,
    Metrics = 64,
};
using Parts = unsigned;
constexpr Parts operator|(Part a, Part b) { return static_cast<Parts>(a) | static_cast<Parts>(b); }
constexpr Parts operator|(Parts a, Part b) { return a | static_cast<Parts>(b); }
constexpr bool has(Parts parts, Part part) { return (parts & static_cast<Parts>(part)) != 0; }
inline constexpr Parts kEverything = 127;

struct Snapshot
{
    std::optional<ServerInfo> server;  ///< empty: it has gone
    std::optional<Scene> scene;
    std::map<std::string, Object> objects;
    std::map<std::string, Shape> shapes;
    std::map<std::string, Interaction> interactions;
    std::map<std::string, Type> types;
    std::optional<Metrics> metrics;
};

/// Not thread-safe; must not outlive the session.
class Catalogue
{
public:
    /// Subscribes; nothing is there before fetch() or update(). The scene is always read: it says how much there is.
    static Result<Catalogue> open(const Session& session, Parts parts = kEverything);

    /// Waits until all that the server keeps for late joiners is there. An error names what is missing at the time-out.
    Result<void> fetch(Seconds timeout, const Stop& stop = {});
    /// Takes what has come, without waiting; true if something changed.
    bool update();
    /// Waits for a change until `timeout`; takes it.
    bool wait(Seconds timeout);

    const Snapshot& now() const { return now_; }
    /// Counts changes of what there is (the server's state and metrics left out): for caches of who draws or prints.
    std::uint64_t version() const { return version_; }
    /// The server showed itself and has gone since: ended, or silent for longer than its lease.
    bool server_is_gone() const { return was_there_ && !now_.server; }
    /// The object that frames call `handle`; null if there is none.
    const Object* find_object(std::uint32_t handle) const;

private:
    std::string missing() const;
    bool take_state();
    bool take_things();
    void rebuild_handles();

    const Session* session_ = nullptr;
    Parts parts_ = 0;
    wire::Reader<plab_v2_Server> server_;
    wire::Reader<plab_v2_Scene> scene_;
    wire::Reader<plab_v2_SceneObject> objects_;
    wire::Reader<plab_v2_Shape> shapes_;
    wire::Reader<plab_v2_Interaction> interactions_;
    wire::Reader<plab_v2_Type> types_;
    wire::Reader<plab_v2_Metrics> metrics_;
    wire::Entity waitset_;
    Snapshot now_;
    std::map<std::uint32_t, std::string> handles_;
    std::uint64_t version_ = 0;
    bool was_there_ = false;
};

}  // namespace plab::link
