/// The spanning forest of all couplings between shafts: which shafts move together, with which ratios, and which couplings are redundant.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "plab/result.h"
#include "simulation/shafts/exact_ratio.h"

namespace plab::simulation
{

/// speed(driven) = ratio * speed(driver), imposed by a component.
struct RatioEdge
{
    std::uint32_t component = 0;  ///< directory index
    std::uint32_t driver = 0;     ///< shaft
    std::uint32_t driven = 0;     ///< shaft
    ExactRatio ratio;
};

/// Order and names by component id, so that results do not depend on row numbers. Without ranks, the index is the rank.
struct ShaftDirectory
{
    std::span<const std::uint32_t> shaft_rank;      ///< by shaft
    std::span<const std::uint32_t> component_rank;  ///< by directory index
    std::function<std::string(std::uint32_t)> shaft_id;
    std::function<std::string(std::uint32_t)> component_id;

    std::uint32_t rank_of_shaft(std::uint32_t i) const { return i < shaft_rank.size() ? shaft_rank[i] : i; }
    std::uint32_t rank_of_component(std::uint32_t i) const { return i < component_rank.size() ? component_rank[i] : i; }
};

struct ForestNode
{
    std::uint32_t shaft = 0;
    std::uint32_t parent = 0;          ///< position in nodes; a root is its own parent
    std::uint32_t edge = 0xffffffffu;  ///< to its parent; none for a root
    ExactRatio ratio;                  ///< turns per turn of the root
};

struct RatioForest
{
    std::vector<ForestNode> nodes;          ///< tree after tree, each root first, parents before children
    std::vector<std::uint32_t> tree_begin;  ///< position of each root, and one past the last node
    std::vector<std::uint32_t> redundant;   ///< edges that close a loop and are consistent with it
    std::vector<RatioEdge> edges;           ///< in the order of their components' ids
};

/// If the factors of a loop are not all exact, their product may differ from 1 by this relative error: the rounding of long products.
inline constexpr double kLoopTolerance = 1e-12;

/// Builds the forest of the shafts that edges join. The root of a tree is its prescribed shaft, otherwise its first shaft by rank. Edges
/// are considered in the order of their components' ids, so equal scenes give equal trees. Refused, each by name: a coupling of a shaft
/// with itself, a contradictory loop, two prescribed shafts in one tree, and ratios too far apart to be reduced.
Result<RatioForest> grow_ratio_forest(std::vector<RatioEdge> edges, std::span<const std::uint8_t> prescribed,
                                      const ShaftDirectory& directory);

}  // namespace plab::simulation
