/// A triangle mesh as a surface to collide with: adjacency, sharp edges, and a bounding-box tree over the triangles.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "plab/result.h"
#include "plab/vector.h"

namespace plab::detection
{

/// In the frame S of the shape, m. The front is the side from which corners appear counter-clockwise; solids collide from there.
class TriangleSurface
{
public:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    struct Triangle
    {
        std::array<std::uint32_t, 3> corner{}, edge{};  ///< edge i runs from corner i to the next one
        Vec3 normal;                                    ///< unit, towards the front
        std::uint32_t patch = 0;                        ///< number of a group of adjacent triangles without a sharp edge between them
    };
    struct Edge
    {
        std::uint32_t a = 0, b = 0;                       ///< corners, in the order in which they follow each other in the first side
        std::array<std::uint32_t, 2> side{kNone, kNone};  ///< triangles; a border edge has only the first
        bool sharp = false;                               ///< convex by more than rounding, or a border: a solid can touch this edge itself
        bool border() const { return side[1] == kNone; }
    };

    /// Fails if no triangle has an area, or if an edge belongs to more than two triangles.
    static Result<TriangleSurface> make(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles);

    const Vec3& point(std::uint32_t corner) const { return points_[corner]; }
    const std::vector<Triangle>& triangles() const { return triangles_; }
    const std::vector<Edge>& edges() const { return edges_; }
    /// Unit, in the plane of a triangle, perpendicular to its edge i and into it. Not stored: few are asked for, and the largest surfaces
    /// have 6 million.
    Vec3 inward(const Triangle& t, std::size_t i) const { return inward(t.normal, t.corner[i], t.corner[(i + 1) % 3]); }
    /// The same of the triangle at a side (0 or 1) of an edge.
    Vec3 inward(const Edge& e, std::size_t side) const
    {
        return inward(triangles_[e.side[side]].normal, side == 0 ? e.a : e.b, side == 0 ? e.b : e.a);
    }
    const Vec3& lower() const { return nodes_.front().lower; }
    const Vec3& upper() const { return nodes_.front().upper; }

    /// Whether direction m leads away from the surface at a corner, i.e. towards no edge that ends there.
    bool leaves_corner(std::uint32_t corner, const Vec3& m, double tolerance) const;
    /// Whether some edge at this corner is sharp.
    bool sharp_corner(std::uint32_t corner) const { return sharp_corner_[corner] != 0; }
    /// Whether some edge at this corner has one side only.
    bool border_corner(std::uint32_t corner) const { return border_corner_[corner] != 0; }
    /// The mean of the normals around a corner, each weighted by its angle. It gives the sign of the distance to a corner
    /// (Baerentzen, Aanaes, Signed distance computation using the angle weighted pseudonormal, IEEE TVCG 11(3), 2005).
    const Vec3& corner_normal(std::uint32_t corner) const { return corner_normal_[corner]; }

    /// Calls visit(triangle) for all triangles in leaves whose boxes overlap [lower, upper], in the order of the tree.
    template <class Visit>
    void visit_box(const Vec3& lower, const Vec3& upper, Visit&& visit) const;
    /// Calls visit(triangle) for the triangles that may be nearer to `center` than limit(), nearer boxes first.
    template <class Limit, class Visit>
    void visit_near(const Vec3& center, Limit&& limit, Visit&& visit) const;

private:
    struct Node
    {
        Vec3 lower, upper;
        std::uint32_t first = 0,
                      count = 0;  ///< leaf: range in order_; inner node: count = 0, children `first` and first + 1
    };
    static constexpr std::size_t kDepth = 64;

    Vec3 inward(const Vec3& normal, std::uint32_t from, std::uint32_t to) const
    {
        return normalized(cross(normal, points_[to] - points_[from]));
    }
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
        const double out = std::max(0.0, std::max(node.lower[k] - p[k], p[k] - node.upper[k]));
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
    struct Open
    {
        std::uint32_t node;
        double squared;  ///< m^2, of its distance
    };
    std::array<Open, kDepth> stack;
    stack[0] = {0, distance_squared(center, nodes_[0])};
    std::size_t top = 1;
    while (top > 0)
    {
        const Open open = stack[--top];
        const Node& node = nodes_[open.node];
        const double most = limit();
        if (most < 0 || open.squared > most * most) continue;
        for (std::uint32_t i = 0; i < node.count; ++i) visit(order_[node.first + i]);
        if (node.count > 0) continue;
        Open near{node.first, distance_squared(center, nodes_[node.first])};
        Open far{node.first + 1, distance_squared(center, nodes_[node.first + 1])};
        if (near.squared > far.squared) std::swap(near, far);
        if (far.squared <= most * most) stack[top++] = far;
        if (near.squared <= most * most) stack[top++] = near;
    }
}

}  // namespace plab::detection
