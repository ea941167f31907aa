/// What a server says, as plain values: the types of the bus under the names that clients use. Units and meanings of the members are
/// documented in idl/plab.idl.
#pragma once

#include "idl/values/scene.h"

namespace plab::link
{

using wire::EventInfo, wire::FieldFate, wire::FieldInfo, wire::Interaction, wire::InteractionMetrics, wire::kAnyNumber, wire::Metrics,
    wire::Operation, wire::Parameter, wire::Participants, wire::Reply, wire::RoleInfo, wire::Scene, wire::Shape, wire::StepOutcome,
    wire::SwapReport, wire::Type;
using Camera = wire::View;
using Object = wire::SceneObject;
using ServerInfo = wire::Server;

using wire::color_of, wire::find_account, wire::find_metrics, wire::is_shaft, wire::triangles_of;

}  // namespace plab::link
