/// Numbers in messages. std::to_string(double) prints 1e-13 as 0.000000 and 1e300 with 301 digits, so it is not used for messages.
#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <system_error>

namespace plab
{

/// The shortest decimal text that parses back to `value`: for given numbers.
inline std::string number_text(double value)
{
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    return {text, end};
}

/// `value` with `digits` significant digits and a power of ten if it is large or small: for measured numbers.
inline std::string rounded_text(double value, int digits = 3)
{
    char text[64];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits);
    return error == std::errc() ? std::string(text, end) : std::string();
}

}  // namespace plab
