/// Axis-aligned bounding boxes in the frame W.
#pragma once

#include <cmath>

#include "plab/vector.h"

namespace plab::geometry
{

/// Empty while lower > upper.
struct Box
{
    Vec3 lower{1, 1, 1}, upper{-1, -1, -1};  // m, W
};

inline bool overlap(const Box& a, const Box& b)
{
    for (int k = 0; k < 3; ++k)
        if (a.lower[k] > b.upper[k] || b.lower[k] > a.upper[k]) return false;
    return true;
}

inline Box joined(const Box& a, const Box& b)
{
    Box out = a;
    for (int k = 0; k < 3; ++k)
    {
        if (b.lower[k] < out.lower[k]) out.lower[k] = b.lower[k];
        if (b.upper[k] > out.upper[k]) out.upper[k] = b.upper[k];
    }
    return out;
}

/// Half the surface area, m^2. The probability that a random line meets the box is proportional to it (surface area heuristic).
inline double half_surface(const Box& b)
{
    const Vec3 d = b.upper - b.lower;
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

/// Whether a box reaches the half-space normal . p <= offset + growth (m), allowing for rounding.
inline bool reaches(const Vec3& normal, double offset, const Box& box, double growth = 0)
{
    double lowest = 0, size = std::fabs(offset);
    for (int k = 0; k < 3; ++k)
    {
        const double term = normal[k] * (normal[k] > 0 ? box.lower : box.upper)[k];
        lowest += term, size += std::fabs(term);
    }
    return lowest <= offset + growth + 1e-14 * size;
}

}  // namespace plab::geometry
