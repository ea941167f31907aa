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
/// which is positive if mu^2 y m < 4, and y is at most |r|^2 times the largest eigenvalue of I^-1. A cube has no paradox with mu < 0.94.
#pragma once

#include "plab/collision.h"
#include "plab/tables.h"

namespace plab::simulation
{

/// (K_nn - mu K_nt . s) / K_nn of a contact at the present velocities: <= 0 means the paradox. 1 if the contact does not slide in a step
/// of h (s), or if neither body can move.
double pressing_share(const Bodies& bodies, const Contact& contact, double h);

/// 1/m^2: mass times (a bound of) the largest eigenvalue of the inverse inertia of a body; 0 unless it is dynamic.
double wedging(const Bodies& bodies, std::uint32_t body);
/// Whether pressing_share() is positive for certain, whatever the velocities. `reach`: wedging() times the square of the distance of the
/// contact from the centre of mass, the larger one of the two bodies.
inline bool excludes_paradox(double friction, double reach) { return friction * friction * reach < 3.99; }

}  // namespace plab::simulation
