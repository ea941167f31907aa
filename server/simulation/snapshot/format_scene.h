/// The part of a snapshot file that holds its scene: a SceneSpec as sections, exactly as it is in memory.
///
/// It is not stored as a blueprint, because a blueprint keeps only the meaning of a scene. A later swap or reset also depends on how the
/// scene was written: whether a list of commands was selected explicitly or is simply all that the type can do, and which parts were
/// generated.
#pragma once

#include <string>
#include <vector>

#include "model/scene.h"
#include "model/type_registry.h"
#include "simulation/snapshot/sections.h"

namespace plab::simulation
{

/// Sections "PREFIXsettings", "PREFIXcomponents", ...
std::vector<Section> write_scene(const std::string& prefix, const model::SceneSpec& scene);

Result<model::SceneSpec> read_scene(const std::string& prefix, const std::vector<Section>& sections);

/// Checks whether a world can be made from a scene of external origin: types, values, roles and parents must fit together.
Errors check_scene(const model::SceneSpec& scene, model::TypeSource& types);

/// The section of that name; an empty one if it does not exist.
const Section& find_section(const std::vector<Section>& sections, const std::string& name);

}  // namespace plab::simulation
