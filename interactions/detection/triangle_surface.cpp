#include "triangle_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>

namespace plab::detection
{
namespace
{
using Index = std::uint32_t;

constexpr Index kLeaf = 4;         ///< triangles per leaf
constexpr double kFlat = 1e-9;     ///< sine: an edge with a smaller dihedral angle counts as flat
constexpr double kSmooth = 0.707;  ///< cosine: the normals of neighbours in one patch differ by less than this angle

/// Of vertices at exactly the same place, the first represents all.
std::vector<Index> first_at_same_place(std::span<const Vec3> vertices)
{
    std::vector<Index> order(vertices.size()), out(vertices.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](Index i) { return std::tie(vertices[i].x, vertices[i].y, vertices[i].z); };
    std::sort(order.begin(), order.end(), [&](Index i, Index j) { return key(i) != key(j) ? key(i) < key(j) : i < j; });
    for (std::size_t k = 0; k < order.size(); ++k)
        out[order[k]] = k > 0 && key(order[k]) == key(order[k - 1]) ? out[order[k - 1]] : order[k];
    return out;
}
}  // namespace

Result<TriangleSurface> TriangleSurface::make(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles)
{
    TriangleSurface out;
    out.join(vertices, triangles);
    if (out.triangles_.empty()) return reason("a surface needs at least one triangle that has an area");
    if (!out.find_edges()) return reason("an edge of more than two triangles, or of two that face in opposite directions, has no front");
    out.find_corners();
    out.find_patches();
    out.build_tree();
    return out;
}

void TriangleSurface::join(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles)
{
    points_.assign(vertices.begin(), vertices.end());
    const std::vector<Index> first = first_at_same_place(vertices);
    triangles_.reserve(triangles.size() / 3);
    for (std::size_t t = 0; t + 2 < triangles.size(); t += 3)
    {
        Triangle triangle;
        for (std::size_t i = 0; i < 3; ++i) triangle.corner[i] = first[triangles[t + i]];
        const auto& c = triangle.corner;
        const Vec3 e1 = points_[c[1]] - points_[c[0]], e2 = points_[c[2]] - points_[c[0]], area = cross(e1, e2);
        if (!(length(area) > 1e-14 * (length_squared(e1) + length_squared(e2)))) continue;
        triangle.normal = normalized(area);
        triangles_.push_back(triangle);
    }
}

namespace
{

/// For each half edge 3 t + i (from corner i of triangle t to the next one): the opposite half edge, or kNone. Returns false if
/// an edge has more than two sides, or two half edges in the same direction.
bool pair_half_edges(std::span<const TriangleSurface::Triangle> triangles, std::size_t points, std::vector<Index>& partner)
{
    const auto ends = [&](Index half)
    {
        const auto& corner = triangles[half / 3].corner;
        return std::pair{corner[half % 3], corner[(half + 1) % 3]};
    };
    const auto halves = static_cast<Index>(3 * triangles.size());
    partner.assign(halves, TriangleSurface::kNone);
    // Sorted by the lower corner, and within that by the other: the time is proportional to the number of triangles.
    std::vector<Index> begin(points + 1, 0), sorted(halves);
    for (Index h = 0; h < halves; ++h) ++begin[std::min(ends(h).first, ends(h).second) + 1];
    std::inclusive_scan(begin.begin(), begin.end(), begin.begin());
    std::vector<Index> next(begin.begin(), begin.end() - 1);
    for (Index h = 0; h < halves; ++h) sorted[next[std::min(ends(h).first, ends(h).second)]++] = h;
    const auto upper = [&](Index h) { return std::max(ends(h).first, ends(h).second); };
    for (std::size_t p = 0; p < points; ++p)
    {
        const auto first = sorted.begin() + begin[p], last = sorted.begin() + begin[p + 1];
        std::sort(first, last, [&](Index g, Index h) { return upper(g) != upper(h) ? upper(g) < upper(h) : g < h; });
        for (auto it = first; it != last; ++it)
        {
            if (it == first || upper(*it) != upper(*(it - 1))) continue;
            Index &one = *(it - 1), &other = *it;
            if (partner[one] != TriangleSurface::kNone || ends(one).first != ends(other).second) return false;
            partner[one] = other, partner[other] = one;
        }
    }
    return true;
}

}  // namespace

/// Numbers corners in the order in which the triangles use them.
bool TriangleSurface::find_edges()
{
    std::vector<Index> partner;
    if (!pair_half_edges(triangles_, points_.size(), partner)) return false;
    const auto borders = static_cast<std::size_t>(std::count(partner.begin(), partner.end(), kNone));
    edges_.reserve(borders + (partner.size() - borders) / 2);
    for (Index t = 0; t < triangles_.size(); ++t)
        for (Index i = 0; i < 3; ++i)
        {
            Triangle& triangle = triangles_[t];
            const Index half = 3 * t + i, other = partner[half];
            const bool is_known = other != kNone && other < half;
            const Index e = is_known ? triangles_[other / 3].edge[other % 3] : static_cast<Index>(edges_.size());
            if (!is_known) edges_.emplace_back().a = triangle.corner[i], edges_.back().b = triangle.corner[(i + 1) % 3];
            edges_[e].side[is_known ? 1 : 0] = t;
            triangle.edge[i] = e;
        }
    for (Edge& e : edges_) e.sharp = e.border() || dot(triangles_[e.side[0]].normal, inward(e, 1)) < -kFlat;
    return true;
}

void TriangleSurface::find_corners()
{
    sharp_corner_.assign(points_.size(), 0), border_corner_.assign(points_.size(), 0);
    corner_normal_.assign(points_.size(), Vec3{});
    std::vector<Index> count(points_.size() + 1, 0);
    for (const Edge& e : edges_)
    {
        ++count[e.a], ++count[e.b];
        if (e.sharp) sharp_corner_[e.a] = sharp_corner_[e.b] = 1;
        if (e.border()) border_corner_[e.a] = border_corner_[e.b] = 1;
    }
    std::inclusive_scan(count.begin(), count.end() - 1, count.begin());
    beside_end_.assign(count.begin(), count.end() - 1);
    std::vector<Index> at(points_.size());
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = i == 0 ? 0 : beside_end_[i - 1];
    beside_.resize(2 * edges_.size());
    for (const Edge& e : edges_) beside_[at[e.a]++] = e.b, beside_[at[e.b]++] = e.a;
    for (const Triangle& t : triangles_)
        for (std::size_t i = 0; i < 3; ++i)
        {
            const Vec3 u = points_[t.corner[(i + 1) % 3]] - points_[t.corner[i]], v = points_[t.corner[(i + 2) % 3]] - points_[t.corner[i]];
            corner_normal_[t.corner[i]] += std::atan2(length(cross(u, v)), dot(u, v)) * t.normal;
        }
}

/// Numbers patches in the order of their first triangles.
void TriangleSurface::find_patches()
{
    std::vector<std::uint8_t> seen(triangles_.size(), 0);
    std::vector<Index> open;
    Index patches = 0;
    for (Index seed = 0; seed < triangles_.size(); ++seed)
    {
        if (seen[seed]) continue;
        seen[seed] = 1, open.push_back(seed);
        while (!open.empty())
        {
            const Index t = open.back();
            open.pop_back();
            triangles_[t].patch = patches;
            for (const Index e : triangles_[t].edge)
                for (const Index next : edges_[e].side)
                    if (next != kNone && !seen[next] && dot(triangles_[t].normal, triangles_[next].normal) > kSmooth)
                        seen[next] = 1, open.push_back(next);
        }
        ++patches;
    }
}

/// Splits into halves of equal number along the longest side of each box.
void TriangleSurface::build_tree()
{
    struct Extent
    {
        Vec3 lower, upper;
        Vec3 sum;  // sum of the corners, three times the centroid
    };
    std::vector<Extent> extents;
    extents.reserve(triangles_.size());
    for (const Triangle& t : triangles_)
    {
        Extent& e = extents.emplace_back();
        const auto& c = t.corner;
        e.lower = e.upper = points_[c[0]], e.sum = points_[c[0]] + points_[c[1]] + points_[c[2]];
        for (std::size_t i = 1; i < 3; ++i)
            for (int k = 0; k < 3; ++k)
                e.lower[k] = std::min(e.lower[k], points_[c[i]][k]), e.upper[k] = std::max(e.upper[k], points_[c[i]][k]);
    }
    const auto bound = [&](Node& node)
    {
        node.lower = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, node.upper = -node.lower;
        for (Index i = node.first; i < node.first + node.count; ++i)
        {
            const Extent& e = extents[order_[i]];
            for (int k = 0; k < 3; ++k)
                node.lower[k] = std::min(node.lower[k], e.lower[k]), node.upper[k] = std::max(node.upper[k], e.upper[k]);
        }
    };
    order_.resize(triangles_.size());
    std::iota(order_.begin(), order_.end(), 0u);
    nodes_.reserve(triangles_.size());
    nodes_.push_back({{}, {}, 0, static_cast<Index>(order_.size())});
    // Depth first: what is split next is still in the processor's cache.
    std::vector<Index> open{0};
    while (!open.empty())
    {
        const Index n = open.back();
        open.pop_back();
        bound(nodes_[n]);
        const Node node = nodes_[n];
        if (node.count <= kLeaf) continue;
        const Vec3 size = node.upper - node.lower;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
        const auto before = [&](Index s, Index t)
        {
            const double ms = extents[s].sum[axis], mt = extents[t].sum[axis];
            return ms != mt ? ms < mt : s < t;
        };
        const auto first = order_.begin() + node.first;
        std::nth_element(first, first + node.count / 2, first + node.count, before);
        const Index left = static_cast<Index>(nodes_.size());
        nodes_[n].first = left, nodes_[n].count = 0;
        nodes_.push_back({{}, {}, node.first, node.count / 2});
        nodes_.push_back({{}, {}, node.first + node.count / 2, node.count - node.count / 2});
        open.push_back(left + 1), open.push_back(left);
    }
}

bool TriangleSurface::leaves_corner(std::uint32_t corner, const Vec3& m, double tolerance) const
{
    for (Index i = corner == 0 ? 0 : beside_end_[corner - 1]; i < beside_end_[corner]; ++i)
    {
        const Vec3 along = points_[beside_[i]] - points_[corner];
        if (dot(m, along) > tolerance * length(m) * length(along)) return false;
    }
    return true;
}

}  // namespace plab::detection
