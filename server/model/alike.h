/// Errors of one kind that a repetition makes by the thousand.
#pragma once

#include "plab/result.h"

namespace plab::model
{

/// The first few of those that stand at one place and say the same but for numbers, and then how many more there are: none is lost without
/// a word. The order stays.
Errors first_of_alike(Errors errors);

}  // namespace plab::model
