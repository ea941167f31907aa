/// The matrix M + J^T G J over the movers of an island, which every Newton step of this folder factors.
///
/// M is block-diagonal: mass and inertia of each mover. J maps the movers' velocities to the relative velocities of the contact
/// points and to the rates of the rows. G is the derivative of the contact law, with one 3 x 3 block per point and one number
/// per row: how strongly the impulse reacts to a change of velocity. A point between movers a and b adds to the diagonal blocks
/// of both and to the pair of blocks (a, b). The pattern of the matrix is thus the contact graph, and a stack gives a
/// block-tridiagonal one. Since terms are added to the masses, and masses are never subtracted from one another, large mass
/// ratios lose no digits.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "linear/sparse_blocks.h"
#include "problem.h"

namespace plab::managers
{

using Column6 = std::array<double, 6>;

class IslandMatrix
{
public:
    /// Sets the pattern to the contact graph of the problem. Cheap if it has not changed.
    void shape(const Problem& problem);
    /// The same without the contact points, for a matrix of rows alone.
    void shape_of_rows(const Problem& problem);
    /// Resets the matrix to M alone.
    void start(const Problem& problem);
    /// Adds J^T G J of one point; G is in contact coordinates (t1, t2, n).
    void add(const Problem& problem, std::size_t point, const Mat3& G);
    void add(const Problem& problem, std::size_t line, double g);
    /// Block products in one factorisation, which measure its cost.
    std::size_t products() const { return matrix_.products(); }
    /// x = (M + J^T G J)^-1 x. Returns false if the matrix is singular, the result is not finite, or the step has been
    /// interrupted.
    bool solve(std::span<Column6> x) { return x.empty() || (factor() && substitute(x)); }
    /// The two parts of solve(), for several right-hand sides.
    bool factor() { return matrix_.factor(interruption_); }
    bool substitute(std::span<Column6> x) const;

private:
    void join(std::uint32_t i, std::uint32_t j);
    void analyse(const Problem& problem, std::size_t count);

    linear::SparseBlocks matrix_{linear::SparseBlocks::Kind::General};
    const Interruption* interruption_ = nullptr;
    std::vector<linear::SparseNode> nodes_;
    std::vector<linear::SparseEdge> edges_, known_edges_;  ///< of this problem, and those that the matrix was analysed for
    std::vector<std::uint32_t> pair_of_point_;
    std::vector<std::array<std::uint32_t, 3>> pairs_of_line_;
};

inline Vec3 first(const Column6& c) { return {c[0], c[1], c[2]}; }
inline Vec3 last(const Column6& c) { return {c[3], c[4], c[5]}; }
inline void add(Column6& c, const Vec3& push, const Vec3& turn)
{
    c[0] += push.x, c[1] += push.y, c[2] += push.z, c[3] += turn.x, c[4] += turn.y, c[5] += turn.z;
}
/// Adds J^T j to the columns of the movers.
void add_push(std::span<Column6> columns, const Point& p, const Vec3& j);
void add_push(std::span<Column6> columns, const Line& line, double j);
/// J x, in contact coordinates.
Vec3 relative_velocity_of(std::span<const Column6> columns, const Point& p);
double rate_of(std::span<const Column6> columns, const Line& line);

}  // namespace plab::managers
