/// What plab-view does once its command line is understood.
#pragma once

#include "viewer/options.h"
#include "viewer/outcome.h"

namespace plab::view
{

/// `stop`: nobody wants the rest.
Outcome run(const ViewerOptions& options, const link::Stop& stop);

}  // namespace plab::view
