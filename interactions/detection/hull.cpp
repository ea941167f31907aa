#include "hull.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace plab::detection
{
namespace
{
using Index = std::uint32_t;
using Edge = std::pair<Index, Index>;

struct Face
{
    std::array<Index, 3> corner;
    Vec3 normal;
    double offset = 0;
    std::vector<Index> outside;  ///< points above this face that no other face has taken
    bool alive = true;
};

/// Grows a tetrahedron face by face until no point is outside.
class Quickhull
{
public:
    Quickhull(std::span<const Vec3> points, double tolerance) : points_(points), tolerance_(tolerance) {}

    bool start();
    void grow();
    Hull result() const;

private:
    double height(const Face& f, Index p) const { return dot(f.normal, points_[p]) - f.offset; }
    void add_face(Index a, Index b, Index c);
    void assign(Index point, std::size_t first_face);
    void collect_visible(std::size_t seed, Index eye);
    void replace_visible(Index eye);

    std::span<const Vec3> points_;
    double tolerance_;
    std::vector<Face> faces_;
    std::map<Edge, std::size_t> owner_;  ///< face to the left of each directed edge
    std::vector<std::size_t> visible_;
};

/// The point with the largest value of `measure`; ties go to the first.
template <class Measure>
std::pair<Index, double> find_extreme(std::span<const Vec3> points, Measure measure)
{
    std::pair<Index, double> best{0, -1.0};
    for (Index i = 0; i < points.size(); ++i)
        if (const double m = measure(points[i]); m > best.second) best = {i, m};
    return best;
}

bool Quickhull::start()
{
    const Vec3 p0 = points_[0];
    const auto [i1, d1] = find_extreme(points_, [&](const Vec3& p) { return length(p - p0); });
    if (d1 <= tolerance_) return false;
    const Vec3 e1 = normalized(points_[i1] - p0);
    const auto [i2, d2] = find_extreme(points_, [&](const Vec3& p) { return length(cross(e1, p - p0)); });
    if (d2 <= tolerance_) return false;
    const Vec3 n = normalized(cross(e1, points_[i2] - p0));
    const auto [i3, d3] = find_extreme(points_, [&](const Vec3& p) { return std::fabs(dot(n, p - p0)); });
    if (d3 <= tolerance_) return false;

    Index a = i1, b = i2;
    if (dot(n, points_[i3] - p0) > 0) std::swap(a, b);  // the base looks away from the fourth point
    add_face(0, a, b), add_face(0, b, i3), add_face(b, a, i3), add_face(a, 0, i3);
    for (Index i = 0; i < points_.size(); ++i) assign(i, 0);
    return true;
}

void Quickhull::add_face(Index a, Index b, Index c)
{
    Face f;
    f.corner = {a, b, c};
    f.normal = normalized(cross(points_[b] - points_[a], points_[c] - points_[a]));
    f.offset = std::max({dot(f.normal, points_[a]), dot(f.normal, points_[b]), dot(f.normal, points_[c])});
    for (int i = 0; i < 3; ++i)
        owner_[{f.corner[static_cast<std::size_t>(i)], f.corner[static_cast<std::size_t>((i + 1) % 3)]}] = faces_.size();
    faces_.push_back(std::move(f));
}

void Quickhull::assign(Index point, std::size_t first_face)
{
    for (std::size_t f = first_face; f < faces_.size(); ++f)
    {
        if (!faces_[f].alive || height(faces_[f], point) <= tolerance_) continue;
        faces_[f].outside.push_back(point);
        return;
    }
}

/// The connected patch of faces that `eye` sees, from the face `seed`.
void Quickhull::collect_visible(std::size_t seed, Index eye)
{
    visible_.assign(1, seed);
    faces_[seed].alive = false;
    for (std::size_t k = 0; k < visible_.size(); ++k)
    {
        const auto corner = faces_[visible_[k]].corner;
        for (std::size_t i = 0; i < 3; ++i)
        {
            const std::size_t next = owner_.at({corner[(i + 1) % 3], corner[i]});
            if (!faces_[next].alive || height(faces_[next], eye) <= tolerance_) continue;
            faces_[next].alive = false;
            visible_.push_back(next);
        }
    }
}

/// Fills the hole that the visible patch leaves with a cone of faces to `eye`.
void Quickhull::replace_visible(Index eye)
{
    const std::size_t first_new = faces_.size();
    std::vector<Edge> horizon;
    for (const std::size_t v : visible_)
    {
        const auto corner = faces_[v].corner;
        for (std::size_t i = 0; i < 3; ++i)
        {
            const Edge e{corner[i], corner[(i + 1) % 3]};
            if (faces_[owner_.at({e.second, e.first})].alive) horizon.push_back(e);
        }
    }
    for (const Edge& e : horizon) add_face(e.first, e.second, eye);
    for (const std::size_t v : visible_)
        for (const Index p : std::exchange(faces_[v].outside, {}))
            if (p != eye) assign(p, first_new);
}

void Quickhull::grow()
{
    for (std::size_t f = 0; f < faces_.size(); ++f)
    {
        if (!faces_[f].alive || faces_[f].outside.empty()) continue;
        Index eye = faces_[f].outside.front();
        for (const Index p : faces_[f].outside)
            if (height(faces_[f], p) > height(faces_[f], eye)) eye = p;
        collect_visible(f, eye);
        replace_visible(eye);
    }
}

Hull Quickhull::result() const
{
    Hull hull;
    std::vector<Index> kept(points_.size(), 0);
    for (const Face& f : faces_)
        if (f.alive)
            for (const Index c : f.corner) kept[c] = 1;
    for (Index i = 0; i < points_.size(); ++i)
    {
        if (!kept[i]) continue;
        kept[i] = static_cast<Index>(hull.vertices.size());
        hull.vertices.push_back(points_[i]);
    }
    hull.lower = hull.upper = hull.vertices.front();
    for (const Vec3& p : hull.vertices) hull.center += p / static_cast<double>(hull.vertices.size());
    for (const Vec3& p : hull.vertices)
        for (int k = 0; k < 3; ++k)
        {
            hull.lower[k] = std::min(hull.lower[k], p[k]);
            hull.upper[k] = std::max(hull.upper[k], p[k]);
        }
    for (const Face& f : faces_)
    {
        if (!f.alive) continue;
        hull.faces.push_back({kept[f.corner[0]], kept[f.corner[1]], kept[f.corner[2]]});
        for (std::size_t i = 0; i < 3; ++i)
        {
            const Index a = f.corner[i], b = f.corner[(i + 1) % 3];
            const bool flat = dot(f.normal, faces_[owner_.at({b, a})].normal) > 1 - 1e-12;
            if (a < b && !flat) hull.edges.push_back({kept[a], kept[b]});
        }
        hull.normals.push_back(f.normal);
        hull.offsets.push_back(f.offset);
    }
    return hull;
}
}  // namespace

Result<Hull> make_hull(std::span<const Vec3> points)
{
    if (points.size() < 4) return reason("a hull needs at least 4 vertices, not " + std::to_string(points.size()));
    double extent = 0;
    for (const Vec3& p : points)
    {
        if (!is_finite(p)) return reason("a vertex of the hull is not finite");
        extent = std::max({extent, std::fabs(p.x - points[0].x), std::fabs(p.y - points[0].y), std::fabs(p.z - points[0].z)});
    }
    Quickhull hull(points, 1e-12 * extent);
    if (!hull.start()) return reason("the vertices lie in a plane: their hull has no volume");
    hull.grow();
    return hull.result();
}

}  // namespace plab::detection
