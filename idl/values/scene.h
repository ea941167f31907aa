/// What follows from the values of a scene.
#pragma once

#include <algorithm>
#include <optional>
#include <string_view>

#include "idl/values/values.h"

namespace plab::wire
{

inline bool is_shaft(const SceneObject& object) { return object.shape_of == "shaft"; }

/// Empty: the scene gives none.
inline std::optional<Vec3> color_of(const SceneObject& object)
{
    const Vec3& c = object.color;
    return c.x >= 0 && c.y >= 0 && c.z >= 0 ? std::optional(c) : std::nullopt;
}

/// Indices of the corners of its triangles, three by three; triples that refer to nonexistent vertices are left out.
inline std::vector<std::uint32_t> triangles_of(const Shape& shape)
{
    std::vector<std::uint32_t> out;
    const std::vector<std::uint32_t>& corners = shape.triangles;
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
        if (std::max({corners[i], corners[i + 1], corners[i + 2]}) < shape.vertices.size())
            out.insert(out.end(), {corners[i], corners[i + 1], corners[i + 2]});
    return out;
}

/// The server's explanation of a figure; null if there is none.
inline const Parameter* find_account(const InteractionMetrics& metrics, std::string_view name)
{
    const auto is_it = [&](const Parameter& p) { return p.kind == "account" && p.name == name; };
    const auto at = std::find_if(metrics.outputs.begin(), metrics.outputs.end(), is_it);
    return at == metrics.outputs.end() ? nullptr : &*at;
}

/// Null: nothing is known of this component.
inline const InteractionMetrics* find_metrics(const std::optional<Metrics>& metrics, std::string_view component)
{
    if (!metrics) return nullptr;
    const auto is_it = [&](const InteractionMetrics& m) { return m.component_id == component; };
    const auto at = std::find_if(metrics->interactions.begin(), metrics->interactions.end(), is_it);
    return at == metrics->interactions.end() ? nullptr : &*at;
}

}  // namespace plab::wire
