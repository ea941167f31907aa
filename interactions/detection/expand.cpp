#include "expand.h"

#include <algorithm>
#include <cmath>

namespace plab::detection
{
namespace
{
constexpr double kEpsilon = 2.3e-16;
using PointIndex = std::uint16_t;

/// A convex polytope inside A - B: triangles with adjacency.
class Polytope
{
public:
    Polytope(const Solid& A, const Solid& B) : A_(A), B_(B), scale_(A.extent() + B.extent()) {}
    bool start();
    /// The outward direction along which the boundary of A - B is nearest to the origin.
    Vec3 grow(double tolerance);
    bool converged() const { return converged_; }

private:
    static constexpr std::size_t kMostPoints = 128, kMostFaces = 640;  // removed faces keep their index
    struct Face
    {
        std::array<PointIndex, 3> corner, beside;  ///< beside[i]: across the edge from corner[i] to the next
        Vec3 normal;
        double offset = 0;
        bool alive = true;
    };
    struct Rim
    {
        PointIndex from, to, beyond;  ///< an edge of the hole, and the face on its far side
    };

    PointIndex add_point(const Vec3& d);
    bool add_face(PointIndex a, PointIndex b, PointIndex c);
    bool link_first();
    std::size_t nearest() const;
    bool collect_rim(std::size_t seed, const Vec3& w);
    bool close_rim(PointIndex eye);

    const Solid& A_;
    const Solid& B_;
    double scale_;
    std::array<Vec3, kMostPoints> points_;
    std::array<Face, kMostFaces> faces_;
    std::array<PointIndex, kMostFaces> open_;
    std::array<Rim, kMostPoints> rim_, ordered_;
    std::size_t count_ = 0, face_count_ = 0, rim_count_ = 0;
    bool converged_ = true;
};

PointIndex Polytope::add_point(const Vec3& d)
{
    points_[count_] = support_of(A_, B_, d).w;
    return static_cast<PointIndex>(count_++);
}

bool Polytope::add_face(PointIndex a, PointIndex b, PointIndex c)
{
    if (face_count_ == kMostFaces) return false;
    Face& f = faces_[face_count_++];
    f.corner = {a, b, c}, f.beside = {}, f.alive = true;
    const Vec3 n = cross(points_[b] - points_[a], points_[c] - points_[a]);
    const double area = length(n);
    if (!(area > 0)) return false;
    f.normal = n / area;
    f.offset = std::max({dot(f.normal, points_[a]), dot(f.normal, points_[b]), dot(f.normal, points_[c])});
    return true;
}

/// Starts with a tetrahedron of support points: it is made as long, then as wide, then as thick as the axes tried allow.
bool Polytope::start()
{
    const auto further = [&](const Vec3& d, const Vec3& from)
    {
        const Vec3 p = support_of(A_, B_, d).w, q = support_of(A_, B_, -d).w;
        return std::fabs(dot(d, p - from)) >= std::fabs(dot(d, q - from)) ? d : -d;
    };
    double longest = -1;
    Vec3 along;
    for (int k = 0; k < 6; ++k)
    {
        const Vec3 d = k < 3 ? A_.axis(k) : B_.axis(k - 3);
        const double wide = dot(d, support_of(A_, B_, d).w - support_of(A_, B_, -d).w);
        if (wide > longest) longest = wide, along = d;
    }
    add_point(along), add_point(-along);
    const Vec3 u = normalized(points_[1] - points_[0]);
    if (length_squared(u) == 0) return false;
    const Vec3 v = any_perpendicular(u), v2 = cross(u, v);
    const auto width = [&](const Vec3& d) { return dot(d, support_of(A_, B_, d).w - support_of(A_, B_, -d).w); };
    add_point(further(width(v) >= width(v2) ? v : v2, points_[0]));
    const Vec3 n = normalized(cross(points_[1] - points_[0], points_[2] - points_[0]));
    if (length_squared(n) == 0) return false;
    add_point(further(n, points_[0]));
    const double height = dot(n, points_[3] - points_[0]);
    if (!(std::fabs(height) > kEpsilon * scale_)) return false;
    if (height > 0) std::swap(points_[1], points_[2]);
    return add_face(0, 1, 2) && add_face(0, 3, 1) && add_face(1, 3, 2) && add_face(2, 3, 0) && link_first();
}

bool Polytope::link_first()
{
    for (std::size_t f = 0; f < 4; ++f)
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t g = 0; g < 4; ++g)
                for (std::size_t j = 0; j < 3; ++j)
                    if (faces_[f].corner[i] == faces_[g].corner[(j + 1) % 3] && faces_[f].corner[(i + 1) % 3] == faces_[g].corner[j])
                        faces_[f].beside[i] = static_cast<PointIndex>(g);
    return true;
}

std::size_t Polytope::nearest() const
{
    std::size_t best = face_count_;
    for (std::size_t f = 0; f < face_count_; ++f)
        if (faces_[f].alive && (best == face_count_ || faces_[f].offset < faces_[best].offset)) best = f;
    return best;
}

/// Removes the faces that are visible from w; the edges to the remaining faces form the rim of the hole.
bool Polytope::collect_rim(std::size_t seed, const Vec3& w)
{
    std::size_t open = 0;
    rim_count_ = 0;
    faces_[seed].alive = false;
    open_[open++] = static_cast<PointIndex>(seed);
    for (std::size_t k = 0; k < open; ++k)
    {
        const Face& f = faces_[open_[k]];
        for (std::size_t i = 0; i < 3; ++i)
        {
            Face& g = faces_[f.beside[i]];
            if (!g.alive) continue;
            if (dot(g.normal, w) - g.offset > kEpsilon * scale_)
            {
                g.alive = false;
                open_[open++] = f.beside[i];
                continue;
            }
            if (rim_count_ == rim_.size()) return false;
            rim_[rim_count_++] = {f.corner[i], f.corner[(i + 1) % 3], f.beside[i]};
        }
    }
    return rim_count_ >= 3;
}

/// Closes the hole by triangles from the rim, which must be one closed loop, to the new point.
bool Polytope::close_rim(PointIndex eye)
{
    ordered_[0] = rim_[0];
    for (std::size_t k = 1; k < rim_count_; ++k)
    {
        const auto next = std::find_if(rim_.begin(), rim_.begin() + static_cast<std::ptrdiff_t>(rim_count_),
                                       [&](const Rim& r) { return r.from == ordered_[k - 1].to; });
        if (next == rim_.begin() + static_cast<std::ptrdiff_t>(rim_count_)) return false;
        ordered_[k] = *next;
    }
    if (ordered_[rim_count_ - 1].to != ordered_[0].from) return false;
    const auto first = static_cast<PointIndex>(face_count_);
    for (std::size_t k = 0; k < rim_count_; ++k)
    {
        const Rim& r = ordered_[k];
        if (!add_face(r.from, r.to, eye)) return false;
        const std::size_t next = (k + 1) % rim_count_, last = (k + rim_count_ - 1) % rim_count_;
        faces_[first + k].beside = {r.beyond, static_cast<PointIndex>(first + next), static_cast<PointIndex>(first + last)};
        Face& beyond = faces_[r.beyond];
        for (std::size_t i = 0; i < 3; ++i)
            if (beyond.corner[i] == r.to && beyond.corner[(i + 1) % 3] == r.from) beyond.beside[i] = static_cast<PointIndex>(first + k);
    }
    return true;
}

Vec3 Polytope::grow(double tolerance)
{
    Vec3 best{0, 0, 1};
    double least = HUGE_VAL;
    for (;;)
    {
        const std::size_t f = nearest();
        if (f == face_count_) break;
        const Vec3 n = faces_[f].normal;
        if (count_ == kMostPoints)
        {
            converged_ = false;
            break;
        }
        const PointIndex eye = add_point(n);
        const double support = dot(n, points_[eye]);
        if (support < least) least = support, best = n;
        if (least - faces_[f].offset <= std::max(tolerance * std::fabs(least), 4 * kEpsilon * scale_)) break;
        if (!collect_rim(f, points_[eye]) || !close_rim(eye))
        {
            converged_ = false;
            break;
        }
    }
    return best;
}

/// B, translated.
Solid moved(const Solid& B, const Vec3& by)
{
    Solid out = B;
    out.move(by);
    return out;
}

double depth_along(const Solid& A, const Solid& B, const Vec3& n) { return dot(n, support_of(A, B, n).w); }
}  // namespace

Overlap refine(const Solid& A, const Solid& B, const Vec3& n)
{
    constexpr int kMost = 16;
    const double scale = A.extent() + B.extent(), slack = 8 * kEpsilon * scale;
    // Far enough apart for accurate closest points, near enough to meet the same features.
    const double delta = 1e-3 * scale;
    const Support s = support_of(A, B, n);
    Overlap out{s.a, s.b, n, dot(n, s.w), true};
    for (int i = 0; i < kMost; ++i)
    {
        const Vec3 shift = (out.depth + delta) * out.normal;
        const NearestPair apart = nearest_pair(A, moved(B, shift));
        if (!apart.apart) break;
        if (i == 0) out.a = apart.a, out.b = apart.b - shift;  // a support point may be any corner of a face
        const double depth = depth_along(A, B, apart.normal);
        if (!(depth <= out.depth + slack)) break;
        const bool settled = length(apart.normal - out.normal) <= 8 * kEpsilon;
        out.normal = apart.normal, out.a = apart.a, out.b = apart.b - shift, out.depth = depth;
        if (settled) break;
    }
    return out;
}

Overlap overlap_of(const Solid& A, const Solid& B)
{
    const bool curved = A.curved() || B.curved();
    Vec3 n = normalized(B.center() - A.center());
    if (length_squared(n) == 0) n = {0, 0, 1};
    Polytope polytope(A, B);
    const bool started = polytope.start();
    if (started) n = polytope.grow(curved ? 0.02 : 0);
    Overlap out = refine(A, B, n);
    out.converged = started && polytope.converged();
    return out;
}

}  // namespace plab::detection
