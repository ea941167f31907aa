/// Painleve's paradox: a body that slides on a point can be so long, and friction so large, that pressing there harder turns
/// it into the ground. Rigid bodies then have no acceleration, or two; only an impulse that ends the slip answers.
///
/// Contact coordinates, s = direction of slip, K = collision matrix: sliding, du_n/dj_n = K_nn - mu K_nt . s. The paradox is
/// there where this is not positive. A slender rod at angle theta: 1 + 3 cos^2 - 3 mu sin cos <= 0, not below mu = 4/3.
///
/// Source: Champneys, Varkonyi, The Painleve paradox in contact mechanics, IMA J. Appl. Math. 81 (2016), section 2.
#pragma once

#include "plab/collision.h"
#include "plab/tables.h"

namespace plab::simulation
{

/// (K_nn - mu K_nt . s) / K_nn of a contact at the present speeds; 1 where it does not slip in a step of h (s), or nothing moves there.
double pressing_share(const Bodies& bodies, const Contact& contact, double h);

}  // namespace plab::simulation
