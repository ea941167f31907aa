/// What a server says, as plain values: the types of the bus under the names that clients use. Units and meanings of the members are
/// documented in idl/plab.idl.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "idl/values/values.h"

namespace plab::link
{

using wire::EventInfo, wire::FieldFate, wire::FieldInfo, wire::Interaction, wire::InteractionMetrics, wire::kAnyNumber, wire::Metrics,
    wire::Operation, wire::Parameter, wire::Participants, wire::Reply, wire::RoleInfo, wire::Scene, wire::Shape, wire::StepOutcome,
    wire::SwapReport, wire::Type;
using Camera = wire::View;
using Object = wire::SceneObject;
using ServerInfo = wire::Server;

inline bool is_shaft(const Object& object) { return object.shape_of == "shaft"; }

/// Empty: the scene gives none.
std::optional<Vec3> color_of(const Object& object);

/// Indices of the corners of its triangles, three by three; triples that refer to nonexistent vertices are left out.
std::vector<std::uint32_t> triangles_of(const Shape& shape);

/// The server's explanation of a figure; null if there is none.
const Parameter* find_account(const InteractionMetrics& metrics, std::string_view name);

/// Null: nothing is known of this component.
const InteractionMetrics* find_metrics(const std::optional<Metrics>& metrics, std::string_view component);

}  // namespace plab::link
