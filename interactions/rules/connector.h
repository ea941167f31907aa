/// Connector/Frame: a named place on an object, at which rules look.
///
/// X_WF = X_WB X_BF for a body, X_WA turned by its angle times X_AF for a shaft. The z axis is that of the axle, bore or wheel.
#pragma once

#include <string>

#include "plab/registrar.h"

namespace plab::rules
{

struct ConnectorRows
{
    Column<Ref> object;
    Column<std::string> kind;
    Column<Vec3> position;     ///< p_BF, m
    Column<Quat> orientation;  ///< q_BF
    Column<double> radius;     ///< m
    Column<double> tolerance;  ///< m

    void describe(Schema& schema);
};

}  // namespace plab::rules
