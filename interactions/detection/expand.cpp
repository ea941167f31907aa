#include "expand.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

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
    Polytope(const Polytope&) = delete;
    Polytope& operator=(const Polytope&) = delete;
    /// Starts with the tetrahedron of a simplex that encloses the origin, if it is not too flat, or with one of its own.
    bool start(const Simplex& simplex);
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
    /// Room for many elements, which only those that are used take time to make.
    template <class T, std::size_t N>
    class Room
    {
    public:
        T& make(std::size_t i) { return *std::construct_at(&all()[i]); }
        T& operator[](std::size_t i) { return all()[i]; }
        const T& operator[](std::size_t i) const { return const_cast<Room&>(*this).all()[i]; }

    private:
        static_assert(std::is_trivially_destructible_v<T>);
        T* all() { return std::launder(reinterpret_cast<T*>(bytes_)); }
        alignas(T) std::byte bytes_[N * sizeof(T)];
    };
    struct Rim
    {
        PointIndex from, to, beyond;  ///< an edge of the hole, and the face on its far side
    };

    PointIndex add_point(const Vec3& d);
    bool begin_with_axes();
    bool close_first();
    bool add_face(PointIndex a, PointIndex b, PointIndex c);
    std::size_t nearest() const;
    bool collect_rim(std::size_t seed, const Vec3& w);
    bool close_rim(PointIndex eye);

    const Solid& A_;
    const Solid& B_;
    double scale_;
    Room<Vec3, kMostPoints> points_;
    Room<Face, kMostFaces> faces_;
    std::array<PointIndex, kMostFaces> open_;
    std::array<Rim, kMostPoints> rim_, ordered_;
    std::size_t count_ = 0, face_count_ = 0, rim_count_ = 0;
    bool converged_ = true;
};

PointIndex Polytope::add_point(const Vec3& d)
{
    points_.make(count_) = support_of(A_, B_, d).w;
    return static_cast<PointIndex>(count_++);
}

bool Polytope::add_face(PointIndex a, PointIndex b, PointIndex c)
{
    if (face_count_ == kMostFaces) return false;
    Face& f = faces_.make(face_count_++);
    f.corner = {a, b, c}, f.beside = {}, f.alive = true;
    const Vec3 n = cross(points_[b] - points_[a], points_[c] - points_[a]);
    const double area = length(n);
    if (!(area > 0)) return false;
    f.normal = n / area;
    f.offset = std::max({dot(f.normal, points_[a]), dot(f.normal, points_[b]), dot(f.normal, points_[c])});
    return true;
}

bool Polytope::start(const Simplex& simplex)
{
    if (simplex.encloses && simplex.count == 4)
    {
        for (std::size_t i = 0; i < 4; ++i) points_.make(count_++) = simplex.at[i].w;
        if (close_first()) return true;
        count_ = face_count_ = 0;
    }
    return begin_with_axes() && close_first();
}

/// A tetrahedron of support points: it is made as long, then as wide, then as thick as the axes tried allow.
bool Polytope::begin_with_axes()
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
    return true;
}

/// Makes the faces of the first four points.
bool Polytope::close_first()
{
    const Vec3 n = normalized(cross(points_[1] - points_[0], points_[2] - points_[0]));
    const double height = dot(n, points_[3] - points_[0]);
    if (!(std::fabs(height) > kEpsilon * scale_)) return false;
    if (height > 0) std::swap(points_[1], points_[2]);
    if (!(add_face(0, 1, 2) && add_face(0, 3, 1) && add_face(1, 3, 2) && add_face(2, 3, 0))) return false;
    faces_[0].beside = {1, 2, 3}, faces_[1].beside = {3, 2, 0}, faces_[2].beside = {1, 3, 0}, faces_[3].beside = {2, 1, 0};
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

Overlap refine(const Solid& A, const Solid& B, const Vec3& n, const Simplex& simplex)
{
    constexpr int kMost = 16;
    constexpr double kRough = 1e-6;     // rad
    constexpr double kSettled = 1e-11;  // rad; the error of the depth is the square of that of the normal
    const double scale = A.extent() + B.extent(), slack = 8 * kEpsilon * scale;
    Simplex at = simplex;
    Vec3 moved_by;
    double last_turn = 0;
    // Far enough apart for accurate closest points, near enough to meet the same features.
    const double delta = 1e-3 * scale;
    const Support s = support_of(A, B, n);
    Overlap out{s.a, s.b, n, dot(n, s.w), true};
    for (int i = 0; i < kMost; ++i)
    {
        const Vec3 shift = (out.depth + delta) * out.normal;
        at = at.with_b_moved(shift - moved_by), moved_by = shift;
        // As long as the direction still turns, its closest points need not be exact.
        NearestPair apart;
        if (i > 0 && last_turn > kRough) apart = nearest_pair_near(A, moved(B, shift), at, out.a);
        if (!apart.apart) apart = nearest_pair(A, moved(B, shift), HUGE_VAL, at, i > 0 ? &out.a : nullptr);
        if (!apart.apart) break;
        if (i == 0) out.a = apart.a, out.b = apart.b - shift;  // a support point may be any corner of a face
        const double depth = depth_along(A, B, apart.normal);
        if (!(depth <= out.depth + slack)) break;
        const double turn = length(apart.normal - out.normal);
        out.normal = apart.normal, out.a = apart.a, out.b = apart.b - shift, out.depth = depth;
        // The first turn makes up for the guess. Of those that follow each is about the same fraction of the one before.
        const double left = i >= 2 && turn < last_turn ? turn * turn / (last_turn - turn) : turn;
        if (turn <= 8 * kEpsilon || left <= kSettled) break;
        last_turn = turn;
    }
    return out;
}

Overlap overlap_of(const Solid& A, const Solid& B, const Simplex& simplex)
{
    const bool curved = A.curved() || B.curved();
    Vec3 n = normalized(B.center() - A.center());
    if (length_squared(n) == 0) n = {0, 0, 1};
    Polytope polytope(A, B);
    const bool started = polytope.start(simplex);
    if (started) n = polytope.grow(curved ? 0.02 : 0);
    Overlap out = refine(A, B, n, simplex);
    out.converged = started && polytope.converged();
    return out;
}

}  // namespace plab::detection
