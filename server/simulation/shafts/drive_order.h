/// One-way drives: the driven shaft copies the speed of its driver, which gets no reaction. The drives must have an order without cycles.
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

/// Errors in the drives: cycles (of cycles that share a shaft, at least one is reported), and drives of prescribed shafts. `root`: by
/// shaft; all shafts that the constraint graph joins count as one link of a cycle.
Errors check_drives(std::vector<OneWayDrive> drives, std::span<const std::uint32_t> root, std::span<const std::uint8_t> prescribed,
                    const ShaftDirectory& directory);

}  // namespace plab::simulation
