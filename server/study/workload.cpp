// The size of a plan, computed before it is run.
#include <algorithm>

#include "study/study.h"

namespace plab::study
{

Workload workload_of(model::TypeSource& types, const Plan& plan)
{
    Workload out;
    double costliest = 0;  // s of one run
    for (const Combination& combination : plan.combinations)
    {
        ++out.cells;
        const auto scene = apply(plan.scene, types, combination.settings);
        if (!scene)
        {
            ++out.refused;
            continue;
        }
        if (plan.run.is_stopped()) continue;
        const double once = seconds_of_a_run(types, *scene, plan.run);
        out.seconds += once * (1 + plan.repeat);
        costliest = std::max(costliest, once);
    }
    // The algorithm that `auto` takes at a half and a quarter of its step as well; which one it is, is not decided here.
    if (plan.reference.kind == ReferencePlan::Kind::Auto) out.seconds += (1 + 2 + 4) * costliest;
    return out;
}

}  // namespace plab::study
