/// The part of a snapshot file that holds the fields of components: one section "cells.TYPE" for each type, with a column for each param,
/// state and output. A param is left out if every component of the type has the value that the scene gives.
#pragma once

#include <vector>

#include "model/type_registry.h"
#include "simulation/snapshot/sections.h"
#include "world/image.h"

namespace plab::simulation
{

std::vector<Section> write_cells(const world::Image& image);

/// Fills layouts and cells, and the types and facets of the directory, whose components are those of the image's scene in the same order.
/// A field that this build's type does not have is refused; a field that the file does not have keeps its default.
Result<void> read_cells(const std::vector<Section>& sections, model::TypeSource& types, world::Directory& directory, world::Image& image);

inline constexpr std::string_view kCellsPrefix = "cells.";

}  // namespace plab::simulation
