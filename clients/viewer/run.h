/// What plab-view does once its command line is understood.
#pragma once

#include <string>

#include "viewer/interrupt.h"
#include "viewer/options.h"

namespace plab::view
{

/// Exit codes, as those of plabctl.
enum class Exit : int
{
    Done = 0,
    Failed = 1,
    Usage = 2,
    NoServer = 3,
    Interrupted = 130,
};

struct Outcome
{
    Exit exit = Exit::Done;
    std::string message;  ///< for standard error; empty: nothing to say
};

Outcome run(const Options& options, const Interrupt& interrupt);

}  // namespace plab::view
