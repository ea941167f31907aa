/// Painleve's paradox: rigid bodies with Coulomb friction may have no consistent sliding motion.
///
/// Imagine a slender rod that slides on one end, like a piece of chalk pushed over a board. A normal force at the tip pushes the tip away
/// from the board. The friction force that comes with it has a lever arm about the centre of mass and rotates the tip towards the board.
/// If the rod is long enough and mu large enough, the rotation wins: pressing harder drives the contact further in. The equations of
/// motion then have no solution for the acceleration, or two. Only an impulse that ends the sliding resolves the contact.
///
/// In contact coordinates, with the unit direction s of the tangential velocity and the collision matrix K (Delassus operator of the
/// contact), a sliding contact has du_n/dj_n = K_nn - mu K_nt . s. The paradox occurs if this is not positive. For a slender rod at angle
/// theta: 1 + 3 cos^2 - 3 mu sin cos <= 0, which is impossible for mu < 4/3.
///
/// Source: Champneys, Varkonyi, The Painleve paradox in contact mechanics, IMA J. Appl. Math. 81 (2016), section 2.
///
/// The paradox is impossible where friction times lever arm is small. For each body, with r from its centre of mass to the contact,
/// x = (r x n) . I^-1 (r x n) and y = (r x s) . I^-1 (r x s),
///
///   K_nn - mu K_nt . s  >=  1/m + x - mu sqrt(x y)  >=  sqrt(x) (2 / sqrt(m) - mu sqrt(y))
///
/// which is positive if mu^2 m y < 4. y is at most the largest eigenvalue of M(r) = [r]^T I^-1 [r], a convex function of r that is largest
/// at the corners of a box around the body. In the principal axes, with A = I^-1 and r = (x, y, z), M has the eigenvalue 0 and two with
///
///   sum      A_x (y^2 + z^2) + A_y (z^2 + x^2) + A_z (x^2 + y^2)
///   product  (A_y A_z x^2 + A_z A_x y^2 + A_x A_y z^2) |r|^2
///
/// So a cube has no paradox with mu < 0.94, and a brick of 2 x 1 x 1 none with mu < 0.86.
#pragma once

#include "plab/collision.h"
#include "plab/tables.h"

namespace plab::simulation
{

/// (K_nn - mu K_nt . s) / K_nn of a contact at the present velocities: <= 0 means the paradox. 1 if the contact does not slide in a step
/// of h (s), or if neither body can move.
double pressing_share(const Bodies& bodies, const Contact& contact, double h);

/// A bound of m y for contacts at points within `extents` (m, about C along the axes of B, may be infinite) and `radius` (m); 0 unless the
/// body is dynamic.
double wedging(const Bodies& bodies, std::uint32_t body, const Vec3& extents, double radius);
/// Whether pressing_share() is positive for certain, whatever the velocities; `wedging`: the larger one of the two bodies.
inline bool excludes_paradox(double friction, double wedging) { return friction * friction * wedging < 3.99; }

}  // namespace plab::simulation
