/// What the tests of sliding share.
#pragma once

#include <vector>

#include "support/scene.h"

namespace plab::test
{

/// Halving the step divides the error by four, except where the first step is too coarse.
inline void check_order(const std::vector<double>& errors, double finest)
{
    for (std::size_t i = 1; i < errors.size(); ++i)
    {
        CAPTURE(i);
        CAPTURE(errors[i - 1]);
        CAPTURE(errors[i]);
        CHECK(errors[i] < 0.3 * errors[i - 1]);
    }
    CHECK(errors.back() < finest);
}

}  // namespace plab::test
