/// Which pairs of shapes are near one another: ODE's collision spaces over bounding boxes.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "collider.h"

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

    /// `kind`: "simple", "hash" or "sweep_and_prune". `parts`: how many will be added.
    void reset(const std::string& kind, std::size_t parts);
    /// Parts are numbered in the order of this call; `member` (the body) must not decrease.
    void add(const Collider& collider, std::uint32_t member, Membership membership);
    void move(std::uint32_t part, const Collider& collider, const Pose& X_WS);
    /// Pairs (i, j), i < j, whose tight boxes overlap; by members, then parts.
    const std::vector<Pair>& find_pairs();

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
    static bool overlap(const Part& a, const Part& b);
    static bool reaches(const Part& half_space, const Box& box);
    void widen(Part& part);
    void search();
    void fit_cells();

    SpaceHandle space_;  // before the parts: their geometries leave it as they go
    std::vector<Part> parts_;
    std::vector<Pair> near_, pairs_;
    bool hashed_ = false, stale_ = true;
};

}  // namespace plab::detection
