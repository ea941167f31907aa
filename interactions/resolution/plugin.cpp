/// The plugin of resolutions: when two bodies meet within a step. A function for each type, with what the host and the manual need to know.
#include "plab/plugin.h"

#include "automatic.h"
#include "searches.h"

namespace
{

using namespace plab::resolution;
using plab::Phase;
using plab::Registrar;

constexpr const char* kLocate = "Resolution/Locate";
constexpr const char* kHalves = "halves the bracket around the time of impact";
constexpr const char* kAcceptsEnd = "accepts the end of the step";

void add_none(Registrar& registrar)
{
    registrar.component<NoneRows>("Resolution/None", "answers an impact at the end of the step in which it is detected")
        .command<accept_end>(Phase::Locate, kLocate, kAcceptsEnd)
        .accuracy("times of impact to one step: order 1")
        .strengths("no search at all; sufficient where contacts persist")
        .cost("nothing")
        .limits(
            "bodies overlap by up to speed x step when they meet, or pass through one another; times of impact "
            "are accurate to one step")
        .source("time stepping without location of events; the simplest algorithm, for comparison");
}

void add_bisection(Registrar& registrar)
{
    registrar
        .component<BisectionRows>("Resolution/Bisection",
                                  "finds the time of impact by bisection; the whole world is rewound for each trial")
        .command<bisect>(Phase::Locate, kLocate, kHalves)
        .locates()
        .order(1)
        .accuracy("times of impact to its tolerance")
        .strengths("makes no assumptions about forces and shapes")
        .cost("up to 48 advances of the whole world per impact")
        .limits("an overlap that begins and ends within one step is not detected")
        .source(
            "Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems, PhD thesis, UC Berkeley (1996), section "
            "2");
}

void add_local_bisection(Registrar& registrar)
{
    registrar
        .component<BisectionRows>("Resolution/LocalBisection",
                                  "finds the time of impact by bisection; only the group of touching bodies is rewound")
        .command<bisect>(Phase::Locate, kLocate, kHalves)
        .locates()
        .local()
        .order(1)
        .accuracy("times of impact to its tolerance")
        .strengths("as Resolution/Bisection, at the cost of the touching bodies only")
        .cost("up to 48 advances of the group of touching bodies per impact")
        .limits("an overlap that begins and ends within one step is not detected")
        .source("Mirtich, Timewarp Rigid Body Simulation, SIGGRAPH (2000): only the affected bodies are rewound");
}

void add_speculative(Registrar& registrar)
{
    registrar
        .component<SpeculativeRows>("Resolution/Speculative",
                                    "locates no events: gaps that may close within the step are passed to a manager as contacts")
        .command<accept_speculation>(Phase::Locate, kLocate, kAcceptsEnd)
        .speculates()
        .accuracy("times of impact to one step: order 1")
        .strengths("no tunnelling, without trials: suited to many fast bodies")
        .cost("additional contacts between nearby bodies; no trials")
        .limits(
            "needs a response by rows; bodies may stop at a surface that they would have passed beside (ghost "
            "contacts); times of impact are accurate to one step")
        .source("Catto, Continuous Collision, GDC (2013); Stewart and Trinkle, IJNME 39 (1996)");
}

void add_advancement(Registrar& registrar)
{
    registrar
        .component<AdvancementRows>("Resolution/ConservativeAdvancement",
                                    "advances to the next possible contact by gap / closing speed; never passes one")
        .command<advance_to_contact>(Phase::Locate, kLocate, "advances by the time that the gap allows")
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
}

void add_root(Registrar& registrar)
{
    registrar.component<RootRows>("Resolution/LocalRoot", "finds the first zero of the gap in a certified bracket; no tunnelling")
        .command<find_root>(Phase::Locate, kLocate, "safe Newton steps from the separated side; interpolation once the zero is bracketed")
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
}

void add_automatic(Registrar& registrar)
{
    registrar
        .component<AutomaticRows>("Resolution/Automatic",
                                  "locates the impacts of bodies whose island is small; those of others the manager answers")
        .command<choose_search>(Phase::Choose, "Resolution/Choose", "chooses how the impacts of the step are found")
        .command<find_root_automatically>(Phase::Locate, kLocate, "as Resolution/LocalRoot, where impacts are located")
        .locates()
        .local()
        .certifies()
        .adapts()
        .accuracy("that of LocalRoot, Speculative or None, as `resolved` says")
        .strengths("no choice has to be made: few bodies are exact, and many run in time")
        .cost("that of the algorithm in use, and one pass over the known pairs")
        .limits(
            "a heap whose size is near the bounds changes between algorithms; of several detections, the smallest bounds hold for all; "
            "with a response that has no manager, one large island ends the location of impacts for all")
        .source("server/docs/pace.md, for the bounds");
}

}  // namespace

PLAB_PLUGIN("resolution", registrar)
{
    add_none(registrar);
    add_bisection(registrar);
    add_local_bisection(registrar);
    add_speculative(registrar);
    add_advancement(registrar);
    add_root(registrar);
    add_automatic(registrar);
}
