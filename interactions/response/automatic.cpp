#include "automatic.h"

namespace plab::response
{

void AutomaticRows::describe(Schema& s)
{
    s.role(manager, "manager", {Facet::Component}, "advances the islands of these contacts")
        .family("Manager/")
        .default_type("Manager/Automatic");
    // Where impacts cascade through a crowd, what remains after these sweeps is answered at once; few bodies need fewer.
    impulse.describe(s, 300);
}

void respond_automatically(const StepContext& context, Row row, AutomaticRows& rows, Bodies& bodies, Impact& impact)
{
    respond(context, row, rows.impulse, bodies, impact);
}

}  // namespace plab::response
