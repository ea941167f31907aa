/// Sparse block factorisation of a symmetric quasi-definite matrix, such as M and J of a mechanism:
///
///   K = | M  J^T |     K = L D L^T,  L unit lower triangular, D diagonal: positive for nodes of M, negative for nodes of J
///       | J  -C  |
///
/// Whatever positive nodes are eliminated first, what is left of the others stays quasi-definite, so pivots keep their signs
/// and none needs to be searched for outside its block. Bodies and joints of a tree, leaves first, cause no fill: one
/// factorisation is the articulated-body recursion, and mass ratios of 1e8 cost no digits.
///
/// Sources: R. J. Vanderbei, "Symmetric quasidefinite matrices", SIAM J. Optim. 5 (1995); D. Baraff, SIGGRAPH 1996;
/// A. George, J. Liu, "Computer solution of large sparse positive definite systems" (1981), minimum degree.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace plab::simulation
{

/// A block of unknowns: 1 to 6 of them.
struct SparseNode
{
    std::uint32_t size = 0;
    bool negative = false;  ///< a joint: its diagonal is 0 or less. To be eliminated after its bodies
    bool early = false;     ///< of a joint: the last of its bodies may come after it
};

/// Two nodes with a block between them: a joint and a body.
struct SparseEdge
{
    std::uint32_t joint = 0, body = 0;
};

/// The order of elimination: least degree first, then the lower number; joints not before their bodies.
std::vector<std::uint32_t> order_of_elimination(std::span<const SparseNode> nodes, std::span<const SparseEdge> edges);

class SparseLdlt
{
public:
    static constexpr std::uint32_t kMostSize = 6;

    /// Symbolic: order, fill, storage. Edges must be distinct.
    void analyse(std::span<const SparseNode> nodes, std::span<const SparseEdge> edges);

    /// All blocks to zero.
    void clear();
    /// The node's block, row by row; only its lower triangle is read. A joint's holds -C.
    double* diagonal(std::uint32_t node) { return &values_[diagonal_[node]]; }
    /// Adds to element (r of the joint, c of the body) of an edge's block.
    void add(std::uint32_t edge, std::uint32_t r, std::uint32_t c, double value)
    {
        const Place& p = place_[edge];
        values_[p.offset + r * p.joint_stride + c * p.body_stride] += value;
    }
    /// A pivot of this unknown that is not above `floor` is raised by `lift`, and flagged in small(). So is one that falls to
    /// kDependent of what it was when its block's turn came (a row that the other rows of its joint imply); it is raised by
    /// kRaised of that as well.
    void set_floor(std::uint32_t unknown, double floor, double lift) { floor_[unknown] = floor, lift_[unknown] = lift; }
    static constexpr double kDependent = 1e-13, kRaised = 1e-11;
    void factor();
    /// K x = x, by unknown: offset(node) + r.
    void solve(std::span<double> x) const;

    std::uint32_t offset(std::uint32_t node) const { return offset_[node]; }
    std::size_t unknowns() const { return small_.size(); }
    /// By unknown: the last factorisation had to raise its pivot.
    std::span<const std::uint8_t> small() const { return small_; }
    /// By unknown: the last factorisation's pivot before it was raised; positive.
    std::span<const double> pivots() const { return pivot_; }
    std::size_t blocks() const { return below_.size(); }  ///< off the diagonal, fill included

private:
    struct Place
    {
        std::uint32_t offset = 0, joint_stride = 0, body_stride = 0;
    };
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

    void lay_out(std::span<const SparseEdge> edges, const std::vector<std::vector<std::uint32_t>>& later);
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

    std::vector<SparseNode> nodes_;
    std::vector<std::uint32_t> order_, rank_;
    std::vector<std::uint32_t> offset_;    // of a node's unknowns
    std::vector<std::uint32_t> diagonal_;  // of a node's block in values_
    std::vector<Place> place_;             // by edge
    std::vector<Pivot> pivots_;            // in order of elimination
    std::vector<Below> below_;
    std::vector<std::uint32_t> targets_;
    std::vector<double> values_;
    std::vector<double> scratch_;                         // blocks below the present pivot, before they are divided by D
    std::vector<double> inverse_, pivot_, floor_, lift_;  // by unknown
    std::vector<std::uint8_t> small_;
};

}  // namespace plab::simulation
