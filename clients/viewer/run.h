/// What plab-view does once its command line is understood.
#pragma once

#include <string>

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
    Interrupted = 130,  ///< by a signal; main() gives 128 + its number
};

struct Outcome
{
    Exit exit = Exit::Done;
    std::string message;  ///< for standard error; empty: nothing to say
};

/// `stop`: nobody wants the rest.
Outcome run(const Options& options, const link::Stop& stop);

}  // namespace plab::view
