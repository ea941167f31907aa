/// How a run ends before it is over.
#pragma once

#include <chrono>

namespace plab::daemon
{

/// What is in work when the end is asked for has this long to come to its end before it is given up.
inline constexpr std::chrono::milliseconds kGrace(250);
/// A step was given up: the run ends where it began.
inline constexpr int kExitGaveUp = 3;

}  // namespace plab::daemon
