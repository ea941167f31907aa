/// A check for masses and inertias.
#pragma once

#include <string>

#include "plab/limits.h"
#include "plab/number_text.h"
#include "plab/result.h"

namespace plab::bodies
{

/// Refuses values that are not positive, or too small or large to compute with: the step divides by masses and inertias.
inline Result<void> check_positive(const std::string& name, double value)
{
    if (!(value > 0)) return reason(name + " must be positive, not " + number_text(value));
    if (!(value >= kLeastGiven && value <= kLargestGiven))
        return reason(name + " must lie between " + number_text(kLeastGiven) + " and " + number_text(kLargestGiven) + ", not " +
                      number_text(value));
    return {};
}

}  // namespace plab::bodies
