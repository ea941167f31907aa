/// How plab-view ends.
#pragma once

#include <string>

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

}  // namespace plab::view
