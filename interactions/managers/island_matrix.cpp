#include "island_matrix.h"

#include <algorithm>
#include <cmath>

namespace plab::managers
{
namespace
{

constexpr std::array<std::array<std::uint32_t, 2>, 3> kPairsOfThree{{{0, 1}, {0, 2}, {1, 2}}};

/// b += sign * [F, -F[r]; [q]F, -[q]F[r]] of F (3 x 3, W); b row by row.
void add_block(double* b, const Mat3& F, const Vec3& q, const Vec3& r, double sign)
{
    // The rows of -F [r] are r x row: (F (w x r))_i = row_i . (w x r) = w . (r x row_i).
    Vec3 left[3], right[3];
    for (int i = 0; i < 3; ++i)
    {
        left[i] = Vec3{F.m[i][0], F.m[i][1], F.m[i][2]} * sign;
        right[i] = cross(r, left[i]);
    }
    const auto row = [b](std::size_t i, const Vec3& x, const Vec3& y)
    {
        double* to = b + 6 * i;
        to[0] += x.x, to[1] += x.y, to[2] += x.z, to[3] += y.x, to[4] += y.y, to[5] += y.z;
    };
    for (std::size_t i = 0; i < 3; ++i) row(i, left[i], right[i]);
    row(3, left[2] * q.y - left[1] * q.z, right[2] * q.y - right[1] * q.z);
    row(4, left[0] * q.z - left[2] * q.x, right[0] * q.z - right[2] * q.x);
    row(5, left[1] * q.x - left[0] * q.y, right[1] * q.x - right[0] * q.y);
}

Column6 jacobian(const Line& line, std::uint32_t k)
{
    const Vec3 &l = line.linear[k], &a = line.angular[k];
    return {l.x, l.y, l.z, a.x, a.y, a.z};
}

}  // namespace

void IslandMatrix::join(std::uint32_t i, std::uint32_t j)
{
    if (i != kNoIndex && j != kNoIndex && i != j) edges_.push_back({std::min(i, j), std::max(i, j)});
}

void IslandMatrix::shape(const Problem& problem)
{
    edges_.clear();
    for (const Point& p : problem.points) join(p.a, p.b);
    analyse(problem, problem.lines.size());
    pair_of_point_.clear();
    for (const Point& p : problem.points) pair_of_point_.push_back(p.a != kNoIndex && p.b != kNoIndex ? matrix_.find(p.a, p.b) : kNoIndex);
}

void IslandMatrix::shape_of_rows(const Problem& problem)
{
    edges_.clear();
    analyse(problem, problem.row_count());
}

/// Joins the movers of the first `count` lines, too.
void IslandMatrix::analyse(const Problem& problem, std::size_t count)
{
    for (const Line& line : std::span(problem.lines).first(count))
        for (const auto& [i, j] : kPairsOfThree)
            if (j < line.count) join(line.mover[i], line.mover[j]);
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    if (problem.movers.size() != nodes_.size() || edges_ != known_edges_)
    {
        nodes_.assign(problem.movers.size(), {linear::SparseBlocks::kMostSize});
        matrix_.analyse(nodes_, edges_);
        known_edges_ = edges_;
    }
    pairs_of_line_.clear();
    for (const Line& line : problem.lines)
    {
        auto& pairs = pairs_of_line_.emplace_back();
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto [i, j] = kPairsOfThree[k];
            pairs[k] = pairs_of_line_.size() <= count && j < line.count && line.mover[i] != line.mover[j]
                           ? matrix_.find(line.mover[i], line.mover[j])
                           : kNoIndex;
        }
    }
}

void IslandMatrix::start(const Problem& problem)
{
    matrix_.clear();
    interruption_ = problem.interruption;
    for (std::uint32_t i = 0; i < problem.movers.size(); ++i)
    {
        double* b = matrix_.diagonal(i);
        const Anchor& m = problem.anchors[i];
        b[0] = b[7] = b[14] = m.mass;
        for (std::size_t r = 0; r < 3; ++r)
            for (std::size_t c = 0; c < 3; ++c) b[6 * (3 + r) + 3 + c] = m.inertia.m[r][c];
    }
}

void IslandMatrix::add(const Problem& problem, std::size_t i, const Mat3& G)
{
    const Point& p = problem.points[i];
    const Vec3 axes[3] = {p.t1, p.t2, p.n};
    Mat3 F;  // E^T G E
    for (int r = 0; r < 3; ++r)
    {
        const Vec3 row = axes[0] * G(r, 0) + axes[1] * G(r, 1) + axes[2] * G(r, 2);
        for (int k = 0; k < 3; ++k) F(k, 0) += axes[r][k] * row.x, F(k, 1) += axes[r][k] * row.y, F(k, 2) += axes[r][k] * row.z;
    }
    if (p.b != kNoIndex) add_block(matrix_.diagonal(p.b), F, p.r_b, p.r_b, 1);
    if (p.a != kNoIndex) add_block(matrix_.diagonal(p.a), F, p.r_a, p.r_a, 1);
    if (pair_of_point_[i] == kNoIndex) return;
    add_block(matrix_.block(pair_of_point_[i], p.a), F, p.r_a, p.r_b, -1);
    add_block(matrix_.block(pair_of_point_[i], p.b), F, p.r_b, p.r_a, -1);
}

void IslandMatrix::add(const Problem& problem, std::size_t i, double g)
{
    const Line& line = problem.lines[i];
    std::array<Column6, ConstraintRow::kMostBlocks> J;
    for (std::uint32_t k = 0; k < line.count; ++k)
    {
        J[k] = jacobian(line, k);
        matrix_.add_outer(matrix_.diagonal(line.mover[k]), J[k], J[k], g);
    }
    for (std::size_t k = 0; k < 3; ++k)
    {
        const auto [x, y] = kPairsOfThree[k];
        if (y >= line.count) continue;
        const std::uint32_t mx = line.mover[x], my = line.mover[y];
        double* of_x = mx == my ? matrix_.diagonal(mx) : matrix_.block(pairs_of_line_[i][k], mx);
        double* of_y = mx == my ? matrix_.diagonal(my) : matrix_.block(pairs_of_line_[i][k], my);
        matrix_.add_outer(of_x, J[x], J[y], g);
        matrix_.add_outer(of_y, J[y], J[x], g);
    }
}

bool IslandMatrix::substitute(std::span<Column6> x) const
{
    if (x.empty()) return true;
    matrix_.solve({x.front().data(), 6 * x.size()});
    return std::all_of(x.begin(), x.end(),
                       [](const Column6& c) { return std::all_of(c.begin(), c.end(), [](double v) { return std::isfinite(v); }); });
}

void add_push(std::span<Column6> columns, const Point& p, const Vec3& j)
{
    const Vec3 push = p.t1 * j.x + p.t2 * j.y + p.n * j.z;
    if (p.b != kNoIndex) add(columns[p.b], push, cross(p.r_b, push));
    if (p.a != kNoIndex) add(columns[p.a], -push, -cross(p.r_a, push));
}

void add_push(std::span<Column6> columns, const Line& line, double j)
{
    for (std::uint32_t k = 0; k < line.count; ++k) add(columns[line.mover[k]], line.linear[k] * j, line.angular[k] * j);
}

Vec3 relative_velocity_of(std::span<const Column6> columns, const Point& p)
{
    Vec3 u;
    if (p.b != kNoIndex) u += first(columns[p.b]) + cross(last(columns[p.b]), p.r_b);
    if (p.a != kNoIndex) u -= first(columns[p.a]) + cross(last(columns[p.a]), p.r_a);
    return {dot(p.t1, u), dot(p.t2, u), dot(p.n, u)};
}

double rate_of(std::span<const Column6> columns, const Line& line)
{
    double sum = 0;
    for (std::uint32_t k = 0; k < line.count; ++k)
        sum += dot(line.linear[k], first(columns[line.mover[k]])) + dot(line.angular[k], last(columns[line.mover[k]]));
    return sum;
}

}  // namespace plab::managers
