/// Numbers in messages, and the message that most of them end in.
#pragma once

#include <charconv>
#include <cmath>
#include <string>

#include "plab/result.h"

namespace plab::bodies
{

/// The shortest decimal text that reads back as `value`.
inline std::string number_text(double value)
{
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    return {text, end};
}

/// Refuses what is not positive, or what has no finite inverse: the step divides by masses and inertias.
inline Result<void> check_positive(const std::string& name, double value)
{
    if (!(value > 0)) return reason(name + " must be positive, not " + number_text(value));
    if (!std::isfinite(value) || !std::isfinite(1 / value))
        return reason(name + " must lie between 1e-307 and 1e307, not " + number_text(value));
    return {};
}

}  // namespace plab::bodies
