/// "did you mean": which of the known names is nearest to the one that was asked for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plab::link
{

/// At most `most` names that a slip of the keyboard could have turned into `wanted`, nearest first.
std::vector<std::string> nearest_names(std::string_view wanted, const std::vector<std::string>& known, std::size_t most = 3);

/// ", did you mean 'a' or 'b'?", or nothing if no name is near.
std::string did_you_mean(std::string_view wanted, const std::vector<std::string>& known);

}  // namespace plab::link
