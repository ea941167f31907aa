/// The part of a snapshot file that is its scene: a SceneSpec as sections, exactly as it is in memory.
///
/// Not as a blueprint: that would say what the scene means, but a swap or a reset later depends on how it was said, too (a
/// stage list that selects, against all that a type can do; a part that nobody wrote).
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

/// Whether a world can be made from a scene that came from outside: types, values, roles and parents fit together.
Errors check_scene(const model::SceneSpec& scene, model::TypeSource& types);

/// The section of that name; an empty one if there is none.
const Section& find_section(const std::vector<Section>& sections, const std::string& name);

}  // namespace plab::simulation
