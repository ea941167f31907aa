#include "material_pair.h"

namespace plab::bodies
{

void MaterialPairRows::describe(Schema& schema)
{
    schema.param(a, "a", unit::one, "a material's name; empty: bodies without material");
    schema.param(b, "b", unit::one, "the other material's name; may be the same");
    schema.param(friction, "friction", unit::one, "Coulomb's coefficient").not_negative();
    schema.param(restitution, "restitution", unit::one, "ratio of the normal speeds after and before an impact").not_negative().at_most(1);
    schema
        .param(rolling_friction, "rolling_friction", unit::metre,
               "a couple of at most so much times the normal force resists rolling, where a manager holds the contact")
        .or_else(0)
        .not_negative();
    schema.param(spinning_friction, "spinning_friction", unit::metre, "likewise spinning about the normal").or_else(0).not_negative();
}

Result<void> connect_material_pair(Row row, const MaterialPairRows& pairs, Materials& materials)
{
    const std::uint32_t a = materials.intern(pairs.a[row]);
    const std::uint32_t b = materials.intern(pairs.b[row]);
    if (materials.add_pair(a, b, {pairs.friction[row], pairs.restitution[row], pairs.rolling_friction[row], pairs.spinning_friction[row]}))
        return {};
    return reason("materials '" + pairs.a[row] + "' and '" + pairs.b[row] +
                  "' have a law already; a pair must be given once, in either order");
}

}  // namespace plab::bodies
