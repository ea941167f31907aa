/// A server's description of its scene, as plain structs. Units and meanings of the fields are documented in idl/plab.idl.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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
    std::uint32_t handle = 0;  ///< identifies it in frames
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
    std::int64_t since = 0;  ///< step at which this algorithm became active
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

    /// The server's explanation of a figure; null if there is none.
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

}  // namespace plab::link
