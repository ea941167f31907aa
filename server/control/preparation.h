/// What can be done for a request before it takes effect, on another thread than the one that steps.
///
/// Only values are made here: plugins are loaded, blueprints compiled, ids and participants resolved. The rows of components are made and
/// prepared on the step thread, because the Prepare of a plugin reads and writes the tables of the running scene.
#pragma once

#include <memory>

#include "model/compile.h"
#include "simulation/requests/requests.h"

namespace plab::control
{

/// Loads the plugins of the types that the request names, and of the parts that a swap may have to make.
void load_types(const simulation::Request& request, model::TypeSource& types);

/// Whether prepare_additions() has anything to do.
bool has_additions(const simulation::Request& request);

/// Compiles what the request adds to the present scene (null: there is none). Only what comes first in the request can be compiled in
/// advance: the scene to which a later operation adds is made by those before it. The rest is compiled when the request takes effect, and
/// so is everything if the scene has changed by then (PreparedAddition::fits).
void prepare_additions(simulation::Request& request, model::TypeSource& types, const std::shared_ptr<const model::SceneSpec>& scene,
                       const model::CompileLimits& limits);

}  // namespace plab::control
