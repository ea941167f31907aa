/// The part of a snapshot file that holds components' own fields: a section "cells.TYPE" for each type, with a column for each
/// param, state and output. A param that every component of the type has as its scene gives it is left out.
#pragma once

#include <vector>

#include "model/type_registry.h"
#include "simulation/snapshot/sections.h"
#include "world/image.h"

namespace plab::simulation
{

std::vector<Section> write_cells(const world::Image& image);

/// Fills layouts and cells, and the types and facets of the directory, whose components are those of the image's scene in
/// their order. A field that this build's type does not have is refused; one that the file does not have keeps its default.
Result<void> read_cells(const std::vector<Section>& sections, model::TypeSource& types, world::Directory& directory, world::Image& image);

inline constexpr std::string_view kCellsPrefix = "cells.";

}  // namespace plab::simulation
