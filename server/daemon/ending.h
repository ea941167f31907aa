/// How a run is ended early.
#pragma once

#include <chrono>
#include <cstdio>

#include "plab/result.h"

namespace plab::daemon
{

/// Work in progress when the end is requested may continue for this long before it is abandoned.
inline constexpr std::chrono::milliseconds kGrace(250);
/// A step was abandoned: the run ends at the state before that step.
inline constexpr int kExitGaveUp = 3;

/// Prints each error on a line of standard error, and returns the exit code of a program that refuses to run.
inline int fail(const Errors& errors)
{
    for (const Error& e : errors) (void)std::fprintf(stderr, "%s\n", e.text().c_str());
    return 1;
}

}  // namespace plab::daemon
