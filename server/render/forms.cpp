#include "forms.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <utility>

namespace plab::render
{
namespace
{

std::uint32_t count_of(const Surface& surface) { return static_cast<std::uint32_t>(surface.corners.size()); }

void add_quad(Surface& out, const std::array<Vec3, 4>& corners, const std::array<Vec3, 4>& normals)
{
    const std::uint32_t first = count_of(out);
    for (std::size_t i = 0; i < 4; ++i) out.corners.push_back({floats(corners[i]), floats(normals[i])});
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) out.triangles.push_back(first + i);
}

struct Triangulation
{
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

Triangulation icosahedron()
{
    const double g = std::numbers::phi;
    Triangulation out;
    for (const double a : {-1.0, 1.0})
        for (const double b : {-g, g})
            for (const Vec3& v : {Vec3{0, a, b}, Vec3{a, b, 0}, Vec3{b, 0, a}}) out.vertices.push_back(normalized(v));
    // Every three vertices at edge length from one another are a face.
    const auto joined = [&](std::size_t i, std::size_t j) { return length(out.vertices[i] - out.vertices[j]) < 1.1; };
    for (std::uint32_t i = 0; i < 12; ++i)
        for (std::uint32_t j = i + 1; j < 12; ++j)
            for (std::uint32_t k = j + 1; k < 12; ++k)
            {
                if (!joined(i, j) || !joined(j, k) || !joined(k, i)) continue;
                const bool outward = dot(cross(out.vertices[i], out.vertices[j]), out.vertices[k]) > 0;
                out.triangles.push_back(outward ? std::array{i, j, k} : std::array{i, k, j});
            }
    return out;
}

/// Each triangle in four, new vertices pushed out to the sphere.
void subdivide(Triangulation& sphere)
{
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b)
    {
        const auto [found, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(sphere.vertices.size()));
        if (fresh) sphere.vertices.push_back(normalized(sphere.vertices[a] + sphere.vertices[b]));
        return found->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : sphere.triangles)
    {
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    sphere.triangles = std::move(finer);
}

/// Faces that meet at less than this are one smooth surface.
const double kCreaseCosine = std::cos(std::numbers::pi * 35 / 180);
/// Around a vertex of more faces than this, each is compared to every other: too slow to be worth it, so it stays sharp.
constexpr std::size_t kMostFaces = 256;

Result<void> check_triangles(const Mesh& mesh)
{
    if (mesh.triangles.size() % 3 != 0)
        return reason("triangles must be triples of vertex numbers, not " + std::to_string(mesh.triangles.size()) + " numbers");
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (mesh.triangles[i] >= mesh.vertices.size())
            return reason("triangle " + std::to_string(i / 3) + " names vertex " + std::to_string(mesh.triangles[i]) + "; there are " +
                          std::to_string(mesh.vertices.size()) + " vertices, numbered from 0");
    return {};
}

/// The first vertex at the same place, for each: files repeat vertices per face.
std::vector<std::uint32_t> first_at_place(const std::vector<Vec3>& vertices)
{
    std::vector<std::uint32_t> order(vertices.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto place = [&](std::uint32_t i) { return std::tie(vertices[i].x, vertices[i].y, vertices[i].z); };
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); });
    std::vector<std::uint32_t> first(vertices.size());
    for (std::size_t k = 0; k < order.size(); ++k)
        first[order[k]] = k > 0 && vertices[order[k]] == vertices[order[k - 1]] ? first[order[k - 1]] : order[k];
    return first;
}

/// Twice the area, along the normal; zero for a degenerate triangle.
std::vector<Vec3> area_normals(const Mesh& mesh)
{
    std::vector<Vec3> out;
    for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3)
    {
        const Vec3& a = mesh.vertices[mesh.triangles[i]];
        out.push_back(cross(mesh.vertices[mesh.triangles[i + 1]] - a, mesh.vertices[mesh.triangles[i + 2]] - a));
    }
    return out;
}

/// The mean normal of those faces around a vertex that continue `face` smoothly.
Vec3 smooth_normal(std::size_t face, const std::vector<std::uint32_t>& around, const std::vector<Vec3>& normals)
{
    const Vec3 own = normalized(normals[face]);
    if (around.size() > kMostFaces) return own;
    Vec3 sum;
    for (const std::uint32_t other : around)
        if (dot(own, normals[other]) >= kCreaseCosine * length(normals[other])) sum += normals[other];
    return normalized(sum);
}

}  // namespace

Surface unit_sphere(int level)
{
    Triangulation sphere = icosahedron();
    for (int i = 0; i < level; ++i) subdivide(sphere);
    Surface out;
    for (const Vec3& v : sphere.vertices) out.corners.push_back({floats(v), floats(v)});
    for (const auto& triangle : sphere.triangles) out.triangles.insert(out.triangles.end(), triangle.begin(), triangle.end());
    return out;
}

Surface unit_box()
{
    Surface out;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0})
        {
            Vec3 n, u, v;
            n[axis] = side, u[(axis + 1) % 3] = side, v[(axis + 2) % 3] = 1;
            add_quad(out, {n - u - v, n + u - v, n + u + v, n - u + v}, {n, n, n, n});
        }
    return out;
}

Surface unit_cylinder(int sides)
{
    Surface out;
    const Vec3 top{0, 0, 1}, bottom{0, 0, -1};
    const auto direction = [&](int i)
    {
        const double angle = 2 * std::numbers::pi * (i % sides) / sides;
        return Vec3{std::cos(angle), std::sin(angle), 0};
    };
    for (int i = 0; i < sides; ++i)
    {
        const Vec3 a = direction(i), b = direction(i + 1);
        add_quad(out, {a + bottom, b + bottom, b + top, a + top}, {a, b, b, a});
        for (const Vec3& end : {top, bottom})
        {
            const Vec3 &first = end.z > 0 ? a : b, &second = end.z > 0 ? b : a;
            const std::uint32_t at = count_of(out);
            for (const Vec3& p : {end, first + end, second + end}) out.corners.push_back({floats(p), floats(end)});
            out.triangles.insert(out.triangles.end(), {at, at + 1, at + 2});
        }
    }
    return out;
}

Surface unit_disc(int sides)
{
    Surface out;
    const double outer = 1 / std::cos(std::numbers::pi / sides);
    for (int i = 0; i < sides; ++i)
    {
        const double angle = 2 * std::numbers::pi * (i + 0.5) / sides;
        out.corners.push_back({floats({outer * std::cos(angle), outer * std::sin(angle), 0}), {0, 0, 1}});
        const auto k = static_cast<std::uint32_t>(i);
        if (k >= 2) out.triangles.insert(out.triangles.end(), {0, k - 1, k});
    }
    return out;
}

Result<Surface> surface_of(const Mesh& mesh)
{
    if (auto fine = check_triangles(mesh); !fine) return fine.error();
    const std::vector<std::uint32_t> first = first_at_place(mesh.vertices);
    const std::vector<Vec3> normals = area_normals(mesh);
    std::vector<std::vector<std::uint32_t>> around(mesh.vertices.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) around[first[mesh.triangles[i]]].push_back(static_cast<std::uint32_t>(i / 3));

    Surface out;
    std::vector<std::vector<std::uint32_t>> made(mesh.vertices.size());  // corners at each place: most are used again
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    {
        const std::uint32_t place = first[mesh.triangles[i]];
        const Corner corner{floats(mesh.vertices[place]), floats(smooth_normal(i / 3, around[place], normals))};
        std::vector<std::uint32_t>& known = made[place];
        auto same = std::find_if(known.begin(), known.end(), [&](std::uint32_t k) { return out.corners[k] == corner; });
        if (same == known.end())
        {
            known.push_back(count_of(out));
            same = known.end() - 1;
            out.corners.push_back(corner);
        }
        out.triangles.push_back(*same);
    }
    return out;
}

}  // namespace plab::render
