/// State/Static: a body that never moves.
#pragma once

#include "body_columns.h"

namespace plab::bodies
{

struct StaticRows
{
    BodyColumns body;

    void describe(Schema& schema) { body.describe(schema); }
};

void prepare_static(const StepContext& context, Row row, const StaticRows& statics, Bodies& bodies, Materials& materials);

}  // namespace plab::bodies
