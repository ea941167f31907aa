#pragma once

#include "plab/schema.h"

namespace plab::test
{

/// One row of a type, filled with its declared defaults.
template <class Rows>
struct OneRow
{
    Rows rows;
    Schema schema;

    OneRow()
    {
        rows.describe(schema);
        for (ColumnBase* c : schema.columns()) c->resize(1);
        for (const Field& f : schema.fields())
            if (type_of(f.fallback) == f.type) f.column->set(0, f.fallback);
    }
};

}  // namespace plab::test
