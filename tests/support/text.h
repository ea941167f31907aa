/// Text for blueprints and shells: numbers with all their digits, and words that stay one word.
#pragma once

#include <cstdio>
#include <string>

#include "plab/vector.h"

namespace plab::test
{

inline std::string text(double x)
{
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.17g", x);
    return buffer;
}
inline std::string text(const Vec3& v) { return text(v.x) + " " + text(v.y) + " " + text(v.z); }
inline std::string text(const Quat& q) { return text(q.w) + " " + text(q.x) + " " + text(q.y) + " " + text(q.z); }

/// One word of a shell's command line, whatever is in it.
inline std::string quoted(const std::string& word)
{
    std::string out = "'";
    for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

}  // namespace plab::test
