/// The spanning forest of all couplings between shafts: who moves with whom, how fast, and which couplings say nothing
/// new.
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

/// speed(driven) = ratio * speed(driver), held by a component.
struct RatioEdge
{
    std::uint32_t component = 0;  ///< directory index
    std::uint32_t driver = 0;     ///< shaft
    std::uint32_t driven = 0;     ///< shaft
    ExactRatio ratio;
};

/// Order and names by component id, so that nothing depends on rows. Empty ranks: the index is the rank.
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
    std::uint32_t parent = 0;          ///< position in nodes; a root's is its own
    std::uint32_t edge = 0xffffffffu;  ///< that joins it to its parent; none for a root
    ExactRatio ratio;                  ///< turns per turn of the root
};

struct RatioForest
{
    std::vector<ForestNode> nodes;          ///< tree after tree, each root first, parents before children
    std::vector<std::uint32_t> tree_begin;  ///< position of each root, and the end
    std::vector<std::uint32_t> redundant;   ///< edges that close a loop and agree with it
    std::vector<RatioEdge> edges;           ///< in the order of their components' ids
};

/// Loops whose factors are not all exact may miss 1 by this much, relative: the rounding of long products.
inline constexpr double kLoopTolerance = 1e-12;

/// Grows the forest of shafts that an edge joins. A tree's root is its prescribed shaft, else its first by rank; its
/// edges are taken in the order of their components' ids, so equal scenes get equal trees. Refused, each by name: a
/// coupling of a shaft with itself, a factor of 0, loops that contradict themselves, two prescribed shafts in one tree,
/// ratios too far apart to be reduced.
Result<RatioForest> grow_ratio_forest(std::vector<RatioEdge> edges, std::span<const std::uint8_t> prescribed,
                                      const ShaftDirectory& directory);

}  // namespace plab::simulation
