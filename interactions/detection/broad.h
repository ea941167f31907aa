/// The broad phase: which pairs of shapes are near one another, by bounding boxes in pLab's own tree or in one of ODE's
/// collision spaces.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bounds.h"
#include "collider.h"
#include "near_sweep.h"
#include "pair_search.h"

namespace plab::detection
{

/// Keeps one axis-aligned box in W per part (a shape on a body). The search structure holds a box enlarged by a tenth and is
/// queried again only when a part has left its enlarged box, so the trials that locate an impact cost no search. The result is
/// then filtered with the tight boxes. It is therefore a function of the present poses alone, independent of when the structure
/// was queried, and the same for every kind of search.
class BroadPhase
{
public:
    using Pair = PartPair;

    /// `kind`: "tree", or an ODE space: "simple", "sweep_and_prune", "quadtree". `parts`: the number of parts that will be
    /// added.
    void reset(const std::string& kind, std::size_t parts);
    /// Parts are numbered in the order of these calls; `member` (the body) must not decrease.
    void add(const Collider& collider, std::uint32_t member, Membership membership);
    void move(std::uint32_t part, const Collider& collider, const Pose& X_WS);
    /// Pairs (i, j), i < j, whose tight boxes are at most `margin` (m) apart; ordered by members, then parts.
    const std::vector<Pair>& find_pairs(double margin = 0);
    /// Passes the tight box of a part, grown by `growth` (m), to a sweep.
    void offer(std::uint32_t part, double growth, NearSweep& sweep) const;

private:
    struct Part
    {
        std::uint32_t member = 0;
        bool collides = false;
        bool unbounded = false;
        Vec3 normal;        // for unbounded parts: the half-space normal . p <= offset
        double offset = 0;  // m
        Box tight, wide;
    };
    bool near(const Part& a, const Part& b) const;
    bool fits(const Part& part) const;
    void widen(std::uint32_t part);
    void raise_half_spaces();
    void search();

    std::unique_ptr<PairSearch> search_;
    std::vector<Part> parts_;
    std::vector<std::uint32_t> half_spaces_;  // parts
    double raised_ = 0;                       // m, by which half-spaces are enlarged in the search structure
    std::vector<Pair> near_, pairs_;
    bool stale_ = true;
    double growth_ = 0;  // m, by which the tight boxes are grown in the present query
};

}  // namespace plab::detection
