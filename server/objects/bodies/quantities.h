/// State/Quantities: numbers without a place in space that change at rates added by interactions: z' = r(t, z, ...). Temperatures,
/// concentrations, currents. The solver advances them together with the objects to which they are coupled.
#pragma once

#include "plab/registrar.h"

namespace plab::bodies
{

struct QuantitiesRows
{
    Column<Reals> values;
    Column<Ref> solver;

    void describe(Schema& schema);
};

/// Checks the initial values; from then on the host has the live ones.
Result<void> prepare_quantities(Row row, const QuantitiesRows& rows);

}  // namespace plab::bodies
