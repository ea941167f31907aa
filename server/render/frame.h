/// The geometry of one picture: positions of eye and light, range and resolution.
/// All data for OpenGL is relative to the eye, in the world's axes (E): far from the world's origin, single precision would
/// cause jitter.
#pragma once

#include "matrix.h"
#include "plab/result.h"
#include "render/render.h"

namespace plab::render
{

struct Frame
{
    Vec3 eye;    ///< W, m
    Vec3 focus;  ///< the point that the view looks at, W, m
    Basis basis;
    Mat4 clip_from_E;
    double pixels_per_radian = 0;  ///< at the centre of the picture
    double plane_range = 0;        ///< visible range of planes, from the focus, m
    double grid = 1;               ///< width of its cells, m

    Vec3 to_light;  ///< unit, W
    Basis light;
    Box3 casters;  ///< bounds of everything that casts a shadow, along the light's axes, relative to the eye, m
    bool shadows = false;
    Mat4 light_from_E;

    Vec3 from_eye(const Vec3& p_W) const { return p_W - eye; }
};

/// Refuses an invalid view: not finite, an angle outside (0, pi), or no distance to the focus. `mesh_radii`: of each mesh,
/// about its origin.
Result<Frame> make_frame(const Drawing& drawing, const std::vector<double>& mesh_radii, std::uint32_t width, std::uint32_t height);

/// Radius of the ball about a mesh's origin that contains it, m.
double radius_of(const Mesh& mesh);
/// Radius of the ball about the item's position that contains it, m; 0 for planes, which are unbounded.
double radius_of(const Item& item, const std::vector<double>& mesh_radii);

/// Whether all its numbers are finite; other items cannot be drawn.
bool can_be_drawn(const Item& item);

}  // namespace plab::render
