/// Values of the wire as JSON, for all programs that print them: in SI units. Members keep their names of the bus, or have shorter ones
/// (json.cpp); vectors are [x, y, z], rotations [w, x, y, z]; numbers that are not finite are null, as nlohmann writes them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "idl/values/values.h"

namespace plab::wire
{

/// Keys stay in the order in which they are set. Numbers are the shortest texts that read back to the same bits.
using Json = nlohmann::ordered_json;

Json json_of(const Vec3& v);
Json json_of(const Quat& q);
Json json_of(const Server& s);
Json json_of(const SceneObject& o);
Json json_of(const Shape& s);
Json json_of(const Interaction& i);
Json json_of(const InteractionMetrics& m);
Json json_of(const Metrics& m);
Json json_of(const Type& t);
Json json_of(const Reply& r);
Json json_of(const SwapReport& s);
Json json_of(const EventInfo& e);
Json json_of(const CollisionInfo& c);
Json json_of(const ContactForces& c);

/// One line; text that is not UTF-8 is repaired, and no control character in it reaches a terminal.
std::string line_of(const Json& json);

}  // namespace plab::wire
