/// The broad phase: which pairs of shapes are near one another, by bounding boxes in pLab's own tree or in one of ODE's
/// collision spaces.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "collider.h"
#include "geometry/box.h"
#include "pair_search.h"
#include "tree_search.h"

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
    /// Several threads may move different parts at a time.
    void move(std::uint32_t part, const Collider& collider, const Pose& X_WS);
    /// Pairs (i, j), i < j, ordered by members, then parts. Those among them whose tight boxes are at most `margin` (m) apart, as
    /// is_near() tells, are all pairs of which that is true. `workers`: threads that may share the search; null: none.
    const std::vector<Pair>& find_candidates(double margin, Workers* workers);
    /// The same for pairs with at least one part in `parts` (ascending), at a cost that depends on their number. Null if the search cannot
    /// do that. All other parts must be where they were at the last find_candidates().
    const std::vector<Pair>* find_candidates_of(std::span<const std::uint32_t> parts, double margin);
    /// Those near pairs, in that order.
    const std::vector<Pair>& find_pairs(double margin = 0);
    /// For a pair of the last find_candidates().
    bool is_near(const Pair& pair) const { return near(parts_[pair.first], parts_[pair.second]); }
    /// Pairs (i, j), i < j, of which at least one part is in `parts`, whose tight boxes overlap when each is grown by the margin
    /// (m, may be infinite) that it was last given by grow(); each at least once, in any order. No result of find_candidates() depends
    /// on these two.
    void grow(std::uint32_t part, double margin);
    void find_grown(std::span<const std::uint32_t> parts, std::vector<Pair>& pairs) { grown_search_->find_of(parts, pairs); }

private:
    struct Part
    {
        bool collides = false;
        bool unbounded = false;
        bool tilted = false;  // unbounded and moved since the search structure was told
        Vec3 normal;          // for unbounded parts: the half-space normal . p <= offset
        double offset = 0;    // m
        Box tight, wide;
    };
    bool near(const Part& a, const Part& b) const;
    bool fits(const Part& part) const;
    void widen(std::uint32_t part);
    void widen_if_needed(std::uint32_t part);
    void raise_half_spaces();
    void search(Workers* workers);
    void sort_pairs(Workers* workers);

    std::unique_ptr<PairSearch> search_;
    std::unique_ptr<TreeSearch> grown_search_;  // not one of ODE's spaces: these boxes differ in every step
    std::vector<Part> parts_;
    std::vector<std::uint32_t> member_of_;    // by part
    bool single_ = true;                      // each part is that of the member of the same number
    std::vector<std::uint32_t> half_spaces_;  // parts
    double raised_ = 0;                       // m, by which half-spaces are enlarged in the search structure
    double covered_ = 0;                      // m, the growth that all boxes in the search structure allow for
    std::vector<Pair> near_, pairs_, near_few_;
    std::vector<Pair> sorted_;             // scratch
    std::vector<std::uint32_t> run_ends_;  // by member, scratch
    bool stale_ = true;
    double growth_ = 0;  // m, by which the tight boxes are grown in the present query
};

}  // namespace plab::detection
