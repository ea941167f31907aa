/// Which pairs of shapes are near one another: ODE's collision spaces over bounding boxes.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "collider.h"
#include "near_sweep.h"

namespace plab::detection
{

/// Groups that may meet. `between` meets everything else; `against` alone meets only `between`. Two bodies that nothing
/// moves do not meet.
struct Membership
{
    bool between = false;
    bool dynamic = false;
};

/// One box per part (a shape on a body), along the axes of W. ODE holds a box that is a tenth larger and is asked again
/// only when a part has left it: trial after trial of one impact costs no search. The answer is filtered with the tight
/// boxes, so it is a function of the present poses, whatever ODE was asked when.
class BroadPhase
{
public:
    using Pair = std::pair<std::uint32_t, std::uint32_t>;

    /// `kind`: "simple", "hash", "sweep_and_prune" or "quadtree". `parts`: how many will be added.
    void reset(const std::string& kind, std::size_t parts);
    /// Parts are numbered in the order of this call; `member` (the body) must not decrease.
    void add(const Collider& collider, std::uint32_t member, Membership membership);
    void move(std::uint32_t part, const Collider& collider, const Pose& X_WS);
    /// Pairs (i, j), i < j, whose tight boxes are no further apart than `margin` (m); by members, then parts.
    const std::vector<Pair>& find_pairs(double margin = 0);
    /// Gives the tight box of a part, grown by `growth` (m), to a sweep.
    void offer(std::uint32_t part, double growth, NearSweep& sweep) const;

private:
    struct Box
    {
        Vec3 lower, upper;  // m, W
    };
    struct Part
    {
        GeomHandle geom;  // null for what never touches
        std::uint32_t member = 0;
        bool unbounded = false;
        Vec3 normal;        // of an unbounded one: the half-space normal . p <= offset
        double offset = 0;  // m
        Box tight, wide;
    };
    static void note(void* self, dxGeom* a, dxGeom* b);
    bool overlap(const Part& a, const Part& b) const;
    bool reaches(const Part& half_space, const Part& part) const;
    bool fits(const Part& part) const;
    void widen(Part& part);
    void search();
    void fit_cells();
    void fit_tree();

    SpaceHandle space_;  // before the parts: their geometries leave it as they go
    std::vector<Part> parts_;
    std::vector<Pair> near_, pairs_;
    bool hashed_ = false, tree_ = false, stale_ = true;
    Box tree_bounds_;    // of ODE's quadtree
    double growth_ = 0;  // m, by which the tight boxes are grown in the present question
};

}  // namespace plab::detection
