/// What plab-view does once its command line is understood.
#pragma once

#include "viewer/options.h"
#include "viewer/outcome.h"

namespace plab::view
{

/// `stop`: nobody wants the rest.
Outcome run(const Options& options, const link::Stop& stop);

}  // namespace plab::view
