/// Texts for the contents of a reply, the same on the wire and in log lines.
#pragma once

#include "simulation/requests/requests.h"

namespace plab::simulation
{

constexpr const char* name_of(FieldTransfer transfer)
{
    switch (transfer)
    {
        case FieldTransfer::Kept:
            return "kept";
        case FieldTransfer::Converted:
            return "converted";
        case FieldTransfer::Given:
            return "given";
        case FieldTransfer::Fresh:
            return "fresh";
        case FieldTransfer::Lost:
            return "lost";
    }
    return "";
}

/// "made: 2 objects, 0.3 ms", "given up after 5.1 ms (budget 5 ms)", "none"; of a swap with text_of_costs().
std::string text_of(const TrialReport& trial);
/// Whether the costs of a step with the old and with the new components differ significantly, and by more than memory placement explains:
/// when one and the same swap is repeated, its medians vary by up to a quarter, or by half a microsecond.
bool costs_differ(const Spread& with_old, const Spread& with_new);
/// The cost of a step with the new and with the old components, as medians with their quartiles, and the difference if it is significant:
/// "a step costs 17.1 us (16.9 to 17.5), 8.6 us (8.5 to 8.8) before: 8.5 us more". Empty if nothing was measured.
std::string text_of_costs(const TrialReport& trial);

}  // namespace plab::simulation
