#include "speculative.h"

namespace plab::resolution
{

void describe_acceleration(Schema& s, Column<double>& acceleration)
{
    s.param(acceleration, "acceleration", unit::metre_per_second2,
            "largest expected acceleration by forces; determines how far a body at rest may move in a step")
        .or_else(20)
        .not_negative();
}

void SpeculativeRows::describe(Schema& s) { describe_acceleration(s, acceleration); }

void accept_speculation(const StepContext&, Row, const SpeculativeRows&, Trial& trial) { trial.decision = Trial::Decision::Accept; }

}  // namespace plab::resolution
