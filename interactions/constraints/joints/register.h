/// The joints of this plugin.
#pragma once

#include "plab/registrar.h"

namespace plab::constraints
{

void register_joints(Registrar& registrar);

}  // namespace plab::constraints
