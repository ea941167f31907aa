#include "plab/plugin.h"
#include "advancement.h"
#include "automatic.h"
#include "bisection.h"
#include "root.h"
#include "speculative.h"

PLAB_PLUGIN("resolution", registrar)
{
    using namespace plab;
    using namespace plab::resolution;
    registrar.component<NoneRows>("Resolution/None", "answers an impact at the end of the step in which it is detected")
        .command<accept_end>(Phase::Locate, "Resolution/Locate", "accepts the end of the step")
        .accuracy("times of impact to one step: order 1")
        .strengths("no search at all; sufficient where contacts persist")
        .cost("nothing")
        .limits(
            "bodies overlap by up to speed x step when they meet, or pass through one another; times of impact "
            "are accurate to one step")
        .source("time stepping without location of events; the simplest algorithm, for comparison");
    registrar
        .component<BisectionRows>("Resolution/Bisection",
                                  "finds the time of impact by bisection; the whole world is rewound for each trial")
        .command<bisect>(Phase::Locate, "Resolution/Locate", "halves the bracket around the time of impact")
        .locates()
        .order(1)
        .accuracy("times of impact to its tolerance")
        .strengths("makes no assumptions about forces and shapes")
        .cost("up to 48 advances of the whole world per impact")
        .limits("an overlap that begins and ends within one step is not detected")
        .source(
            "Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems, PhD thesis, UC Berkeley (1996), section "
            "2");
    registrar
        .component<BisectionRows>("Resolution/LocalBisection",
                                  "finds the time of impact by bisection; only the group of touching bodies is rewound")
        .command<bisect>(Phase::Locate, "Resolution/Locate", "halves the bracket around the time of impact")
        .locates()
        .local()
        .order(1)
        .accuracy("times of impact to its tolerance")
        .strengths("as Resolution/Bisection, at the cost of the touching bodies only")
        .cost("up to 48 advances of the group of touching bodies per impact")
        .limits("an overlap that begins and ends within one step is not detected")
        .source("Mirtich, Timewarp Rigid Body Simulation, SIGGRAPH (2000): only the affected bodies are rewound");
    registrar
        .component<SpeculativeRows>("Resolution/Speculative",
                                    "locates no events: gaps that may close within the step are passed to a manager as contacts")
        .command<accept_speculation>(Phase::Locate, "Resolution/Locate", "accepts the end of the step")
        .speculates()
        .accuracy("times of impact to one step: order 1")
        .strengths("no tunnelling, without trials: suited to many fast bodies")
        .cost("additional contacts between nearby bodies; no trials")
        .limits(
            "needs a response by rows; bodies may stop at a surface that they would have passed beside (ghost "
            "contacts); times of impact are accurate to one step")
        .source("Catto, Continuous Collision, GDC (2013); Stewart and Trinkle, IJNME 39 (1996)");
    registrar
        .component<AdvancementRows>("Resolution/ConservativeAdvancement",
                                    "advances to the next possible contact by gap / closing speed; never passes one")
        .command<advance_to_contact>(Phase::Locate, "Resolution/Locate", "advances by the time that the gap allows")
        .locates()
        .local()
        .certifies()
        .order(1)
        .accuracy("times of impact to its tolerance")
        .strengths("no tunnelling; exact for bodies that approach head-on")
        .cost(
            "one distance query per step towards the contact: few for head-on approaches, many where bodies pass "
            "close to one another or spin")
        .limits(
            "slow where bodies graze or spin (resolution.grazing); the bounds come from the states at both ends "
            "of a piece, so faster changes of a force are not covered")
        .source("Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems, PhD thesis, UC Berkeley (1996), section 2.3");
    registrar.component<RootRows>("Resolution/LocalRoot", "finds the first zero of the gap in a certified bracket; no tunnelling")
        .command<find_root>(Phase::Locate, "Resolution/Locate",
                            "safe Newton steps from the separated side; interpolation once the zero is bracketed")
        .locates()
        .local()
        .certifies()
        .order(2)
        .accuracy("times of impact to rounding")
        .strengths("no tunnelling; finds grazing impacts and those of spinning corners with the fewest distance queries")
        .cost("1 to 7 distance queries per impact; one for a pair that only comes near")
        .limits(
            "the bounds come from the states at both ends of a piece, so faster changes of a force are not "
            "covered; bodies with several shapes are bounded by their speed in any direction, which is slow "
            "where they graze")
        .source(
            "Oliveira, Takahashi, ACM TOMS 47 (2020) for brackets that are never worse than bisection; Zhang, "
            "Redon, Lee, Kim, SIGGRAPH (2007) for second-order bounds");
    registrar
        .component<AutomaticRows>("Resolution/Automatic",
                                  "locates impacts while islands of touching bodies are small; otherwise the manager answers them")
        .command<choose_search>(Phase::Choose, "Resolution/Choose", "chooses how the impacts of the step are found")
        .command<find_root_automatically>(Phase::Locate, "Resolution/Locate", "as Resolution/LocalRoot, where impacts are located")
        .locates()
        .local()
        .certifies()
        .adapts()
        .accuracy("that of LocalRoot, Speculative or None, as `resolved` says")
        .strengths("no choice has to be made: few bodies are exact, and many run in time")
        .cost("that of the algorithm in use, and one pass over the known pairs")
        .limits(
            "one island that is large ends the location of impacts for all bodies of the detection; a heap whose "
            "size is near the bounds changes between algorithms")
        .source("server/docs/pace.md, for the bounds");
}
