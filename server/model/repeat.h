/// <repeat>: rows, columns, grids and seeded random fillings.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "model/blueprint.h"

namespace plab::model::detail
{

/// The attributes of a <repeat>, checked. Cells are numbered with the last index running fastest.
struct Repeat
{
    std::string id;  ///< of the group of all cells; may be empty
    std::array<std::int64_t, 3> count{1, 1, 1};
    int dimensions = 1;  ///< how many counts were given
    Vec3 step;           ///< m
    Vec3 jitter;         ///< m, largest displacement per axis
    Vec3 origin;         ///< m

    std::size_t cells() const { return static_cast<std::size_t>(count[0] * count[1] * count[2]); }
    /// Indices of cell n along the axes.
    std::array<std::int64_t, 3> cell(std::size_t n) const;
    /// ".i", ".i.j" or ".i.j.k", as many as there are counts.
    std::string suffix(std::size_t n) const;
    /// m. A row extends along the whole of `step`; in a grid each count has its own axis. `id` makes the jitter different for
    /// each cell.
    Vec3 offset(std::size_t n, std::uint64_t seed, const std::string& id) const;
};

/// Errors carry the place of the attribute.
Result<Repeat> read_repeat(const RepeatNode& node);

}  // namespace plab::model::detail
