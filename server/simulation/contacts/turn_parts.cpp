#include "simulation/contacts/turn_parts.h"

#include <algorithm>
#include <cmath>

#include "plab/pivot.h"

namespace plab::simulation
{

bool TurnParts::puts_midway(const PairState& pair) const
{
    const auto& detectors = contacts_.detectors();
    const auto at = std::find_if(detectors.begin(), detectors.end(), [&](const Detector& d) { return d.component == pair.detector; });
    return at != detectors.end() && at->manager != kNoIndex && step_.world.type_of(at->manager)->info.pivots_up_to > 0;
}

/// Of the step in which two bodies that touch turn on each other.
std::uint32_t TurnParts::parts_for(const PairState& pair, double h) const
{
    const Bodies& bodies = step_.world.host().bodies;
    double turn = 0;
    for (const Ref r : {pair.a, pair.b})
    {
        if (bodies.dynamic(r.index) && !step_.groups.all[step_.groups.of(r)].rows.empty()) return 1;
        if (bodies.motion[r.index] != Motion::Static && !contacts_.is_ball(r.index))
            turn = std::max(turn, 0.5 * h * length(bodies.angular_velocity[r.index]));
    }
    return turn < kFarthestTurn ? 1 : static_cast<std::uint32_t>(std::min<double>(std::floor(turn / kFarthestTurn) + 1, kMost));
}

bool TurnParts::measure(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> places, DisjointSets& islands, double h)
{
    parts_.resize(step_.groups.all.size(), 1), members_.resize(step_.groups.all.size());
    for (const std::uint32_t g : groups) parts_[g] = 1, members_[islands.find(g)] = 0;
    for (const std::uint32_t g : groups) ++members_[islands.find(g)];
    const Bodies& bodies = step_.world.host().bodies;
    bool any = false;
    for (const std::uint32_t place : places)
    {
        const PairState& pair = contacts_.cache().pairs()[place];
        if (!pair.resting || pair.ahead) continue;
        const std::uint32_t parts = parts_for(pair, h), g = step_.groups.of(bodies.dynamic(pair.a.index) ? pair.a : pair.b);
        if (parts == 1 || members_[islands.find(g)] > kMostBodies || !puts_midway(pair)) continue;
        parts_[g] = std::max(parts_[g], parts);
        any = true;
    }
    return any;
}

}  // namespace plab::simulation
