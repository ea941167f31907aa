/// The plugin of rules: interactions that set themselves up where two objects meet.
#include "plab/plugin.h"

#include "connector.h"
#include "rule.h"

PLAB_PLUGIN("rules", registrar)
{
    using namespace plab::rules;
    using plab::Phase;
    registrar.component<ConnectorRows>("Connector/Frame", "a named place on an object, at which rules look")
        .strengths("tags an object, or says where its axle, bore or wheel is");
    registrar.component<RuleRows>("Rule/Pair", "adds components between two objects that meet or come near")
        .family("Rule")
        .command<&prepare_rule>(Phase::Prepare, "Rule/Prepare", "checks the template and the code")
        .command<&apply_rules>(Phase::Decide, "Rule/Apply", "asks for what has to be added or removed")
        .cost("a comparison per matching object and step; pairs are found by a grid when one has moved by an eighth of the reach")
        .limits("looks at frames, not at surfaces; what scripts change about parameters is seen with the next request")
        .source("A. Witkin, M. Gleicher, W. Welch, Interactive dynamics, SIGGRAPH 1990");
}
