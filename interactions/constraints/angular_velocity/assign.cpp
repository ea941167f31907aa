#include "angular_velocity/assign.h"

namespace plab::constraints
{

void AssignRows::describe(Schema& s)
{
    describe_driver(s);
    describe_driven(s).writes().exclusive();
    describe_fields(s);
}

void assign_driven(const StepContext& step, Rows which, const AssignRows& rows, ShaftMotion& motion)
{
    for (const Row row : which)
    {
        motion.begin(step.component_of_row[row], rows.driven[row]);
        motion.assign(rows.driven[row], rows.ratio[row].value * motion.rate(rows.driver[row]));
    }
}

}  // namespace plab::constraints
