/// What a step thread that does not answer is at, in words.
#pragma once

#include <string>

#include "simulation/systems/progress.h"

namespace plab::publish
{

struct Busy
{
    std::string what;        ///< "" : nothing that takes long; else "step 12: locate, a swap's trial at step 3: advance"
    double seconds = 0;      ///< since when
    std::uint64_t work = 0;  ///< evaluations of forces, looks at contacts and events so far
};

/// What has been going on for `least` seconds at least. For any thread.
Busy busy_of(const simulation::Progress& progress, double least = 0.5);
/// The same of a look at something that may be over.
Busy words_of(const simulation::Progress::Look& look, std::uint64_t now_ns);
/// "step 12: locate, for 3.2 s, 51234 evaluations and looks".
std::string text_of(const Busy& busy);

}  // namespace plab::publish
