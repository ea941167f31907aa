/// What a viewer sees of a ball.
#pragma once

#include <span>

#include "plab/levels.h"

namespace plab::governors
{

struct Ball
{
    Vec3 center;        ///< W, m
    double radius = 0;  ///< m
};

/// m: from the eye to the surface of the ball; 0 inside.
double distance_to(const Viewpoint& eye, const Ball& ball);

/// Pixels: the diameter of the ball's picture on the optical axis at this distance; infinite if the eye is inside.
double pixels_of(const Viewpoint& eye, const Ball& ball);

/// The viewer with a picture that is larger by an angle (rad) on each side.
Viewpoint widened(const Viewpoint& eye, double margin);

/// Whether a part of the ball may lie in the pyramid that the viewer sees. Conservative: true also for some balls near an edge outside of
/// it.
bool is_in_view(const Viewpoint& eye, const Ball& ball);

/// Pixels in the picture for each metre at the component, for the viewer to whom it is largest; 0: nobody can see it within `look_ahead`
/// (s), even if each picture were larger by `margin` (rad) on each side.
double pixels_per_metre(const GovernedComponent& component, std::span<const Viewpoint> eyes, double look_ahead, double margin);

/// A box that nothing can be seen through: an orthonormal frame with half extents.
struct Occluder
{
    Pose pose;  ///< of the box's centre, W
    Vec3 half;  ///< m
};

/// Whether the box hides the whole ball from the eye: the ball is behind the box, and within the shadow that the box casts from the eye.
/// Source: Coorg and Teller, "Real-time occlusion culling for models with large occluders", I3D 1997 (supporting planes of one convex
/// occluder).
bool is_hidden(const Vec3& eye, const Ball& ball, const Occluder& box);

}  // namespace plab::governors
