/// One-way drives: the driven shaft copies its driver, which feels nothing. Someone must be first.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "plab/result.h"
#include "simulation/shafts/ratio_forest.h"

namespace plab::simulation
{

struct OneWayDrive
{
    std::uint32_t component = 0;  ///< directory index
    std::uint32_t driver = 0;     ///< shaft
    std::uint32_t driven = 0;     ///< shaft
};

/// What is wrong with the drives: circles (of circles that share a shaft, at least one), and drives of prescribed
/// shafts. `root` by shaft: shafts that the constraint graph joins are one link of a circle.
Errors check_drives(std::vector<OneWayDrive> drives, std::span<const std::uint32_t> root, std::span<const std::uint8_t> prescribed,
                    const ShaftDirectory& directory);

}  // namespace plab::simulation
