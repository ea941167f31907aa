#include "broad.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace plab::detection
{
namespace
{
/// Boxes are larger than shapes by this share of their size: no rounding may lose a pair that touches.
constexpr double kMargin = 1e-6;
/// What ODE holds is larger still, by this share, so that small motions need no search.
constexpr double kSlack = 0.1;
/// And by this share of the margin that is asked for.
constexpr double kSlackOfMargin = 2;
/// A box that came to be this many times as large as asked for is made anew.
constexpr double kMostSlack = 4;
/// m: nothing reaches further than this.
constexpr double kLargest = 1e30;
/// Up to here all pairs are tested whatever was asked for: quicker, and ODE's hash space allocates in each search.
constexpr std::size_t kFew = 32;

SpaceHandle make_space(const std::string& kind)
{
    if (kind == "simple") return SpaceHandle(dSimpleSpaceCreate(nullptr));
    if (kind == "sweep_and_prune") return SpaceHandle(dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ));
    return SpaceHandle(dHashSpaceCreate(nullptr));
}

/// ODE lets two geometries meet if the category bits of one are in the collide bits of the other.
void set_groups(dxGeom* geom, Membership m)
{
    enum : unsigned long
    {
        kMoved = 1,         // between, dynamic
        kHeld = 2,          // between, nothing moves it
        kAgainstMoved = 4,  // against only
        kAgainstHeld = 8,
    };
    if (m.between)
    {
        dGeomSetCategoryBits(geom, m.dynamic ? kMoved : kHeld);
        dGeomSetCollideBits(geom, m.dynamic ? kMoved | kHeld | kAgainstMoved | kAgainstHeld : kMoved | kAgainstMoved);
        return;
    }
    dGeomSetCategoryBits(geom, m.dynamic ? kAgainstMoved : kAgainstHeld);
    dGeomSetCollideBits(geom, m.dynamic ? kMoved | kHeld : kMoved);
}

std::uint32_t part_of(dxGeom* geom) { return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(dGeomGetData(geom))); }

/// Half extents along the axes of W of a box with half extents h, turned by q.
Vec3 turned_half(const Quat& q, const Vec3& h)
{
    const Mat3 R = rotation_matrix(q);
    Vec3 out;
    for (int i = 0; i < 3; ++i) out[i] = std::fabs(R(i, 0)) * h.x + std::fabs(R(i, 1)) * h.y + std::fabs(R(i, 2)) * h.z;
    return out;
}

double largest(const Vec3& v) { return std::max({v.x, v.y, v.z}); }
}  // namespace

void BroadPhase::reset(const std::string& kind, std::size_t parts)
{
    const std::string used = parts <= kFew ? "simple" : kind;
    parts_.clear();
    parts_.reserve(parts);
    // A quadtree needs to know its bounds; until somebody asks, any space holds the boxes.
    tree_ = used == "quadtree";
    space_ = make_space(tree_ ? "simple" : used);
    dSpaceSetCleanup(space_.get(), 0);
    hashed_ = used == "hash";
    tree_bounds_ = {{1, 1, 1}, {-1, -1, -1}};
    stale_ = true;
}

void BroadPhase::add(const Collider& collider, std::uint32_t member, Membership membership)
{
    const std::size_t index = parts_.size();
    Part& part = parts_.emplace_back();
    part.member = member;
    part.unbounded = collider.kind() == ColliderKind::Plane;
    part.wide = {{1, 1, 1}, {-1, -1, -1}};  // contains nothing yet
    if (collider.kind() == ColliderKind::None) return;
    part.geom.reset(part.unbounded ? dCreatePlane(space_.get(), 0, 0, 1, 0) : dCreateBox(space_.get(), 1, 1, 1));
    dGeomSetData(part.geom.get(), reinterpret_cast<void*>(static_cast<std::uintptr_t>(index)));
    set_groups(part.geom.get(), membership);
}

/// Whether what ODE holds covers the box with its margin, and is not many times too large for it.
bool BroadPhase::fits(const Part& part) const
{
    const double most = 2 * kMostSlack * (largest(part.tight.upper - part.tight.lower) + 2 * growth_);
    for (int k = 0; k < 3; ++k)
    {
        if (!(part.wide.lower[k] <= part.tight.lower[k] - growth_ && part.tight.upper[k] + growth_ <= part.wide.upper[k])) return false;
        if (part.wide.upper[k] - part.wide.lower[k] > most) return false;
    }
    return true;
}

void BroadPhase::widen(Part& part)
{
    const Vec3 half = (part.tight.upper - part.tight.lower) * 0.5, center = (part.tight.upper + part.tight.lower) * 0.5;
    const double slack = kSlack * largest(half) + (1 + kSlackOfMargin) * growth_;
    const Vec3 wide = half + Vec3{slack, slack, slack};
    part.wide = {center - wide, center + wide};
    dGeomBoxSetLengths(part.geom.get(), 2 * wide.x, 2 * wide.y, 2 * wide.z);
    dGeomSetPosition(part.geom.get(), center.x, center.y, center.z);
    stale_ = true;
}

void BroadPhase::move(std::uint32_t index, const Collider& collider, const Pose& X_WS)
{
    Part& part = parts_[index];
    if (!part.geom) return;
    if (part.unbounded)
    {
        const Vec3 n = part.normal = rotate(X_WS.q, {0, 0, 1});
        part.offset = dot(n, X_WS.p);
        dGeomPlaneSetParams(part.geom.get(), n.x, n.y, n.z, part.offset);
        stale_ = true;
        return;
    }
    const bool round = collider.kind() == ColliderKind::Sphere;
    const Vec3 half = (round ? collider.bound_half() : turned_half(X_WS.q, collider.bound_half())) * (1 + kMargin);
    const Vec3 center = X_WS * collider.bound_center();
    part.tight = {center - half, center + half};
}

void BroadPhase::note(void* self, dxGeom* a, dxGeom* b)
{
    const std::uint32_t i = part_of(a), j = part_of(b);
    static_cast<BroadPhase*>(self)->near_.push_back(std::minmax(i, j));
}

bool BroadPhase::reaches(const Part& half_space, const Part& part) const
{
    double lowest = 0, size = std::fabs(half_space.offset);
    for (int k = 0; k < 3; ++k)
    {
        const double near = (half_space.normal[k] > 0 ? part.tight.lower : part.tight.upper)[k];
        lowest += half_space.normal[k] * near, size += std::fabs(near);
    }
    return lowest <= half_space.offset + 2 * growth_ + 1e-14 * size;
}

bool BroadPhase::overlap(const Part& a, const Part& b) const
{
    if (a.unbounded || b.unbounded) return a.unbounded ? b.unbounded || reaches(a, b) : reaches(b, a);
    const double growth = 2 * growth_;
    for (int k = 0; k < 3; ++k)
        if (a.tight.lower[k] > b.tight.upper[k] + growth || b.tight.lower[k] > a.tight.upper[k] + growth) return false;
    return true;
}

/// Cells from the size of the smallest part to that of the largest.
void BroadPhase::fit_cells()
{
    double small = HUGE_VAL, large = 0;
    for (const Part& p : parts_)
    {
        if (!p.geom || p.unbounded) continue;
        const double extent = largest(p.wide.upper - p.wide.lower);
        small = std::min(small, extent), large = std::max(large, extent);
    }
    if (!(large > 0)) return;
    const auto level = [](double extent) { return std::clamp(std::ilogb(extent) + 1, -30, 30); };
    dHashSpaceSetLevels(space_.get(), level(small), level(large));
}

/// A quadtree over the bounds of what there is, deep enough for a few parts in a leaf. Parts that leave the bounds stay
/// at its root, where everything meets them: slower, not wrong. So it is made anew only when the scene has outgrown it.
void BroadPhase::fit_tree()
{
    constexpr int kDeepest = 6;
    Box bounds{{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
    for (const Part& p : parts_)
    {
        if (!p.geom || p.unbounded || !(p.wide.upper.x - p.wide.lower.x < kLargest)) continue;
        for (int k = 0; k < 3; ++k)
            bounds.lower[k] = std::min(bounds.lower[k], p.wide.lower[k]), bounds.upper[k] = std::max(bounds.upper[k], p.wide.upper[k]);
    }
    if (!(bounds.lower.x <= bounds.upper.x)) return;
    bool fits = true;
    for (int k = 0; k < 3; ++k)
    {
        const double size = bounds.upper[k] - bounds.lower[k];
        fits = fits && tree_bounds_.lower[k] <= bounds.lower[k] && bounds.upper[k] <= tree_bounds_.upper[k] &&
               tree_bounds_.upper[k] - tree_bounds_.lower[k] <= 4 * size;
    }
    if (fits) return;
    const Vec3 center = (bounds.lower + bounds.upper) * 0.5, half = (bounds.upper - bounds.lower) * 0.75;
    tree_bounds_ = {center - half, center + half};
    int depth = 1;
    for (std::size_t leaves = 4; leaves < parts_.size() && depth < kDeepest; leaves *= 4) ++depth;
    const dVector3 c{center.x, center.y, center.z}, h{half.x, half.y, half.z};
    for (const Part& p : parts_)
        if (p.geom) dSpaceRemove(space_.get(), p.geom.get());
    space_.reset(dQuadTreeSpaceCreate(nullptr, c, h, depth));
    dSpaceSetCleanup(space_.get(), 0);
    for (const Part& p : parts_)
        if (p.geom) dSpaceAdd(space_.get(), p.geom.get());
}

void BroadPhase::search()
{
    if (hashed_) fit_cells();
    if (tree_) fit_tree();
    near_.clear();
    dSpaceCollide(space_.get(), this, &note);
    // The order in which ODE finds pairs depends on who moved last; it ends here.
    const auto key = [&](const Pair& p) { return std::tuple(parts_[p.first].member, parts_[p.second].member, p.first, p.second); };
    std::sort(near_.begin(), near_.end(), [&](const Pair& x, const Pair& y) { return key(x) < key(y); });
    near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
    stale_ = false;
}

const std::vector<BroadPhase::Pair>& BroadPhase::find_pairs(double margin)
{
    growth_ = std::min(0.5 * margin, kLargest);
    for (Part& p : parts_)
        if (p.geom && !p.unbounded && !fits(p)) widen(p);
    if (stale_) search();
    pairs_.clear();
    for (const Pair& p : near_)
        if (overlap(parts_[p.first], parts_[p.second])) pairs_.push_back(p);
    return pairs_;
}

void BroadPhase::offer(std::uint32_t part, double growth, NearSweep& sweep) const
{
    const Part& p = parts_[part];
    if (!p.geom) return;
    if (p.unbounded) return sweep.set_half_space(part, p.normal, p.offset, growth);
    const double grown = std::min(growth, kLargest);
    const Vec3 by{grown, grown, grown};
    sweep.set_box(part, p.tight.lower - by, p.tight.upper + by);
}

}  // namespace plab::detection
