/// A square matrix of 6 x 6 blocks over a graph, factored as block LU with the graph's own fill.
///
/// Elimination in the order of least degree: a chain or stack of n movers costs O(n). Blocks are inverted with pivots
/// inside them; between blocks nothing is exchanged, which is right for what is added to masses here.
/// Source: George, Liu, Computer Solution of Large Sparse Positive Definite Systems (1981), chapter 5.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "plab/interruption.h"

namespace plab::managers
{

using Block = std::array<double, 36>;  ///< row by row
using Column6 = std::array<double, 6>;

class BlockMatrix
{
public:
    using Edge = std::pair<std::uint32_t, std::uint32_t>;  ///< first < second

    /// n diagonal blocks and a pair of blocks for each edge; edges sorted, each once. Free if nothing changed.
    void shape(std::uint32_t n, std::span<const Edge> edges);
    void clear();
    Block& diagonal(std::uint32_t i) { return diagonal_[i]; }
    /// The index of the pair (i, j), for upper() and lower().
    std::uint32_t find(std::uint32_t i, std::uint32_t j) const;
    /// Block in row i and column j of the pair that find(i, j) names.
    Block& block(std::uint32_t pair, std::uint32_t i) { return earlier_[pair] == i ? upper_[pair] : lower_[pair]; }
    /// False if a block of the elimination is singular.
    bool factor(const Interruption* interruption = nullptr);
    /// In place; after factor().
    void solve(std::span<Column6> x) const;
    std::size_t pairs() const { return earlier_.size(); }
    /// Products of blocks in one factor(): its cost.
    std::size_t products() const { return targets_.size() + pairs(); }

private:
    void order_nodes();
    void plan_updates();
    void eliminate(std::uint32_t node);

    std::uint32_t size_ = 0;
    std::vector<Edge> edges_;  ///< as given
    std::vector<std::uint32_t> order_, rank_;
    // Filled pattern: pairs of each node with later ones, one list after the other in the order of elimination.
    std::vector<std::uint32_t> begin_;            ///< by place in the order
    std::vector<std::uint32_t> earlier_, later_;  ///< by pair
    /// For each eliminated node and each ordered choice (i, j) of its later neighbours: where block (i, j) is.
    struct Target
    {
        std::uint32_t at = 0;  ///< node for the diagonal, else pair
        std::uint8_t kind = 0;
    };
    std::vector<Target> targets_;
    std::vector<std::size_t> first_target_;        ///< by place
    std::vector<Block> diagonal_, upper_, lower_;  ///< upper: (earlier, later); lower: (later, earlier)
    std::vector<std::vector<std::uint32_t>> neighbours_;
    std::vector<std::uint32_t> merged_;
    using Degree = std::pair<std::uint32_t, std::uint32_t>;  ///< degree, node
    std::vector<Degree> heap_;
};

}  // namespace plab::managers
