#include "publish/busy.h"

#include <cstdio>

#include "simulation/costs/clock.h"
#include "simulation/step/step_tree.h"

namespace plab::publish
{

Busy words_of(const simulation::Progress::Reading& reading, std::uint64_t now_ns)
{
    Busy out;
    const std::string step = "step " + std::to_string(reading.step);
    switch (reading.activity)
    {
        case simulation::Activity::Nothing:
        case simulation::Activity::Step:
            out.what = step;
            break;
        case simulation::Activity::TrialOfOld:
            out.what = "trial of a swap at " + step + ", with the old";
            break;
        case simulation::Activity::TrialOfNew:
            out.what = "trial of a swap at " + step + ", with the new";
            break;
        case simulation::Activity::Again:
            out.what = step + " again";
            break;
    }
    out.what += ": " + std::string(simulation::kStepTree[reading.node].name);
    out.seconds = now_ns > reading.since_ns ? 1e-9 * static_cast<double>(now_ns - reading.since_ns) : 0;
    out.work = reading.work;
    return out;
}

Busy busy_of(const simulation::Progress& progress, double least)
{
    const simulation::Progress::Reading reading = progress.read();
    if (reading.activity == simulation::Activity::Nothing) return {};
    Busy out = words_of(reading, simulation::now_ns());
    return out.seconds < least ? Busy{} : out;
}

std::string text_of(const Busy& busy)
{
    char time[32];
    std::snprintf(time, sizeof time, "%.1f", busy.seconds);
    return busy.what + ", for " + time + " s, " + std::to_string(busy.work) + " evaluations and queries";
}

}  // namespace plab::publish
