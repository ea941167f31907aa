/// A sparse square matrix of small blocks, factored in place. A graph gives its pattern: a block on the diagonal for each node, and a
/// block for each edge. Both the rows of mechanisms and the contacts of managers use it.
///
/// Kind::QuasiDefinite is symmetric, such as the mass matrix M and the Jacobian J of a mechanism:
///
///   K = | M  J^T |     K = L D L^T,  L unit lower triangular, D diagonal: positive for nodes of M, negative for nodes of J
///       | J  -C  |
///
/// Eliminating positive nodes leaves the rest quasi-definite in any order, so pivots keep their signs and no pivot has to be searched
/// for outside its block. Bodies and joints of a tree, eliminated from the leaves, cause no fill: one factorisation is the
/// articulated-body recursion, and mass ratios of 1e8 cost no digits.
///
/// Kind::General is K = L U by blocks of six unknowns. Pivoting takes place inside the diagonal blocks only. Blocks are not exchanged
/// with one another; this is safe for M + J^T G J, the masses of an island and the terms of its contacts (G is unsymmetric with friction).
///
/// When a node is eliminated, its remaining neighbours become connected to one another, which fills in further blocks. Nodes are
/// eliminated in minimum-degree order, which keeps this fill small: a chain or a stack of n bodies costs O(n).
///
/// Eigen's SimplicialLDLT and SparseLU are not used: they cannot raise a pivot and fail where other rows imply a row of a joint; they
/// work on single numbers instead of blocks, and allocate (tests/unit/simulation_rows/sparse_test.cpp).
///
/// Sources: R. J. Vanderbei, "Symmetric quasidefinite matrices", SIAM J. Optim. 5 (1995); D. Baraff, SIGGRAPH 1996;
/// A. George, J. Liu, "Computer solution of large sparse positive definite systems" (1981), chapter 5, minimum degree.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "plab/interruption.h"

namespace plab::linear
{

/// A block of unknowns: 1 to 6 of them.
struct SparseNode
{
    std::uint32_t size = 0;
    bool negative = false;  ///< a joint: its diagonal is 0 or less. To be eliminated after its bodies
    bool early = false;     ///< of a joint: the last of its bodies may come after it
    /// Of such a joint: only this body may. The bodies on the side of the ground are held by what is between them and the ground, so that
    /// without the body on the other side the pivot of the joint would be singular.
    static constexpr std::uint32_t kAnyBody = UINT32_MAX;
    std::uint32_t last = kAnyBody;
    friend bool operator==(const SparseNode&, const SparseNode&) = default;
};

/// Two nodes with a block between them: of a mechanism a joint and a body, in this order.
struct SparseEdge
{
    std::uint32_t a = 0, b = 0;
    friend auto operator<=>(const SparseEdge&, const SparseEdge&) = default;
};

class SparseBlocks
{
public:
    static constexpr std::uint32_t kMostSize = 6;
    enum class Kind : std::uint8_t
    {
        QuasiDefinite,
        General,
    };

    explicit SparseBlocks(Kind kind = Kind::QuasiDefinite) : kind_(kind) {}

    /// The symbolic analysis: order, fill, storage. Edges must be unique. Reuses its memory, and allocates only for a larger graph.
    void analyse(std::span<const SparseNode> nodes, std::span<const SparseEdge> edges);

    /// Sets all blocks to zero.
    void clear();
    /// The node's block, row-major. Only the lower triangle of a quasi-definite matrix is read; the block of a joint holds -C.
    double* diagonal(std::uint32_t node) { return &values_[diagonal_[node]]; }
    /// The index of the blocks between two nodes that an edge or fill connects, for block().
    std::uint32_t find(std::uint32_t i, std::uint32_t j) const;
    /// General: the block in row i and column j, row-major; `pair` is find(i, j).
    double* block(std::uint32_t pair, std::uint32_t i)
    {
        const Below& b = below_[pair];
        return b.node == i ? &values_[b.offset] : &upper_[b.offset];
    }
    /// General: adds g x y^T to a block.
    static void add_outer(double* block, std::span<const double, kMostSize> x, std::span<const double, kMostSize> y, double g);
    /// QuasiDefinite: adds to element (r of node a, c of node b) of an edge's block.
    void add(std::uint32_t edge, std::uint32_t r, std::uint32_t c, double value)
    {
        const BlockStrides& p = place_[edge];
        values_[p.offset + r * p.a_stride + c * p.b_stride] += value;
    }
    /// QuasiDefinite: a pivot of this unknown that is not above `floor` is raised by `lift`, and flagged in small(). The same happens
    /// to a pivot that falls to kDependent of its value before the elimination of its block (a row that the other rows of its joint
    /// imply); it is raised by kRaised of that value as well.
    void set_floor(std::uint32_t unknown, double floor, double lift) { floor_[unknown] = floor, lift_[unknown] = lift; }
    static constexpr double kDependent = 1e-13, kRaised = 1e-11;

    /// Returns false if a block of a general matrix is singular, or if the interruption, which is asked for each node, is due.
    bool factor(const Interruption* interruption = nullptr);
    /// Solves K x = b in place; the unknown r of a node is at offset(node) + r. Call factor() first.
    void solve(std::span<double> x) const;

    std::uint32_t offset(std::uint32_t node) const { return offset_[node]; }
    std::size_t unknowns() const { return small_.size(); }
    /// By unknown: 1 if the last factorisation had to raise its pivot.
    std::span<const std::uint8_t> small() const { return small_; }
    /// By unknown, of a quasi-definite matrix: the pivot of the last factorisation before it was raised; positive.
    std::span<const double> pivots() const { return pivot_; }
    std::size_t blocks() const { return below_.size(); }  ///< below the diagonal, fill included
    /// The number of block products in one factorisation of a general matrix, which measures its cost.
    std::size_t products() const;

private:
    struct BlockStrides
    {
        std::uint32_t offset = 0, a_stride = 0, b_stride = 0;
    };
    /// A block below the diagonal, in row `node` and in the column of the pivot to whose list it belongs. For a general matrix,
    /// `upper_` holds the block across the diagonal at the same offset.
    struct Below
    {
        std::uint32_t node = 0;
        std::uint32_t offset = 0;
        std::uint32_t size = 0;
    };
    struct Pivot
    {
        std::uint32_t node = 0;
        std::uint32_t first = 0, count = 0;  ///< in below_
        std::uint32_t targets = 0;           ///< in targets_: count (count + 1) / 2 blocks, pairs (i >= j), j inside
    };
    using Degree = std::pair<std::uint32_t, std::uint32_t>;  ///< degree, node

    // sparse_order.cpp
    void order_nodes(std::span<const SparseEdge> edges);
    void start_order(std::span<const SparseEdge> edges);
    void note(std::uint32_t node);
    void eliminate_from_graph(std::uint32_t node);
    bool eligible(std::uint32_t node) const;
    void lay_out();
    void find_targets();
    void find_places(std::span<const SparseEdge> edges);
    void make_room(std::uint32_t unknowns, std::uint32_t used);

    // sparse_blocks.cpp
    std::uint32_t target(const Pivot& p, std::uint32_t i, std::uint32_t j) const { return targets_[p.targets + i * (i + 1) / 2 + j]; }
    void eliminate_general(const Pivot& p);
    template <int K>
    void eliminate(const Pivot& p);
    template <int K>
    void factor_pivot(std::uint32_t node, double* d);
    template <int K>
    void update(const Pivot& p);
    template <int K>
    void forward(const Pivot& p, double* x) const;
    template <int K>
    void backward(const Pivot& p, double* x) const;

    Kind kind_;
    std::vector<SparseNode> nodes_;
    std::vector<std::uint32_t> rank_;
    std::vector<std::uint32_t> offset_;    // of a node's unknowns
    std::vector<std::uint32_t> diagonal_;  // of a node's block in values_
    std::vector<BlockStrides> place_;      // by edge
    std::vector<Pivot> pivots_;            // in order of elimination
    std::vector<Below> below_;             // of each pivot, in order of elimination
    std::vector<std::uint32_t> targets_;
    std::vector<double> values_, upper_;
    std::vector<double> scratch_;                         // blocks beside the current pivot, before they are divided by D
    std::vector<double> inverse_, pivot_, floor_, lift_;  // by unknown
    std::vector<std::uint8_t> small_;
    // The remaining graph while nodes are being ordered.
    std::vector<std::vector<std::uint32_t>> neighbours_;
    std::vector<std::uint8_t> regular_;  // a joint of which a body has been eliminated
    std::vector<std::uint32_t> merged_;
    std::vector<Degree> heap_;
};

}  // namespace plab::linear
