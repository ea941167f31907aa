// What a scene tells of its bodies and shapes.
#include <algorithm>
#include <iterator>
#include <utility>

#include "ode_scene.h"

namespace plab::detection
{

OdeScene::Participants OdeScene::participants() const
{
    Participants out;
    for (const Member& m : members_)
    {
        out.dynamic += m.membership.dynamic ? 1 : 0;
        if (m.first_shape != m.end_shape) ++(m.membership.between ? out.between : out.against);
    }
    return out;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> OdeScene::fresh_filled_hollows()
{
    std::vector<std::pair<std::uint32_t, std::uint32_t>> out, all;
    for (const Member& m : members_)
    {
        const auto fills = [&](const Part& p) { return colliders_[p.collider].fills_hollows(); };
        const auto end = parts_.begin() + m.end_part, at = std::find_if(parts_.begin() + m.first_part, end, fills);
        if (!m.membership.dynamic && at != end) all.push_back({m.body, shape_of_collider_[at->collider]});
    }
    std::sort(all.begin(), all.end());
    std::set_difference(all.begin(), all.end(), filled_hollows_.begin(), filled_hollows_.end(), std::back_inserter(out));
    filled_hollows_ = std::move(all);
    return out;
}

}  // namespace plab::detection
