/// A square sparse matrix of 6 x 6 blocks, factored as block LU. A graph gives its pattern: one node per mover, one edge per
/// pair of movers that a contact or row connects.
///
/// Elimination fills in further blocks: when a node is eliminated, its remaining neighbours become connected to one another. The
/// nodes are therefore eliminated in minimum-degree order, which keeps this fill small: a chain or stack of n movers costs O(n).
/// Pivoting takes place inside the 6 x 6 blocks only. Blocks are not exchanged with one another; this is safe here because the
/// matrix is a mass matrix plus positive semidefinite terms or terms of friction (newton.h).
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

using Block = std::array<double, 36>;  ///< row-major
using Column6 = std::array<double, 6>;

class BlockMatrix
{
public:
    using Edge = std::pair<std::uint32_t, std::uint32_t>;  ///< first < second

    /// Sets the pattern: n diagonal blocks and a pair of blocks for each edge. Edges must be sorted and unique. Does nothing if
    /// the pattern is the same as before.
    void shape(std::uint32_t n, std::span<const Edge> edges);
    void clear();
    Block& diagonal(std::uint32_t i) { return diagonal_[i]; }
    /// The index of the pair of blocks (i, j), for block().
    std::uint32_t find(std::uint32_t i, std::uint32_t j) const;
    /// The block in row i of the pair that find(i, j) returned.
    Block& block(std::uint32_t pair, std::uint32_t i) { return earlier_[pair] == i ? upper_[pair] : lower_[pair]; }
    /// Returns false if a pivot block is singular.
    bool factor(const Interruption* interruption = nullptr);
    /// Solves in place; call factor() first.
    void solve(std::span<Column6> x) const;
    std::size_t pairs() const { return earlier_.size(); }
    /// The number of block products in one factor(), which measures its cost.
    std::size_t products() const { return targets_.size() + pairs(); }

private:
    void order_nodes();
    void plan_updates();
    void eliminate(std::uint32_t node);

    std::uint32_t size_ = 0;
    std::vector<Edge> edges_;  ///< as passed to shape()
    std::vector<std::uint32_t> order_, rank_;
    // Pattern including fill: the pairs of each node with nodes eliminated later, one list after the other in elimination order.
    std::vector<std::uint32_t> begin_;            ///< by position in the elimination order
    std::vector<std::uint32_t> earlier_, later_;  ///< by pair
    /// For each eliminated node and each ordered pair (i, j) of its later neighbours: where block (i, j) is stored.
    struct Target
    {
        std::uint32_t at = 0;  ///< a node for the diagonal, otherwise a pair
        std::uint8_t kind = 0;
    };
    std::vector<Target> targets_;
    std::vector<std::size_t> first_target_;        ///< by position in the elimination order
    std::vector<Block> diagonal_, upper_, lower_;  ///< upper: (earlier, later); lower: (later, earlier)
    std::vector<std::vector<std::uint32_t>> neighbours_;
    std::vector<std::uint32_t> merged_;
    using Degree = std::pair<std::uint32_t, std::uint32_t>;  ///< degree, node
    std::vector<Degree> heap_;
};

}  // namespace plab::managers
