/// Text for blueprints and shells: numbers with all their digits, and words that stay one word; and what a text holds.
#pragma once

#include <cstdio>
#include <fstream>
#include <sstream>
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

/// Whether `part` stands somewhere in the text.
inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// All that a file holds; nothing if it cannot be read.
inline std::string content_of(const std::string& path)
{
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

/// One word of a shell's command line, whatever is in it.
inline std::string quoted(const std::string& word)
{
    std::string out = "'";
    for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

}  // namespace plab::test
