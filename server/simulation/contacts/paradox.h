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
#pragma once

#include "plab/collision.h"
#include "plab/tables.h"

namespace plab::simulation
{

/// (K_nn - mu K_nt . s) / K_nn of a contact at the present velocities: <= 0 means the paradox. 1 if the contact does not slide in a step
/// of h (s), or if neither body can move.
double pressing_share(const Bodies& bodies, const Contact& contact, double h);

/// False if friction and levers are too small for the paradox, whatever the direction of sliding; cheaper than pressing_share().
///
/// With A = (r x n) . I^-1 (r x n) and B = (r x t) . I^-1 (r x t), a body contributes at least 1/m + A - mu sqrt(A B) to n . K j. As
/// 1/m + A >= 2 sqrt(A / m), that is positive if mu^2 m B < 4, and B is at most |r|^2 times the norm of I^-1.
bool may_jam(const Bodies& bodies, const Contact& contact);

}  // namespace plab::simulation
