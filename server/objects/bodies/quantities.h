/// State/Quantities: numbers that are no place in space and change at rates that interactions add: z' = r(t, z, ...).
/// Temperatures, concentrations, currents. Its solver advances them with whatever they are coupled to.
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

/// Checks the values; they are the host's from here on.
Result<void> prepare_quantities(Row row, const QuantitiesRows& rows);

}  // namespace plab::bodies
