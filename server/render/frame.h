/// One picture's geometry: where the eye and the light stand, how far and how fine things are seen.
///
/// All that goes to OpenGL is relative to the eye, in the world's axes (E): far from the world's origin, single
/// precision would shake.
#pragma once

#include "matrix.h"
#include "plab/result.h"
#include "render/render.h"

namespace plab::render
{

struct Frame
{
    Vec3 eye;    ///< W, m
    Vec3 focus;  ///< what is looked at, W, m
    Basis basis;
    Mat4 clip_from_E;
    double pixels_per_radian = 0;  ///< in the middle of the picture
    double reach = 0;              ///< as far as planes are seen, from the focus, m
    double grid = 1;               ///< width of its cells, m

    Vec3 to_light;  ///< unit, W
    Basis light;
    Box3 casters;  ///< of all that throws a shadow, along the light's axes, relative to the eye, m
    bool shadows = false;
    Mat4 light_from_E;

    Vec3 from_eye(const Vec3& p_W) const { return p_W - eye; }
};

/// Refuses a view that shows nothing: not finite, an angle out of (0, pi), or no distance to what it looks at.
/// `mesh_radii`: of each mesh, about its origin.
Result<Frame> make_frame(const Drawing& drawing, const std::vector<double>& mesh_radii, std::uint32_t width, std::uint32_t height);

/// Of the ball about a mesh's origin that holds it, m.
double radius_of(const Mesh& mesh);
/// Of the ball about the item's position that holds it, m; 0 for planes, which have no end.
double radius_of(const Item& item, const std::vector<double>& mesh_radii);

/// Whether all numbers of it are finite; what is not cannot be drawn.
bool can_be_drawn(const Item& item);

}  // namespace plab::render
