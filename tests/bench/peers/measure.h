/// One measurement: a run of one engine through one case, in a process of its own.
#pragma once

#include <string>
#include <vector>

#include "bench/peers/case.h"

namespace plab::peers
{

enum class Outcome
{
    Done,
    Refused,  ///< the engine did not accept the scene
    Cut,      ///< took longer than the case allows
    Crashed,
};
const char* name_of(Outcome outcome);

struct Measurement
{
    Outcome outcome = Outcome::Done;
    std::string why;              ///< unless done
    std::vector<double> figures;  ///< per metric of the case, worst of its scenes; empty unless requested
    double cost = 0;              ///< ms of processor time per simulated second, mean of the case's scenes
    double memory = 0;            ///< MB, largest resident set of the process beyond that at its start
};

enum class Quantity
{
    Figures,  ///< sampled; costs as well
    Cost,     ///< the step loop alone
};

/// Runs in a child process, so that a crash, a hang or a full memory is a result and no run warms another's caches. The cost
/// is that of the step loop alone. A loop that takes more than half a second is timed by the processor clock
/// (CLOCK_PROCESS_CPUTIME_ID). That clock may count in ticks of 4 ms, so a shorter loop is made 3 to 20 times more, warm, in
/// pieces of about 1 ms timed by the steady clock, and each piece's least time counts: the one that no other process interrupted.
Measurement measure(const Case& which, const Run& run, Quantity quantity);

}  // namespace plab::peers
