/// The work of plab-view after its command line is parsed.
#pragma once

#include "viewer/options.h"

namespace plab::view
{

/// `stop`: the rest is not wanted.
Outcome run(const ViewerOptions& options, const link::Stop& stop);

}  // namespace plab::view
