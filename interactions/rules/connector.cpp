#include "connector.h"

namespace plab::rules
{

void ConnectorRows::describe(Schema& schema)
{
    schema.role(object, "object", {Facet::Body, Facet::Shaft}, "the object on which it is");
    schema.param(kind, "kind", unit::one, "what it is, for the patterns of rules: axle, bore, wheel, or any tag");
    schema.param(position, "position", unit::metre, "origin of its frame, in the object's").or_else({});
    schema.param(orientation, "orientation", unit::one, "turns its axes into the object's").or_else({});
    schema.param(radius, "radius", unit::metre, "of the wheel, axle or bore; 0: that of the object's shape").or_else(0).not_negative();
    schema
        .param(tolerance, "tolerance", unit::metre,
               "how far it may be from where a relation asks for, if that is more than the rule's own tolerance")
        .or_else(0)
        .not_negative();
}

}  // namespace plab::rules
