/// The convex hull of points, as triangles: the geometry of Shape/ConvexHull, and the collision geometry of a mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "plab/result.h"
#include "plab/vector.h"

namespace plab
{

/// A closed convex polyhedron. For all points p inside, normals[f] . p <= offsets[f], up to the tolerance of its construction.
struct ConvexHull
{
    std::vector<Vec3> vertices;                        ///< only those on the hull, in their original order
    std::vector<std::array<std::uint32_t, 3>> faces;   ///< counter-clockwise seen from outside
    std::vector<std::array<std::uint32_t, 3>> beside;  ///< the face across the edge from corner i to the next corner
    std::vector<Vec3> normals;                         ///< unit, outwards, one per face
    std::vector<double> offsets;
};

/// Quickhull (Barber, Dobkin, Huhdanpaa, ACM TOMS 22, 1996): expands a tetrahedron until no point is outside. A new point replaces the
/// faces that it sees and also those in whose plane it lies, so that no sliver of nearly collinear points arises. If there are many
/// points, coplanar faces are replaced only where a sliver would arise; otherwise each of the n points of a flat rim would cause the
/// whole rim to be triangulated again.
class Quickhull
{
public:
    Quickhull(std::span<const Vec3> points, double tolerance) : points_(points), tolerance_(tolerance) {}

    /// False if the points do not span a volume.
    bool start();
    /// False if the hull folded over because of rounding; a larger tolerance may help.
    bool grow();
    /// Whether the hull is closed and no tested point is more than `most` (m) above a face. Rounding may have folded the hull.
    bool is_convex(double most) const;
    ConvexHull result() const;

private:
    using Index = std::uint32_t;
    using Edge = std::pair<Index, Index>;
    struct Face
    {
        std::array<Index, 3> corner;
        Vec3 normal;
        double offset = 0;
        std::vector<Index> outside;  ///< points above this face that are assigned to no other face
        bool alive = true;
    };

    double height(const Face& f, Index p) const { return dot(f.normal, points_[p]) - f.offset; }
    bool add_face(Index a, Index b, Index c);
    void assign(Index point, std::size_t first_face);
    bool collect_visible(std::size_t seed, Index eye);
    bool collect_above(std::size_t seed, Index eye, double least);
    bool leaves_sliver(Index eye) const;
    void restore_visible();
    bool replace_visible(Index eye);
    std::vector<Index> witnesses_of_folds() const;
    /// The point with the largest value of `measure`; ties go to the first.
    template <class Measure>
    std::pair<Index, double> find_extreme(Measure measure) const
    {
        std::pair<Index, double> best{0, -1.0};
        for (Index i = 0; i < points_.size(); ++i)
            if (const double m = measure(points_[i]); m > best.second) best = {i, m};
        return best;
    }

    std::span<const Vec3> points_;
    double tolerance_;
    std::vector<Face> faces_;
    std::map<Edge, std::size_t> owner_;  ///< face to the left of each directed edge
    std::vector<std::size_t> visible_;
};

inline bool Quickhull::start()
{
    const Vec3 p0 = points_[0];
    const auto [i1, d1] = find_extreme([&](const Vec3& p) { return length(p - p0); });
    if (d1 <= tolerance_) return false;
    const Vec3 e1 = normalized(points_[i1] - p0);
    const auto [i2, d2] = find_extreme([&](const Vec3& p) { return length(cross(e1, p - p0)); });
    if (d2 <= tolerance_) return false;
    const Vec3 n = normalized(cross(e1, points_[i2] - p0));
    const auto [i3, d3] = find_extreme([&](const Vec3& p) { return std::fabs(dot(n, p - p0)); });
    if (d3 <= tolerance_) return false;

    Index a = i1, b = i2;
    if (dot(n, points_[i3] - p0) > 0) std::swap(a, b);  // the base faces away from the fourth point
    if (!add_face(0, a, b) || !add_face(0, b, i3) || !add_face(b, a, i3) || !add_face(a, 0, i3)) return false;
    for (Index i = 0; i < points_.size(); ++i) assign(i, 0);
    return true;
}

inline bool Quickhull::add_face(Index a, Index b, Index c)
{
    Face f;
    f.corner = {a, b, c};
    f.normal = normalized(cross(points_[b] - points_[a], points_[c] - points_[a]));
    f.offset = std::max({dot(f.normal, points_[a]), dot(f.normal, points_[b]), dot(f.normal, points_[c])});
    for (std::size_t i = 0; i < 3; ++i) owner_[{f.corner[i], f.corner[(i + 1) % 3]}] = faces_.size();
    const bool solid = length_squared(f.normal) > 0;
    faces_.push_back(std::move(f));
    return solid;
}

inline void Quickhull::assign(Index point, std::size_t first_face)
{
    for (std::size_t f = first_face; f < faces_.size(); ++f)
    {
        if (!faces_[f].alive || height(faces_[f], point) <= tolerance_) continue;
        faces_[f].outside.push_back(point);
        return;
    }
}

/// Collects the patch of faces to be replaced by a cone to `eye`: those that it sees, and usually those in whose plane it lies.
inline bool Quickhull::collect_visible(std::size_t seed, Index eye)
{
    constexpr std::size_t kMany = 256;
    if (points_.size() > kMany)
    {
        if (collect_above(seed, eye, tolerance_) && !leaves_sliver(eye)) return true;
        restore_visible();
    }
    return collect_above(seed, eye, -tolerance_);
}

/// Collects the connected patch of faces over whose planes `eye` lies by more than `least`, starting from the face `seed`.
inline bool Quickhull::collect_above(std::size_t seed, Index eye, double least)
{
    visible_.assign(1, seed);
    faces_[seed].alive = false;
    for (std::size_t k = 0; k < visible_.size(); ++k)
    {
        const auto corner = faces_[visible_[k]].corner;
        for (std::size_t i = 0; i < 3; ++i)
        {
            const auto next = owner_.find({corner[(i + 1) % 3], corner[i]});
            if (next == owner_.end()) return false;
            if (!faces_[next->second].alive || height(faces_[next->second], eye) <= least) continue;
            faces_[next->second].alive = false;
            visible_.push_back(next->second);
        }
    }
    return true;
}

/// Whether `eye` is nearly collinear with an edge of the visible patch's rim.
inline bool Quickhull::leaves_sliver(Index eye) const
{
    constexpr double kThin =
        1e-8;  // height of the triangle relative to its longest side: the face then agrees with a coplanar neighbour to 1e-8
    for (const std::size_t v : visible_)
    {
        const auto corner = faces_[v].corner;
        for (std::size_t i = 0; i < 3; ++i)
        {
            const Index from = corner[i], to = corner[(i + 1) % 3];
            if (!faces_[owner_.at({to, from})].alive) continue;
            const Vec3 edge = points_[to] - points_[from], first = points_[eye] - points_[from], second = points_[eye] - points_[to];
            const double longest = std::max({length_squared(edge), length_squared(first), length_squared(second)});
            if (!(length(cross(edge, first)) > kThin * longest)) return true;
        }
    }
    return false;
}

inline void Quickhull::restore_visible()
{
    for (const std::size_t v : visible_) faces_[v].alive = true;
}

/// Fills the hole left by the visible patch with a cone of faces to `eye`; the rim must be one closed line.
inline bool Quickhull::replace_visible(Index eye)
{
    const std::size_t first_new = faces_.size();
    std::map<Index, Index> rim;
    for (const std::size_t v : visible_)
    {
        const auto corner = faces_[v].corner;
        for (std::size_t i = 0; i < 3; ++i)
        {
            const Edge e{corner[i], corner[(i + 1) % 3]};
            if (!faces_[owner_.at({e.second, e.first})].alive) continue;
            if (!rim.insert(e).second) return false;
        }
    }
    if (rim.size() < 3) return false;
    std::size_t round = 0;
    for (Index at = rim.begin()->first; round <= rim.size();)
    {
        const auto next = rim.find(at);
        if (next == rim.end()) return false;
        at = next->second, ++round;
        if (at == rim.begin()->first) break;
    }
    if (round != rim.size()) return false;
    for (const auto& [from, to] : rim)
        if (!add_face(from, to, eye)) return false;
    for (const std::size_t v : visible_)
        for (const Index p : std::exchange(faces_[v].outside, {}))
            if (p != eye) assign(p, first_new);
    return true;
}

inline bool Quickhull::grow()
{
    for (std::size_t f = 0; f < faces_.size(); ++f)
    {
        if (!faces_[f].alive || faces_[f].outside.empty()) continue;
        Index eye = faces_[f].outside.front();
        for (const Index p : faces_[f].outside)
            if (height(faces_[f], p) > height(faces_[f], eye)) eye = p;
        if (!collect_visible(f, eye) || !replace_visible(eye)) return false;
    }
    return true;
}

inline bool Quickhull::is_convex(double most) const
{
    const std::vector<Index> witnesses = witnesses_of_folds();
    const auto is_below = [&](const Face& f)
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            const auto next = owner_.find({f.corner[(i + 1) % 3], f.corner[i]});
            if (next == owner_.end() || !faces_[next->second].alive) return false;
            for (const Index c : faces_[next->second].corner)
                if (height(f, c) > most) return false;
        }
        return std::all_of(witnesses.begin(), witnesses.end(), [&](Index p) { return height(f, p) <= most; });
    };
    return std::all_of(faces_.begin(), faces_.end(), [&](const Face& f) { return !f.alive || is_below(f); });
}

/// The points against which faces are tested: all of them while that is cheap, else the extreme points in 26 directions, which a badly
/// tilted face rarely contains.
inline std::vector<Quickhull::Index> Quickhull::witnesses_of_folds() const
{
    constexpr std::size_t kCheap = 10'000'000;
    std::vector<Index> out;
    if (points_.size() * faces_.size() <= kCheap)
        for (Index i = 0; i < points_.size(); ++i) out.push_back(i);
    else
        for (int k = 0; k < 27; ++k)
        {
            const Vec3 direction{k % 3 - 1.0, k / 3 % 3 - 1.0, k / 9 - 1.0};
            const double low = dot(direction, points_[0]);
            out.push_back(find_extreme([&](const Vec3& p) { return std::max(0.0, dot(direction, p) - low); }).first);
        }
    return out;
}

inline ConvexHull Quickhull::result() const
{
    ConvexHull hull;
    std::vector<Index> kept(points_.size(), 0), number(faces_.size(), 0);
    for (const Face& f : faces_)
        if (f.alive)
            for (const Index c : f.corner) kept[c] = 1;
    for (Index i = 0; i < points_.size(); ++i)
    {
        if (!kept[i]) continue;
        kept[i] = static_cast<Index>(hull.vertices.size());
        hull.vertices.push_back(points_[i]);
    }
    Index count = 0;
    for (std::size_t f = 0; f < faces_.size(); ++f)
        if (faces_[f].alive) number[f] = count++;
    for (const Face& f : faces_)
    {
        if (!f.alive) continue;
        hull.faces.push_back({kept[f.corner[0]], kept[f.corner[1]], kept[f.corner[2]]});
        auto& beside = hull.beside.emplace_back();
        for (std::size_t i = 0; i < 3; ++i) beside[i] = number[owner_.at({f.corner[(i + 1) % 3], f.corner[i]})];
        hull.normals.push_back(f.normal);
        hull.offsets.push_back(f.offset);
    }
    return hull;
}

/// Points within 1e-12 of the extent above a face count as on it and are dropped (up to 1e-8 for point sets that are difficult to round).
/// The hull has that accuracy, and no corner is further above a neighbour's face than 1e-9 of the extent (1e-7 at worst). Fails with the
/// reason if the points do not span a volume.
inline Result<ConvexHull> make_convex_hull(std::span<const Vec3> points)
{
    if (points.size() < 4) return reason("a hull needs at least 4 vertices, not " + std::to_string(points.size()));
    double extent = 0;
    for (const Vec3& p : points)
    {
        if (!is_finite(p)) return reason("a vertex of the hull is not finite");
        extent = std::max({extent, std::fabs(p.x - points[0].x), std::fabs(p.y - points[0].y), std::fabs(p.z - points[0].z)});
    }
    for (double tolerance = 1e-12; tolerance < 1e-7; tolerance *= 10)
    {
        Quickhull hull(points, tolerance * extent);
        if (!hull.start()) return reason("the vertices lie in a plane: their hull has no volume");
        if (hull.grow() && hull.is_convex(std::max(1e-9, 10 * tolerance) * extent)) return hull.result();
    }
    return reason("the vertices are too close to common planes and lines for a hull accurate to 1e-8 of their extent; use fewer vertices");
}

/// Whether a mesh is about what its hull is. The surface of a hull is covered once by a mesh that is closed and convex, in part by one that
/// is open, and more than once, as a rule, by one that is hollow. Points without triangles have nothing but their hull.
inline bool fills_hull(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles, const ConvexHull& hull)
{
    constexpr double kSameArea = 0.05;
    const auto area = [](const Vec3& a, const Vec3& b, const Vec3& c) { return 0.5 * length(cross(b - a, c - a)); };
    double of_mesh = 0, of_hull = 0;
    for (std::size_t i = 0; i + 2 < triangles.size(); i += 3)
        of_mesh += area(vertices[triangles[i]], vertices[triangles[i + 1]], vertices[triangles[i + 2]]);
    for (const auto& [a, b, c] : hull.faces) of_hull += area(hull.vertices[a], hull.vertices[b], hull.vertices[c]);
    return triangles.empty() || std::fabs(of_mesh - of_hull) <= kSameArea * of_hull;
}

}  // namespace plab
