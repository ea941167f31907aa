/// 4x4 matrices in single precision, in column-major order, as OpenGL requires.
#pragma once

#include "plab/vector.h"

namespace plab::render
{

struct Mat4
{
    float m[16] = {};
};

/// Three orthogonal axes, of an eye or of a light. `back` points out of the picture.
struct Basis
{
    Vec3 right, up, back;
};

/// The basis that looks along -back, with `up` as upright as possible; if they are parallel, another up direction is chosen.
Basis basis_of(const Vec3& back, const Vec3& up);

/// Clip space from points relative to the eye, in world axes. Angles in rad, distances in m.
Mat4 perspective(const Basis& eye, double field_of_view, double aspect, double near, double far);

struct Box3
{
    Vec3 low, high;
};

/// Clip space from points relative to the origin, for a box given along the basis.
Mat4 orthographic(const Basis& light, const Box3& box);

}  // namespace plab::render
