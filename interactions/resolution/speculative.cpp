#include "speculative.h"

namespace plab::resolution
{

void SpeculativeRows::describe(Schema& s)
{
    s.param(acceleration, "acceleration", unit::metre_per_second2,
            "largest expected acceleration by forces; determines how far a body at rest may move in a step")
        .or_else(20)
        .not_negative();
}

void accept_speculation(const StepContext&, Row, const SpeculativeRows&, Trial& trial) { trial.decision = Trial::Decision::Accept; }

}  // namespace plab::resolution
