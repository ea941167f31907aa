#include "surface_contacts.h"

#include <algorithm>
#include <cmath>

#include "spread.h"

namespace plab::detection
{
namespace
{

/// Cosine between normals that count as one side of a contact.
constexpr double kOneSide = 0.995;
/// Fraction of the solid's size within which two places count as the same.
constexpr double kSamePlace = 1e-6;
/// Of the feature of a corner on a face: the number of the corner (the rest is that of the face's patch).
constexpr std::uint32_t kCornerOnFace = 0x3ff;

/// Whether these are features of two corners of the solid: the moving point of a rim passes the fixed ones.
bool are_two_corners(std::uint32_t f, std::uint32_t g)
{
    return f >> 18 == 0 && g >> 18 == 0 && (f & kCornerOnFace) != (g & kCornerOnFace);
}

/// Collects contact points, each place and each feature once; if there are many on one side, the deepest and the outermost.
class Gathering final : public MeetingSink
{
public:
    Gathering(double margin, double size) : margin_(margin), near_(kSamePlace * size) {}
    double limit() const override { return margin_; }
    void offer(const Meeting& m) override
    {
        if (!(m.gap < margin_ || m.gap < 0)) return;
        const ContactPoint contact_point{m.on_surface - m.normal * (0.5 * m.gap), m.normal, -m.gap, m.feature, m.pivot};
        for (std::size_t i = 0; i < count_; ++i)
        {
            ContactPoint& known = contact_points_[i];
            const bool same_place = !are_two_corners(known.feature, contact_point.feature) &&
                                    length_squared(known.point - contact_point.point) < near_ * near_ &&
                                    dot(known.normal, contact_point.normal) > kOneSide;
            if (!same_place && known.feature != contact_point.feature) continue;
            const std::uint32_t first = known.feature;
            if (contact_point.depth > known.depth) known = contact_point, known.feature = first;
            return;
        }
        if (count_ == contact_points_.size()) thin_out();
        if (count_ < contact_points_.size()) contact_points_[count_++] = contact_point;
    }
    std::span<ContactPoint> take()
    {
        if (count_ > kMany) thin_out();
        std::sort(contact_points_.begin(), contact_points_.begin() + static_cast<std::ptrdiff_t>(count_),
                  [](const ContactPoint& a, const ContactPoint& b) { return a.feature < b.feature; });
        return {contact_points_.data(), count_};
    }

private:
    static constexpr std::size_t kMany = 9;

    /// Sides are processed in the order in which they were found; if space runs out, the last ones lose points.
    void thin_out()
    {
        std::array<ContactPoint, 64> all = contact_points_;
        std::array<std::uint8_t, 64> taken{};
        const std::size_t total = count_;
        count_ = 0;
        for (std::size_t i = 0; i < total; ++i)
        {
            if (taken[i]) continue;
            Spread spread(all[i].normal, margin_);
            for (std::size_t k = i; k < total; ++k)
                if (!taken[k] && dot(all[i].normal, all[k].normal) > kOneSide) taken[k] = 1, spread.offer(all[k]);
            ContactPoints kept(margin_);
            spread.take(kept);
            for (const ContactPoint& t : kept.all()) contact_points_[count_++] = t;
        }
    }

    std::array<ContactPoint, 64> contact_points_{};
    std::size_t count_ = 0;
    double margin_, near_;
};

/// Keeps the nearest candidate.
class Nearest final : public MeetingSink
{
public:
    double limit() const override { return best.gap; }
    void offer(const Meeting& m) override
    {
        if (m.gap < best.gap) best = m;
    }
    Meeting best{HUGE_VAL, {}, {}, {0, 0, 1}, 0};
};

void meet(const Solid& K, const Collider& surface, MeetingSink& out)
{
    surface.kind() == ColliderKind::Triangles ? meet_triangles(K, surface, out) : meet_round_wall(K, surface, out);
}

/// A sliding ball moves from triangle to triangle. Its contacts are numbered by patches of smoothly connected triangles, so that
/// the number stays the same while it slides.
void number_by_patch(std::span<ContactPoint> contact_points, const TriangleSurface& surface)
{
    std::array<std::uint32_t, 64> patch{};
    for (std::size_t i = 0; i < contact_points.size(); ++i)
    {
        patch[i] = surface.triangles()[contact_points[i].feature].patch;
        const auto before = static_cast<std::uint32_t>(std::count(patch.begin(), patch.begin() + static_cast<std::ptrdiff_t>(i), patch[i]));
        contact_points[i].feature = (patch[i] & 0xfffu) << 6 | before;
    }
}

Pose seen_from(const Pose& X_surface, const Pose& X) { return {rotate_back(X_surface.q, X.p - X_surface.p), conjugate(X_surface.q) * X.q}; }
}  // namespace

void collide_with_surface(const Collider& a, const Pose& X_a, const Collider& surface, const Pose& X_surface, ContactPoints& out)
{
    const Solid K(a, seen_from(X_surface, X_a));
    Gathering found(out.margin(), K.extent() + K.radius());
    meet(K, surface, found);
    const std::span<ContactPoint> contact_points = found.take();
    out.note_triangles(found.triangles());
    if (K.core() == Core::Point && surface.kind() == ColliderKind::Triangles) number_by_patch(contact_points, surface.triangles());
    for (ContactPoint t : contact_points)
    {
        t.point = X_surface * t.point, t.normal = rotate(X_surface.q, t.normal), t.pivot.arm = rotate(X_surface.q, t.pivot.arm);
        t.pivot.hollow = Hollow::of(rotate(X_surface.q, t.pivot.hollow.vector()));
        out.add(t);
    }
}

Separation separation_from_surface(const Collider& a, const Pose& X_a, const Collider& surface, const Pose& X_surface)
{
    const Solid K(a, seen_from(X_surface, X_a));
    Nearest nearest;
    meet(K, surface, nearest);
    const Meeting& m = nearest.best;
    return {m.gap, X_surface * m.on_solid, X_surface * m.on_surface, rotate(X_surface.q, m.normal), nearest.triangles()};
}

}  // namespace plab::detection
