/// What plabctl prints with --json: the structs of clients/link as JSON, in SI units. Fields of the bus keep their
/// names; vectors are [x, y, z], rotations [w, x, y, z]; numbers that are not finite are null.
#pragma once

#include <nlohmann/json.hpp>

#include "control/console.h"
#include "link/caller.h"
#include "link/catalogue.h"

namespace plab::cli
{

using Json = nlohmann::ordered_json;

Json json_of(const Vec3& v);
Json json_of(const Quat& q);
Json json_of(const link::ServerInfo& s);
Json json_of(const std::vector<link::Parameter>& parameters);
Json json_of(const link::Object& o);
Json json_of(const link::Shape& s);
Json json_of(const link::Interaction& i);
Json json_of(const link::InteractionMetrics& m);
Json json_of(const link::Metrics& m);
Json json_of(const link::Type& t);
Json json_of(const link::SwapReport& s);
Json json_of(const link::Reply& r);

/// One line; text that is not UTF-8 is repaired.
std::string line_of(const Json& json);
/// Prints one object, on one line.
void print(const Console& console, const Json& json);

}  // namespace plab::cli
