/// One cell in a process of its own: whatever it does, a verdict comes back in bounded time.
#pragma once

#include "case.h"

namespace plab::stability
{

/// Runs the cell. A crash or a hang is an outcome: Silent, with the signal's name.
Outcome run_cell(const Case& which, std::size_t algorithm, std::size_t value);

}  // namespace plab::stability
