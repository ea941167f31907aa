/// Suggestions for misspelled names, and the names of setters.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plab::model
{

/// Up to `most` names similar to `wanted` (edit distance, case and last part considered), most similar first.
std::vector<std::string> nearest_names(std::string_view wanted, const std::vector<std::string>& known, std::size_t most = 3);
/// ", did you mean 'a' or 'b'?" or an empty text.
std::string did_you_mean(std::string_view wanted, const std::vector<std::string>& known);

/// "velocity_factor" from "SetVelocityFactor" or "VelocityFactor".
std::string field_name_of_setter(std::string_view setter);
/// "SetVelocityFactor" from "velocity_factor".
std::string setter_of_field_name(std::string_view field);

}  // namespace plab::model
