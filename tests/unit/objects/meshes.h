/// Meshes with known integrals, counter-clockwise seen from outside.
#pragma once

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "plab/value.h"

namespace plab::test
{

struct MeshData
{
    std::vector<Vec3> vertices;
    std::vector<std::uint32_t> triangles;

    Reals reals() const
    {
        Reals out;
        for (const Vec3& v : vertices) out.insert(out.end(), {v.x, v.y, v.z});
        return out;
    }
    Integers integers() const { return {triangles.begin(), triangles.end()}; }
};

/// Corners at the origin and at a, b, c on the axes.
inline MeshData corner_tetrahedron(double a, double b, double c)
{
    return {{{0, 0, 0}, {a, 0, 0}, {0, b, 0}, {0, 0, c}}, {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}};
}

/// Vertex number: x + 2 y + 4 z.
inline MeshData box_mesh(const Vec3& half)
{
    MeshData mesh;
    for (int i = 0; i < 8; ++i) mesh.vertices.push_back({i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
    mesh.triangles = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    return mesh;
}

/// An icosahedron with each triangle cut in four `level` times and pushed out to the unit sphere.
inline MeshData icosphere(int level)
{
    const double g = (1 + std::sqrt(5.0)) / 2;
    MeshData mesh{{{-1, g, 0},
                   {1, g, 0},
                   {-1, -g, 0},
                   {1, -g, 0},
                   {0, -1, g},
                   {0, 1, g},
                   {0, -1, -g},
                   {0, 1, -g},
                   {g, 0, -1},
                   {g, 0, 1},
                   {-g, 0, -1},
                   {-g, 0, 1}},
                  {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4,  11, 10, 2,  10, 7, 6, 7, 1, 8,
                   3, 9,  4, 3, 4, 2, 3, 2, 6, 3, 6, 8,  3, 8,  9,  4, 9, 5, 2, 4,  11, 6,  2,  10, 8,  6, 7, 9, 8, 1}};
    for (Vec3& v : mesh.vertices) v = normalized(v);
    for (; level > 0; --level)
    {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b)
        {
            const auto [at, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
            if (fresh) mesh.vertices.push_back(normalized(mesh.vertices[a] + mesh.vertices[b]));
            return at->second;
        };
        std::vector<std::uint32_t> finer;
        for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
        {
            const std::uint32_t a = mesh.triangles[i], b = mesh.triangles[i + 1], c = mesh.triangles[i + 2];
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
        }
        mesh.triangles = std::move(finer);
    }
    return mesh;
}

}  // namespace plab::test
