/// Data of a server as JSON, for all programs that print it: in SI units. Members keep their names of the bus, or have
/// shorter ones (json.cpp); vectors are [x, y, z], rotations [w, x, y, z]; numbers that are not finite are null.
#pragma once

#include <nlohmann/json.hpp>

#include "link/caller.h"
#include "link/catalogue.h"

namespace plab::link
{

using Json = nlohmann::ordered_json;

Json json_of(const Vec3& v);
Json json_of(const Quat& q);
Json json_of(const ServerInfo& s);
Json json_of(const Object& o);
Json json_of(const Shape& s);
Json json_of(const Interaction& i);
Json json_of(const InteractionMetrics& m);
Json json_of(const Metrics& m);
Json json_of(const Type& t);
Json json_of(const Reply& r);
/// One of the sample's entries.
Json json_of(const plab_v2_Events& sample, std::uint32_t entry);
Json json_of(const plab_v2_Collisions& sample, std::uint32_t entry);

/// One line; text that is not UTF-8 is repaired, and no control character in it reaches a terminal.
std::string line_of(const Json& json);

}  // namespace plab::link
