#include "plab/plugin.h"
#include "advancement.h"
#include "bisection.h"
#include "root.h"
#include "speculative.h"

PLAB_PLUGIN("resolution", registrar)
{
    using namespace plab;
    using namespace plab::resolution;
    registrar.component<NoneRows>("Resolution/None", "answers an impact at the end of the step in which it is seen")
        .command<accept_end>(Phase::Locate, "Resolution/Locate", "takes the end of the step")
        .accuracy("times of impact to one step: order 1")
        .strengths("nothing is searched for: enough where contacts stay")
        .cost("nothing")
        .limits("bodies overlap by up to speed x step when they meet, or pass through one another; times of impact are right to one step")
        .source("time stepping without location of events; the lowest algorithm, to compare with");
    registrar
        .component<BisectionRows>("Resolution/Bisection", "finds the time of impact by halving; the whole world is rewound for each trial")
        .command<bisect>(Phase::Locate, "Resolution/Locate", "halves the bracket of the time of impact")
        .locates()
        .order(1)
        .accuracy("times of impact to its tolerance")
        .strengths("asks nothing of forces and shapes")
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
        .accuracy("times of impact to its tolerance")
        .strengths("as Resolution/Bisection, at the cost of who touches")
        .cost("up to 48 advances of the touched group per impact")
        .limits("an overlap that begins and ends inside one step is not seen")
        .source("Mirtich, Timewarp Rigid Body Simulation, SIGGRAPH (2000): only what is touched goes back");
    registrar
        .component<SpeculativeRows>("Resolution/Speculative",
                                    "locates nothing: gaps that may close within the step are contacts for a manager")
        .command<accept_speculation>(Phase::Locate, "Resolution/Locate", "takes the end of the step")
        .speculates()
        .accuracy("times of impact to one step: order 1")
        .strengths("nothing tunnels, without trials: many fast bodies")
        .cost("contacts of bodies that are near; no trials")
        .limits(
            "needs a response by rows; bodies stop at a surface ahead of them though they would have passed beside it (ghost contacts); "
            "times of impact are right to one step")
        .source("Catto, Continuous Collision, GDC (2013); Stewart and Trinkle, IJNME 39 (1996)");
    registrar
        .component<AdvancementRows>("Resolution/ConservativeAdvancement",
                                    "steps to the next possible contact by gap / closing speed; never passes one")
        .command<advance_to_contact>(Phase::Locate, "Resolution/Locate", "goes on by what the gap allows")
        .locates()
        .local()
        .certifies()
        .order(1)
        .accuracy("times of impact to its tolerance")
        .strengths("nothing tunnels; exact for what flies head-on")
        .cost("one look per step towards the contact: a few head-on, many where bodies pass close by or spin")
        .limits(
            "slow where bodies graze or spin (resolution.grazing); bounds come from the states at both ends of a piece: what a force does "
            "faster than that is not seen")
        .source("Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems, PhD thesis, UC Berkeley (1996), section 2.3");
    registrar
        .component<RootRows>("Resolution/LocalRoot",
                             "finds the first zero of the gap, in a bracket of which it is certain; nothing tunnels")
        .command<find_root>(Phase::Locate, "Resolution/Locate",
                            "safe Newton steps from the clear side; a zero in a bracket where there is one")
        .locates()
        .local()
        .certifies()
        .order(2)
        .accuracy("times of impact to rounding")
        .strengths("nothing tunnels; grazing hits and spinning corners are found, in the fewest looks")
        .cost("1 to 7 looks per impact; pairs that come near one another cost one")
        .limits(
            "bounds come from the states at both ends of a piece: what a force does faster than that is not seen; bodies of several shapes "
            "are bounded by the speed in any direction, which is slow where they graze")
        .source(
            "Oliveira, Takahashi, ACM TOMS 47 (2020) for brackets that never do worse than halving; Zhang, Redon, Lee, Kim, SIGGRAPH "
            "(2007) for bounds "
            "of "
            "second order");
}
