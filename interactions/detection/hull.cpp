#include "hull.h"

namespace plab::detection
{
namespace
{
using Index = std::uint32_t;

/// Cosine between the normals of coplanar faces. The angle is 1.4e-6, more than vertices rounded to 7 digits cause.
constexpr double kFlatHull = 1 - 1e-12;

void find_bounds(Hull& hull)
{
    hull.lower = hull.upper = hull.vertices.front();
    for (const Vec3& p : hull.vertices) hull.center += p / static_cast<double>(hull.vertices.size());
    for (const Vec3& p : hull.vertices)
        for (int k = 0; k < 3; ++k)
        {
            hull.lower[k] = std::min(hull.lower[k], p[k]);
            hull.upper[k] = std::max(hull.upper[k], p[k]);
        }
    for (const Vec3& p : hull.vertices) hull.extent = std::max(hull.extent, length(p - hull.center));
}

void find_reaches(Hull& hull)
{
    for (const auto& face : hull.faces)
    {
        const Vec3 middle = (hull.vertices[face[0]] + hull.vertices[face[1]] + hull.vertices[face[2]]) / 3;
        double reach = 0;
        for (const Index corner : face) reach = std::max(reach, length(hull.vertices[corner] - middle));
        hull.middles.push_back(middle), hull.reaches.push_back(reach);
    }
}

void find_edges(Hull& hull)
{
    for (std::size_t f = 0; f < hull.faces.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i)
        {
            const Index a = hull.faces[f][i], b = hull.faces[f][(i + 1) % 3];
            if (a < b && dot(hull.normals[f], hull.normals[hull.beside[f][i]]) <= kFlatHull) hull.edges.push_back({a, b});
        }
}

/// Gives one number to all faces that are coplanar with `seed` and connected to it.
std::vector<std::size_t> joined_faces(const Hull& hull, std::size_t seed, std::vector<std::uint8_t>& taken)
{
    std::vector<std::size_t> out{seed};
    taken[seed] = 1;
    for (std::size_t k = 0; k < out.size(); ++k)
        for (const Index next : hull.beside[out[k]])
        {
            if (taken[next] || dot(hull.normals[seed], hull.normals[next]) <= kFlatHull) continue;
            taken[next] = 1;
            out.push_back(next);
        }
    return out;
}

/// The border of merged faces; empty if it is not one closed loop.
std::vector<Index> border_of(const Hull& hull, const std::vector<std::size_t>& joined)
{
    std::map<Index, Index> rim;
    for (const std::size_t f : joined)
        for (std::size_t i = 0; i < 3; ++i)
        {
            if (std::find(joined.begin(), joined.end(), hull.beside[f][i]) != joined.end()) continue;
            if (!rim.emplace(hull.faces[f][i], hull.faces[f][(i + 1) % 3]).second) return {};
        }
    std::vector<Index> out;
    if (rim.empty()) return out;
    for (Index at = rim.begin()->first; out.size() < rim.size();)
    {
        out.push_back(at);
        const auto next = rim.find(at);
        if (next == rim.end()) return {};
        at = next->second;
        if (at == out.front()) break;
    }
    return out.size() == rim.size() ? out : std::vector<Index>{};
}

void find_polygons(Hull& hull)
{
    std::vector<std::uint8_t> taken(hull.faces.size(), 0);
    const auto add = [&](std::span<const Index> corners, const Vec3& normal)
    {
        hull.loop.insert(hull.loop.end(), corners.begin(), corners.end());
        hull.loop_end.push_back(static_cast<Index>(hull.loop.size()));
        hull.loop_normals.push_back(normal);
    };
    for (std::size_t f = 0; f < hull.faces.size(); ++f)
    {
        if (taken[f]) continue;
        const std::vector<std::size_t> joined = joined_faces(hull, f, taken);
        if (const std::vector<Index> border = border_of(hull, joined); !border.empty())
            add(border, hull.normals[f]);
        else
            for (const std::size_t g : joined) add(hull.faces[g], hull.normals[g]);
    }
}
}  // namespace

Result<Hull> make_hull(std::span<const Vec3> points)
{
    auto convex = make_convex_hull(points);
    if (!convex) return convex.error();
    Hull hull;
    static_cast<ConvexHull&>(hull) = convex.take();
    find_bounds(hull);
    find_reaches(hull);
    find_edges(hull);
    find_polygons(hull);
    hull.vertex_columns = PointColumns(hull.vertices), hull.loop_normal_columns = PointColumns(hull.loop_normals);
    return hull;
}

}  // namespace plab::detection
