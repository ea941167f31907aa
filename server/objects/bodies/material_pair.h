/// Material/Pair: the contact law of two materials. Friction: |f_t| <= friction f_n; restitution: v_n' = -restitution v_n.
#pragma once

#include <string>

#include "plab/registrar.h"

namespace plab::bodies
{

struct MaterialPairRows
{
    Column<std::string> a, b;
    Column<double> friction;                             ///< Coulomb's coefficient
    Column<double> restitution;                          ///< Newton's coefficient, 0 to 1
    Column<double> rolling_friction, spinning_friction;  ///< m, SurfaceLaw

    void describe(Schema& schema);
};

/// Refuses a pair for which a law exists already, in either order.
Result<void> connect_material_pair(Row row, const MaterialPairRows& pairs, Materials& materials);

}  // namespace plab::bodies
