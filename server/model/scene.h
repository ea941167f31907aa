/// A scene, resolved and checked: a flat list of components with values, roles and the commands that take part. The world is
/// built only from this form; requests add to it and remove from it, --expand prints it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plab/result.h"
#include "plab/value.h"

namespace plab::model
{

/// A step length, exact if the text was: 1/240, 0.001 (= 1/1000). seconds == numerator / denominator.
struct StepLength
{
    double seconds = 1.0 / 240;
    std::int64_t numerator = 1;
    std::int64_t denominator = 240;  ///< 0: only `seconds` is known
    /// n * dt with one rounding.
    double at(std::int64_t n) const
    {
        return denominator > 0 ? static_cast<double>(n * numerator) / static_cast<double>(denominator) : static_cast<double>(n) * seconds;
    }
};

struct Camera
{
    std::string name;
    Vec3 position{4, -6, 3};
    Vec3 look_at;
    Vec3 up{0, 0, 1};
    double field_of_view = 0.7;  ///< rad, vertical
};

struct SceneSettings
{
    StepLength dt;
    std::uint64_t seed = 1;
    std::string solver = "solver";                 ///< id of the solver of objects that name none
    std::string solver_type = "Solver/Automatic";  ///< its type, if the scene has no component with that id
    std::string title;
    std::vector<Camera> cameras;
};

struct FieldSpec
{
    std::string name;
    Value value;
    SourceLocation where;
};

struct RoleSpec
{
    std::string name;
    std::vector<std::string> members;  ///< ids of typed components with a facet that the role accepts, in id order
    bool everyone = false;             ///< "*": all that fit, including those added later
    SourceLocation where;
};

struct ComponentSpec
{
    std::string id;
    std::string name;                ///< display name
    std::string type;                ///< empty: a group
    std::string parent;              ///< id; empty at top level
    std::string alias_of;            ///< compref: shares that component; then type is empty
    std::vector<std::string> group;  ///< comprefs of a group without type, when there are several
    std::vector<FieldSpec> fields;   ///< fields that the author gave; the rest have the declared defaults
    std::vector<RoleSpec> roles;
    bool explicit_commands = false;     ///< a simulation command selects: only `commands` take part
    std::vector<std::string> commands;  ///< names of exported commands that take part
    bool generated = false;             ///< generated because the short form left it out
    SourceLocation where;
};

struct SceneSpec
{
    SceneSettings settings;
    std::vector<ComponentSpec> components;  ///< document order; ids unique
    std::string file;

    const ComponentSpec* find(const std::string& id) const
    {
        for (const ComponentSpec& c : components)
            if (c.id == id) return &c;
        return nullptr;
    }
};

}  // namespace plab::model
