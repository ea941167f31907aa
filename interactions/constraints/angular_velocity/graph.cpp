#include "angular_velocity/graph.h"

namespace plab::constraints
{

void GraphRows::describe(Schema& s)
{
    describe_driver(s).writes();
    describe_driven(s).writes();
    describe_fields(s);
}

void connect(const StepContext& step, Rows which, const GraphRows& rows, RatioGraph& graph)
{
    for (const Row row : which) graph.add(step.component_of_row[row], rows.driver[row], rows.driven[row], rows.ratio[row]);
}

}  // namespace plab::constraints
