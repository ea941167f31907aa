/// Which of many boxes overlap: a tree of our own, or one of ODE's collision spaces.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "bounds.h"

namespace plab::detection
{

using PartPair = std::pair<std::uint32_t, std::uint32_t>;

/// Groups that may meet. `between` meets everything else; `against` alone meets only `between`. Two bodies that nothing
/// moves do not meet.
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

    /// A part with a box, or a half-space; the next index is 0, 1, 2 ... unless parts are left out.
    virtual void add_box(std::uint32_t part, Membership membership) = 0;
    virtual void add_half_space(std::uint32_t part, Membership membership) = 0;
    /// Before the first find() of a part, and whenever it moves.
    virtual void set_box(std::uint32_t part, const Box& box) = 0;
    /// Half-space normal . p <= offset (m), in W.
    virtual void set_half_space(std::uint32_t part, const Vec3& normal, double offset) = 0;
    /// Brings `pairs`, the answer of the last call or empty, up to date: all (i, j), i < j, whose boxes overlap and that may meet, each at
    /// least once, in any order. A box and a half-space count as a pair if the box reaches it.
    virtual void find(std::vector<PartPair>& pairs) = 0;
};

/// `kind`: "tree" (of older files: "hash"), or an ODE space: "simple", "sweep_and_prune" or "quadtree". `parts`: one more than the largest
/// index.
std::unique_ptr<PairSearch> make_pair_search(std::string_view kind, std::size_t parts);

}  // namespace plab::detection
