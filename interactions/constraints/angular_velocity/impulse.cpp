#include "angular_velocity/impulse.h"

namespace plab::constraints
{

void ImpulseRows::describe(Schema& s)
{
    describe_driver(s).writes();
    describe_driven(s).writes();
    describe_fields(s);
}

void exchange_impulses(const StepContext& step, Rows which, const ImpulseRows& rows, ShaftMotion& motion)
{
    for (const Row row : which)
    {
        const Ref a = rows.driver[row];
        const Ref b = rows.driven[row];
        const double f = rows.ratio[row].value;
        motion.begin(step.component_of_row[row], b);
        const double mobility = motion.mobility(b) + f * f * motion.mobility(a);
        if (mobility == 0) continue;  // both are prescribed: the error remains, and the host reports it
        const double lambda = -(motion.rate(b) - f * motion.rate(a)) / mobility;
        motion.apply(b, lambda);
        motion.apply(a, -f * lambda);
    }
}

}  // namespace plab::constraints
