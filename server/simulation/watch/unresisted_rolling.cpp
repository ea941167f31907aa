#include "simulation/watch/unresisted_rolling.h"

namespace plab::simulation
{

void report_unresisted_rolling(const RunView& s, std::vector<Event>& events)
{
    if (!s.world.host().materials.any_resists_turning()) return;
    for (const Detector& d : s.stepper.detectors())
    {
        if (d.by_rows || (!d.by_force && !d.responds)) continue;
        Event e;
        e.tick = s.tick, e.time = s.time, e.kind = "contact.unresisted", e.severity = Severity::Warning, e.component = d.component;
        e.message = "a Material/Pair has rolling_friction or spinning_friction, but " + s.world.id_of(d.response) + " (" +
                    s.world.type_of(d.response)->info.name +
                    ") resists neither rolling nor spinning: Response/Automatic and Response/Rows do";
        events.push_back(std::move(e));
    }
}

}  // namespace plab::simulation
