#include "quantities.h"

#include "body_columns.h"

namespace plab::bodies
{

void QuantitiesRows::describe(Schema& schema)
{
    schema.state(values, "values", unit::one, "the numbers, in units of the scene's own").hosted();
    describe_solver(solver, schema);
}

Result<void> prepare_quantities(Row row, const QuantitiesRows& rows)
{
    if (rows.values[row].empty()) return reason("values must hold at least one number");
    return {};
}

}  // namespace plab::bodies
