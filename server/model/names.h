/// Suggestions for misspelled names, and the names of setters.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "plab/names.h"

namespace plab::model
{

using plab::did_you_mean, plab::nearest_names;

/// Whether a text is a pattern of ids: `*` matches any text and `?` any character.
bool is_pattern(std::string_view id);
bool matches(std::string_view pattern, std::string_view id);
/// Whether one of the patterns matches, which may be plain ids; all ids match if there are none.
bool takes_part(const std::vector<std::string>& patterns, std::string_view id);

/// "velocity_factor" from "SetVelocityFactor" or "VelocityFactor".
std::string field_name_of_setter(std::string_view setter);
/// "SetVelocityFactor" from "velocity_factor".
std::string setter_of_field_name(std::string_view field);

}  // namespace plab::model
