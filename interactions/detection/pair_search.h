/// Interface of the searches for overlapping boxes: pLab's own tree, or one of ODE's collision spaces.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "geometry/box.h"
#include "plab/parts.h"

namespace plab::detection
{

using geometry::Box;

using PartPair = std::pair<std::uint32_t, std::uint32_t>;

/// Groups that may collide: a part of `between` with every other part, a part of `against` only with those of `between`. Two
/// bodies that nothing moves do not collide.
struct Membership
{
    bool between = false;
    bool dynamic = false;
};

inline bool may_meet(Membership a, Membership b) { return (a.between || b.between) && (a.dynamic || b.dynamic); }

class PairSearch
{
public:
    virtual ~PairSearch() = default;

    /// Adds a part with a box, or a half-space. Indices ascend from 0; some may be left out.
    virtual void add_box(std::uint32_t part, Membership membership) = 0;
    virtual void add_half_space(std::uint32_t part, Membership membership) = 0;
    /// Must be called before the first find(), and whenever the part moves.
    virtual void set_box(std::uint32_t part, const Box& box) = 0;
    /// Half-space normal . p <= offset (m), in W.
    virtual void set_half_space(std::uint32_t part, const Vec3& normal, double offset) = 0;
    /// Updates `pairs`, which must hold the result of the last call or be empty, to all (i, j), i < j, whose boxes overlap and
    /// that may collide; each at least once, in any order. A box and a half-space form a pair if the box reaches into it.
    /// `workers`: threads that may share the search; null: none.
    virtual void find(std::vector<PartPair>& pairs, Workers* workers) = 0;
    /// Sets `pairs` to those with at least one part in `parts`; each at least once, in any order. What find() returns next does not depend
    /// on these calls. False if this search finds only all pairs.
    virtual bool find_of(std::span<const std::uint32_t> parts, std::vector<PartPair>& pairs)
    {
        (void)parts, (void)pairs;
        return false;
    }
};

/// `kind`: "tree" ("hash" in older files), or an ODE space: "simple", "sweep_and_prune" or "quadtree". `parts`: one more than
/// the largest index.
std::unique_ptr<PairSearch> make_pair_search(std::string_view kind, std::size_t parts);

}  // namespace plab::detection
