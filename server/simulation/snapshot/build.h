/// Which build a snapshot or a recording is of: another one may give other digits (server/docs/determinism.md).
#pragma once

#include <string>

namespace plab::simulation
{

/// Version, SDK, compiler, flags that may change digits, and what libm goes by: its release and the processor's features. Two
/// builds of different sources may say the same. Nothing of it names a path or a host.
std::string build_name();

}  // namespace plab::simulation
