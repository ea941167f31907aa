#include "foxglove/value_text.h"

#include <nlohmann/json.hpp>

#include "link/text.h"

namespace plab::foxglove
{

std::optional<std::string> value_text(const Json& value)
{
    if (value.is_string()) return value.get<std::string>();
    if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
    if (value.is_number_integer()) return value.dump();
    if (value.is_number()) return link::number_text(value.get<double>());
    if (!value.is_array() || value.empty()) return {};
    std::string out;
    for (const Json& one : value)
    {
        const auto text = one.is_array() ? std::nullopt : value_text(one);
        if (!text) return {};
        out += (out.empty() ? "" : " ") + *text;
    }
    return out;
}

}  // namespace plab::foxglove
