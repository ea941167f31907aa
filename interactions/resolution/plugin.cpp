#include "plab/plugin.h"
#include "bisection.h"

PLAB_PLUGIN("resolution", registrar)
{
    using namespace plab;
    using namespace plab::resolution;
    registrar.component<NoneRows>("Resolution/None", "answers an impact at the end of the step in which it is seen")
        .command<accept_end>(Phase::Locate, "Resolution/Locate", "takes the end of the step")
        .cost("nothing")
        .limits("bodies overlap by up to speed x step when they meet; times of impact are right to one step");
    registrar
        .component<BisectionRows>("Resolution/Bisection", "finds the time of impact by halving; the whole world is rewound for each trial")
        .command<bisect>(Phase::Locate, "Resolution/Locate", "halves the bracket of the time of impact")
        .locates()
        .order(1)
        .cost("up to 48 advances of the whole world per impact")
        .limits("an overlap that begins and ends inside one step is not seen")
        .source(
            "Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems, PhD thesis, UC Berkeley (1996), section "
            "2");
    registrar
        .component<BisectionRows>("Resolution/LocalBisection", "finds the time of impact by halving; only the touched group is rewound")
        .command<bisect>(Phase::Locate, "Resolution/Locate", "halves the bracket of the time of impact")
        .locates()
        .local()
        .order(1)
        .cost("up to 48 advances of the touched group per impact")
        .limits("an overlap that begins and ends inside one step is not seen")
        .source("Mirtich, Timewarp Rigid Body Simulation, SIGGRAPH (2000): only what is touched goes back");
}
