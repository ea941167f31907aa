#include "ode_space.h"

#include <algorithm>
#include <cmath>

#include "tree_search.h"

namespace plab::detection
{
namespace
{
SpaceHandle make_space(std::string_view kind)
{
    if (kind == "sweep_and_prune") return SpaceHandle(dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ));
    return SpaceHandle(dSimpleSpaceCreate(nullptr));  // the quadtree replaces it once its bounds are known
}

/// In ODE, two geometries may collide if a category bit of one is among the collide bits of the other.
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
}  // namespace

OdeSpace::OdeSpace(std::string_view kind, std::size_t parts)
    : space_(make_space(kind)), geoms_(parts), boxes_(parts), quadtree_(kind == "quadtree")
{
    dSpaceSetCleanup(space_.get(), 0);
}

void OdeSpace::adopt(std::uint32_t part, dxGeom* geom, Membership membership)
{
    geoms_[part].reset(geom);
    dGeomSetData(geom, reinterpret_cast<void*>(static_cast<std::uintptr_t>(part)));
    set_groups(geom, membership);
}

void OdeSpace::add_box(std::uint32_t part, Membership membership) { adopt(part, dCreateBox(space_.get(), 1, 1, 1), membership); }

void OdeSpace::add_half_space(std::uint32_t part, Membership membership)
{
    adopt(part, dCreatePlane(space_.get(), 0, 0, 1, 0), membership);
}

void OdeSpace::set_box(std::uint32_t part, const Box& box)
{
    boxes_[part] = box;
    const Vec3 size = box.upper - box.lower, center = (box.upper + box.lower) * 0.5;
    dGeomBoxSetLengths(geoms_[part].get(), size.x, size.y, size.z);
    dGeomSetPosition(geoms_[part].get(), center.x, center.y, center.z);
}

void OdeSpace::set_half_space(std::uint32_t part, const Vec3& normal, double offset)
{
    dGeomPlaneSetParams(geoms_[part].get(), normal.x, normal.y, normal.z, offset);
}

/// A quadtree over the bounds of all parts, deep enough for a few parts per leaf. Parts that leave the bounds stay at its root
/// and are tested against everything: slower, but correct. It is therefore rebuilt only when the scene has outgrown it.
void OdeSpace::fit_tree()
{
    constexpr int kDeepest = 6;
    constexpr double kEndless = 1e30;  // m
    Box bounds{{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
    for (const Box& b : boxes_)
        if (b.lower.x <= b.upper.x && b.upper.x - b.lower.x < kEndless) bounds = joined(bounds, b);
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
    for (std::size_t leaves = 4; leaves < boxes_.size() && depth < kDeepest; leaves *= 4) ++depth;
    const dVector3 c{center.x, center.y, center.z}, h{half.x, half.y, half.z};
    for (const GeomHandle& g : geoms_)
        if (g) dSpaceRemove(space_.get(), g.get());
    space_.reset(dQuadTreeSpaceCreate(nullptr, c, h, depth));
    dSpaceSetCleanup(space_.get(), 0);
    for (const GeomHandle& g : geoms_)
        if (g) dSpaceAdd(space_.get(), g.get());
}

void OdeSpace::note(void* pairs, dxGeom* a, dxGeom* b)
{
    static_cast<std::vector<PartPair>*>(pairs)->push_back(std::minmax(part_of(a), part_of(b)));
}

void OdeSpace::find(std::vector<PartPair>& pairs, Workers* /*workers*/)
{
    if (quadtree_) fit_tree();
    pairs.clear();
    dSpaceCollide(space_.get(), &pairs, &note);
}

std::unique_ptr<PairSearch> make_pair_search(std::string_view kind, std::size_t parts)
{
    if (kind == "tree" || kind == "hash") return std::make_unique<TreeSearch>(parts);
    return std::make_unique<OdeSpace>(kind, parts);
}

}  // namespace plab::detection
