/// M + J^T G J over the movers of an island: the matrix of every Newton step here.
#pragma once

#include "block_matrix.h"
#include "problem.h"

namespace plab::managers
{

class IslandMatrix
{
public:
    /// The graph of who touches whom. Free if it did not change.
    void shape(const Problem& problem);
    /// M alone.
    void start(const Problem& problem);
    /// Adds J^T G J of a point; G in contact coordinates.
    void add(const Problem& problem, std::size_t point, const Mat3& G);
    void add(const Problem& problem, std::size_t line, double g);
    /// x = (M + J^T G J)^-1 x. False if that does not exist in doubles, or the step is given up.
    bool solve(std::span<Column6> x);

private:
    BlockMatrix matrix_;
    const Interruption* interruption_ = nullptr;
    std::vector<BlockMatrix::Edge> edges_;
    std::vector<std::uint32_t> pair_of_point_;
    std::vector<std::array<std::uint32_t, 3>> pairs_of_line_;
};

inline Vec3 first(const Column6& c) { return {c[0], c[1], c[2]}; }
inline Vec3 last(const Column6& c) { return {c[3], c[4], c[5]}; }
inline void add(Column6& c, const Vec3& push, const Vec3& turn)
{
    c[0] += push.x, c[1] += push.y, c[2] += push.z, c[3] += turn.x, c[4] += turn.y, c[5] += turn.z;
}
/// J^T j into the movers' columns.
void add_push(std::span<Column6> columns, const Point& p, const Vec3& j);
void add_push(std::span<Column6> columns, const Line& line, double j);
/// J x, contact coordinates.
Vec3 relative_velocity_of(std::span<const Column6> columns, const Point& p);
double rate_of(std::span<const Column6> columns, const Line& line);

}  // namespace plab::managers
