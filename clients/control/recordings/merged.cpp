#include "control/recordings/merged.h"

#include <algorithm>

namespace plab::recordings
{
namespace
{

using Places = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

template <class State>
Places places_of(std::span<const State> states)
{
    Places out;
    out.reserve(states.size());
    for (std::uint32_t i = 0; i < states.size(); ++i) out.emplace_back(states[i].handle, i);
    std::sort(out.begin(), out.end());
    return out;
}

template <class State>
const State* find(const Places& places, std::span<const State> states, std::uint32_t handle)
{
    const auto at = std::lower_bound(places.begin(), places.end(), std::pair(handle, std::uint32_t{0}));
    return at != places.end() && at->first == handle ? &states[at->second] : nullptr;
}

}  // namespace

void Merged::note(const plab_v2_Frame& frame)
{
    now_ = &whole_.with(frame);
    // Within a revision rows keep their places; new ones are appended.
    const bool same =
        frame.run == run_ && frame.revision == revision_ && bodies_.size() == bodies().size() && shafts_.size() == shafts().size();
    if (same) return;
    run_ = frame.run, revision_ = frame.revision;
    bodies_ = places_of(bodies()), shafts_ = places_of(shafts());
}

const plab_v2_BodyState* Merged::find_body(std::uint32_t handle) const { return find(bodies_, bodies(), handle); }
const plab_v2_ShaftState* Merged::find_shaft(std::uint32_t handle) const { return find(shafts_, shafts(), handle); }

}  // namespace plab::recordings
