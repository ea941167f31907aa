/// Groups similar errors, of which a repetition may cause thousands.
#pragma once

#include "plab/result.h"

namespace plab::model
{

/// Keeps the first few errors at one place whose texts differ only in numbers, and then states how many more there are, so that
/// none disappears silently. The order is kept.
Errors first_of_alike(Errors errors);

}  // namespace plab::model
