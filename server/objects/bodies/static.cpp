#include "static.h"

namespace plab::bodies
{

void prepare_static(const StepContext& context, Row row, const StaticRows& statics, Bodies& bodies, Materials& materials)
{
    fill_unpushed(context.facet_of_row[row], Motion::Static, row, statics.body, bodies, materials);
}

}  // namespace plab::bodies
