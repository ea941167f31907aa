/// Numbers in messages. std::to_string(double) prints 1e-13 as 0.000000 and 1e300 with 301 digits: it is not for messages.
#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <system_error>

namespace plab
{

/// The shortest decimal text that reads back as `value`: for what somebody gave.
inline std::string number_text(double value)
{
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    return {text, end};
}

/// `value` to `digits` significant digits, with a power of ten where it is large or small: for what was measured.
inline std::string rounded_text(double value, int digits = 3)
{
    char text[64];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits);
    return error == std::errc() ? std::string(text, end) : std::string();
}

}  // namespace plab
