#include "mesh_topology.h"

#include <algorithm>
#include <tuple>
#include <vector>

namespace plab::shapes
{
namespace
{

/// One side of a triangle; forward: it runs from the lower to the higher vertex number.
struct Side
{
    std::uint32_t low, high;
    bool forward;
};

/// The sides of all triangles with three different corners, sorted so that equal edges are adjacent.
std::vector<Side> sorted_sides(std::span<const std::uint32_t> triangles)
{
    std::vector<Side> sides;
    sides.reserve(triangles.size());
    for (std::size_t i = 0; i + 2 < triangles.size(); i += 3)
    {
        const std::uint32_t corner[] = {triangles[i], triangles[i + 1], triangles[i + 2]};
        // Two corners at the same vertex: the triangle is a line whose two sides cancel.
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
        for (int k = 0; k < 3; ++k)
        {
            const std::uint32_t from = corner[k], to = corner[(k + 1) % 3];
            sides.push_back({std::min(from, to), std::max(from, to), from < to});
        }
    }
    std::sort(sides.begin(), sides.end(),
              [](const Side& a, const Side& b) { return std::tie(a.low, a.high, a.forward) < std::tie(b.low, b.high, b.forward); });
    return sides;
}

std::string name_of_edge(const Side& side) { return std::to_string(side.low) + "-" + std::to_string(side.high); }

/// `uses`: all sides along one edge.
Result<void> check_edge(std::span<const Side> uses)
{
    if (uses.size() == 2 && uses[0].forward != uses[1].forward) return {};
    const std::string edge = name_of_edge(uses.front());
    if (uses.size() == 1) return reason("mesh is open at edge " + edge + "; every edge must have two triangles");
    if (uses.size() > 2)
        return reason("mesh is not a manifold: edge " + edge + " has " + std::to_string(uses.size()) +
                      " triangles; every edge must have two");
    return reason("mesh is wound inconsistently: the two triangles at edge " + edge + " run along it in the same direction");
}

Result<void> check_edges(std::span<const std::uint32_t> triangles)
{
    const std::vector<Side> sides = sorted_sides(triangles);
    if (sides.empty()) return reason("mesh has no volume; it must enclose a solid");
    for (std::size_t begin = 0; begin < sides.size();)
    {
        std::size_t end = begin + 1;
        while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
        if (auto edge = check_edge(std::span(sides).subspan(begin, end - begin)); !edge) return edge;
        begin = end;
    }
    return {};
}

/// The triangles with each vertex replaced by the first one at the same position.
std::vector<std::uint32_t> welded(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles)
{
    std::vector<std::uint32_t> order(vertices.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto place = [&](std::uint32_t i) { return std::tuple(vertices[i].x, vertices[i].y, vertices[i].z); };
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return place(a) != place(b) ? place(a) < place(b) : a < b; });

    std::vector<std::uint32_t> first(vertices.size());
    for (std::size_t k = 0; k < order.size(); ++k)
        first[order[k]] = k > 0 && place(order[k]) == place(order[k - 1]) ? first[order[k - 1]] : order[k];

    std::vector<std::uint32_t> out(triangles.begin(), triangles.end());
    for (std::uint32_t& v : out) v = first[v];
    return out;
}

}  // namespace

Result<void> check_closed(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles)
{
    if (check_edges(triangles)) return {};
    return check_edges(welded(vertices, triangles));
}

}  // namespace plab::shapes
