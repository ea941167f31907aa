/// "did you mean": finds the known names that are most similar to a given one.
#pragma once

#include "plab/names.h"

namespace plab::link
{

using plab::did_you_mean, plab::nearest_names;

}  // namespace plab::link
