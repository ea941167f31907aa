/// Describes in words what the step thread is doing while it does not answer.
#pragma once

#include <string>

#include "simulation/systems/progress.h"

namespace plab::publish
{

struct Busy
{
    std::string what;        ///< "": nothing that takes long; otherwise such as "step 12: locate, a swap's trial at step 3: advance"
    double seconds = 0;      ///< since when
    std::uint64_t work = 0;  ///< evaluations of forces, queries of contacts and events so far
};

/// The activity that has lasted for at least `least` seconds. For any thread.
Busy busy_of(const simulation::Progress& progress, double least = 0.5);
/// The same for a given observation, which may be over by now.
Busy words_of(const simulation::Progress::Reading& reading, std::uint64_t now_ns);
/// "step 12: locate, for 3.2 s, 51234 evaluations and queries".
std::string text_of(const Busy& busy);

}  // namespace plab::publish
