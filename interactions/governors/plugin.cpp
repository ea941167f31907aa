#include "plab/plugin.h"

#include "by_budget.h"
#include "by_error.h"
#include "by_viewers.h"

PLAB_PLUGIN("governors", registrar)
{
    using namespace plab::governors;
    using plab::Phase;
    constexpr const char* kChoose = "Governor/Choose";
    registrar.component<DistanceRows>("Governor/Distance", "chooses levels of detail by the distance of the nearest viewer")
        .family("Governor")
        .command<choose_by_distance>(Phase::Decide, kChoose, "chooses levels")
        .cost("about 0.1 us for each component and viewer in a look")
        .source("J. Clark, Hierarchical geometric models for visible surface algorithms, CACM 19(10), 1976");
    registrar.component<VisibilityRows>("Governor/Visibility", "chooses levels of detail by the size of what viewers see")
        .family("Governor")
        .command<choose_by_sight>(Phase::Decide, kChoose, "chooses levels")
        .limits("occluders are the boxes of bodies, each by itself: what two boxes hide together counts as seen")
        .source("Funkhouser and Sequin, Adaptive display algorithm for interactive frame rates, SIGGRAPH 1993");
    registrar.component<BudgetRows>("Governor/Budget", "holds the cost of a step below a budget of processor time")
        .family("Governor")
        .command<keep_budget>(Phase::Decide, kChoose, "chooses levels")
        .limits("the cost of a step is measured by the clock, so two runs differ; the measurements are recorded, and a replay does not");
    registrar.component<ErrorRows>("Governor/Error", "the cheapest level whose error stays below a bound")
        .family("Governor")
        .command<keep_error>(Phase::Decide, kChoose, "chooses levels")
        .cost("two to four trial steps of the island of each component that is measured")
        .limits(
            "the error is that of the coming step, continued over the interval: an impact that comes later is not foreseen; what the "
            "most exact level does wrong is not seen")
        .source("safety factor: Robbins and Monro, A stochastic approximation method, Ann. Math. Stat. 22, 1951");
}
