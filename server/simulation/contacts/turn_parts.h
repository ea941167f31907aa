/// Into how many parts the step of an island is divided because its bodies turn too far on what they touch.
///
/// Managers put contact points in the middle of the step (plab/pivot.h), which makes what rolls and spins on a corner, an end or a rim of
/// order 2. Of what turns by more than kFarthestTurn until then, the middle says little: with the point of the start such a body gains
/// energy from nothing, 0.16 of it in 1.5 s for a club that spins on its round end at 20 rad/s with steps of 1/60 s. So small islands
/// advance in parts in which nothing that touches turns further, kinematic bodies among them. Balls about their centres turn as far as they
/// like.
///
/// Limits: not where joints hold a body, nor for managers that put no points midway (TypeInfo::pivots_up_to). At most kMost parts.
#pragma once

#include <span>
#include <vector>

#include "simulation/contacts/contact_book.h"

namespace plab::simulation
{

class TurnParts
{
public:
    TurnParts(const StepState& step, const ContactBook& contacts) : step_(step), contacts_(contacts) {}

    static constexpr std::uint32_t kMost = 8;
    /// Bodies of an island: in larger ones each part costs too much.
    static constexpr std::uint32_t kMostBodies = 8;

    /// For an advance of `groups` by h (s) from their present state. `places`: in ContactCache::pairs, of the persistent pairs that reach
    /// them; `islands`: which groups these join. Returns whether some of them may have to be divided.
    bool measure(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> places, DisjointSets& islands, double h);
    /// Of a group that was measured last: 1 to kMost.
    std::uint32_t of(std::uint32_t group) const { return parts_[group]; }

private:
    std::uint32_t parts_for(const PairState& pair, double h) const;
    bool puts_midway(const PairState& pair) const;

    const StepState& step_;
    const ContactBook& contacts_;
    std::vector<std::uint32_t> parts_, members_;  ///< by group; members_: of its island, by representative
};

}  // namespace plab::simulation
