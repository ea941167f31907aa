/// How clients draw objects: the same colours and stand-ins in all of them.
#pragma once

#include <string>

#include "link/values.h"

namespace plab::link
{

/// Colour of an object that specifies none: one of a small palette, always the same for one id.
Vec3 color_of_id(const std::string& id);
/// Its own colour, or grey for what cannot move, or that of its id.
Vec3 shown_color(const Object& object);

/// The cylinder that represents a shaft without shapes: a solid disk of its inertia, within visible bounds. A rotating cylinder looks
/// like a resting one: a mark, a box across both faces and the rim, shows its rotation.
struct Axle
{
    double radius = 0, half_length = 0;  ///< m
    Vec3 mark_position, mark_size;       ///< m; half extents
};
inline constexpr Vec3 kMarkColor{0.95, 0.75, 0.2};
Axle axle_of_inertia(double inertia);  ///< kg m^2

/// The angle of a shaft when its entry was written, rad.
double shaft_angle(const Object& shaft);
/// The rotation of a shaft about its axle, z.
Quat shaft_rotation(double angle);

}  // namespace plab::link
