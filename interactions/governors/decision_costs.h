/// What exchanges and trials of levels cost, learnt from what was measured of them.
#pragma once

#include "plab/value.h"

namespace plab::governors
{

/// s: what is shorter was not measured, and its square would underflow.
inline constexpr double kLeastCost = 1e-12;

/// `measured`: how many components were exchanged, s, and s of the step after that; it is emptied. `step`: s, of the usual step. The step
/// after an exchange is longer, and that is counted with it.
///
/// Learns a fixed cost f and one for each component, e. The first measurement is shared between the two, which are then known as little as
/// can be, but their sum is known. (f + n e) / (1 + n) is a cost by fractions, as the cost model learns it: two exchanges of different
/// numbers of components tell both.
void learn_exchange(Reals& learnt, Reals& measured, double step);

/// The same of trials: s, for each level. What was measured last counts at once if it was longer, up to twice as much, and only slowly if
/// it was shorter: a trial must not make a step too long.
void learn_trial(double& learnt, Reals& measured, double step);

}  // namespace plab::governors
