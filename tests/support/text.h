/// Numbers in the format of blueprints, with all their digits.
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

}  // namespace plab::test
