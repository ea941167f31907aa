/// "did you mean": finds the known names that are most similar to a given one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plab::link
{

/// At most `most` names of which `wanted` may be a misspelling, most similar first.
std::vector<std::string> nearest_names(std::string_view wanted, const std::vector<std::string>& known, std::size_t most = 3);

/// ", did you mean 'a' or 'b'?", or an empty text if no name is similar.
std::string did_you_mean(std::string_view wanted, const std::vector<std::string>& known);

}  // namespace plab::link
