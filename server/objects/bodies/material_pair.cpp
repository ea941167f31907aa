#include "material_pair.h"

namespace plab::bodies
{

void MaterialPairRows::describe(Schema& schema)
{
    schema.param(a, "a", unit::one, "a material's name; empty: bodies without material");
    schema.param(b, "b", unit::one, "the other material's name; may be the same");
    schema.param(friction, "friction", unit::one, "Coulomb's coefficient").not_negative();
    schema.param(restitution, "restitution", unit::one, "ratio of the normal speeds after and before an impact").not_negative().at_most(1);
}

Result<void> connect_material_pair(Row row, const MaterialPairRows& pairs, Materials& materials)
{
    const std::uint32_t a = materials.intern(pairs.a[row]);
    const std::uint32_t b = materials.intern(pairs.b[row]);
    if (materials.add_pair(a, b, {pairs.friction[row], pairs.restitution[row]})) return {};
    return reason("materials '" + pairs.a[row] + "' and '" + pairs.b[row] +
                  "' have a law already; a pair must be given once, in either order");
}

}  // namespace plab::bodies
