/// Identifies the build that made a snapshot or a recording: another build may compute other digits (server/docs/determinism.md).
#pragma once

#include <string>

namespace plab::simulation
{

/// Version, SDK, compiler, flags that may change digits, and what libm depends on: its release and the processor's features. Two builds
/// of different sources may have the same name. It contains no path and no host name.
std::string build_name();

}  // namespace plab::simulation
