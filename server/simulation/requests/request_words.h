/// Words for what a reply says, the same on the wire and in log lines.
#pragma once

#include "simulation/requests/requests.h"

namespace plab::simulation
{

constexpr const char* name_of(Fate fate)
{
    switch (fate)
    {
        case Fate::Kept:
            return "kept";
        case Fate::Converted:
            return "converted";
        case Fate::Given:
            return "given";
        case Fate::Fresh:
            return "fresh";
        case Fate::Lost:
            return "lost";
    }
    return "";
}

/// "made: 2 objects, 0.3 ms", "given up after 5.1 ms (budget 5 ms)", "none".
std::string text_of(const TrialReport& trial);

}  // namespace plab::simulation
