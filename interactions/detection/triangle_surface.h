/// Triangles as a surface to collide with: who is whose neighbour, which edges stand out, and a tree of boxes over them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "plab/result.h"
#include "plab/vector.h"

namespace plab::detection
{

/// Frame S of the shape, m. The front is where corners are seen counter-clockwise; solids come from there.
class TriangleSurface
{
public:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    struct Triangle
    {
        std::array<std::uint32_t, 3> corner{}, edge{};  ///< edge i runs from corner i to the next one
        std::array<Vec3, 3> inward;                     ///< unit, in the plane, square to edge i
        Vec3 normal;                                    ///< unit, to the front
        std::uint32_t patch = 0;                        ///< triangles that go over into one another without a sharp bend
    };
    struct Edge
    {
        std::uint32_t a = 0, b = 0;                       ///< corners
        std::array<std::uint32_t, 2> side{kNone, kNone};  ///< triangles; a border has only the first
        std::array<Vec3, 2> inward;                       ///< of each side: in its plane, square to the edge
        bool sharp = false;                               ///< convex by more than rounding, or a border: it can be touched by itself
        bool border() const { return side[1] == kNone; }
    };

    /// Refuses what has no triangle with an area, or edges of more than two triangles.
    static Result<TriangleSurface> make(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles);

    const Vec3& point(std::uint32_t corner) const { return points_[corner]; }
    const std::vector<Triangle>& triangles() const { return triangles_; }
    const std::vector<Edge>& edges() const { return edges_; }
    const Vec3& lower() const { return nodes_.front().lower; }
    const Vec3& upper() const { return nodes_.front().upper; }

    /// Whether direction m leads away from the surface at a corner: along no edge that ends there.
    bool leaves_corner(std::uint32_t corner, const Vec3& m, double tolerance) const;
    /// Some edge at this corner is sharp.
    bool sharp_corner(std::uint32_t corner) const { return sharp_corner_[corner] != 0; }
    /// Some edge at this corner has one side only.
    bool border_corner(std::uint32_t corner) const { return border_corner_[corner] != 0; }
    /// The mean of the normals around a corner, each weighted by its angle (Baerentzen, Aanaes, Signed distance computation
    /// using the angle weighted pseudonormal, IEEE TVCG 11(3), 2005): the sign of the distance to a corner.
    const Vec3& corner_normal(std::uint32_t corner) const { return corner_normal_[corner]; }

    /// Calls visit(triangle) for all whose boxes meet [lower, upper], in the tree's order.
    template <class Visit>
    void visit_box(const Vec3& lower, const Vec3& upper, Visit&& visit) const;
    /// Calls visit(triangle) for those that may be nearer to `center` than limit(), nearer boxes first.
    template <class Limit, class Visit>
    void visit_near(const Vec3& center, Limit&& limit, Visit&& visit) const;

private:
    struct Node
    {
        Vec3 lower, upper;
        std::uint32_t first = 0,
                      count = 0;  ///< leaf: triangles in order_; else count = 0 and `first` is the left child, first + 1 the right
    };
    static constexpr std::size_t kDepth = 64;

    void join(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles);
    bool find_edges();
    void find_corners();
    void find_patches();
    void build_tree();
    static double distance_squared(const Vec3& p, const Node& node);

    std::vector<Vec3> points_;
    std::vector<Triangle> triangles_;
    std::vector<Edge> edges_;
    std::vector<Vec3> corner_normal_;
    std::vector<std::uint8_t> sharp_corner_, border_corner_;
    std::vector<std::uint32_t> beside_, beside_end_;  ///< the other ends of the edges at corner i: [end of i - 1, end of i)
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
};

inline double TriangleSurface::distance_squared(const Vec3& p, const Node& node)
{
    double sum = 0;
    for (int k = 0; k < 3; ++k)
    {
        const double out = std::fmax(0.0, std::fmax(node.lower[k] - p[k], p[k] - node.upper[k]));
        sum += out * out;
    }
    return sum;
}

template <class Visit>
void TriangleSurface::visit_box(const Vec3& lower, const Vec3& upper, Visit&& visit) const
{
    std::array<std::uint32_t, kDepth> stack{};
    std::size_t top = 1;
    while (top > 0)
    {
        const Node& node = nodes_[stack[--top]];
        bool apart = false;
        for (int k = 0; k < 3; ++k) apart = apart || node.lower[k] > upper[k] || node.upper[k] < lower[k];
        if (apart) continue;
        for (std::uint32_t i = 0; i < node.count; ++i) visit(order_[node.first + i]);
        if (node.count == 0) stack[top++] = node.first + 1, stack[top++] = node.first;
    }
}

template <class Limit, class Visit>
void TriangleSurface::visit_near(const Vec3& center, Limit&& limit, Visit&& visit) const
{
    std::array<std::uint32_t, kDepth> stack{};
    std::size_t top = 1;
    while (top > 0)
    {
        const Node& node = nodes_[stack[--top]];
        const double most = limit();
        if (most < 0 || distance_squared(center, node) > most * most) continue;
        for (std::uint32_t i = 0; i < node.count; ++i) visit(order_[node.first + i]);
        if (node.count > 0) continue;
        const std::uint32_t left = node.first, right = left + 1;
        const bool left_first = distance_squared(center, nodes_[left]) <= distance_squared(center, nodes_[right]);
        stack[top++] = left_first ? right : left, stack[top++] = left_first ? left : right;
    }
}

}  // namespace plab::detection
