#include "control/recordings/things.h"

#include <charconv>
#include <set>

namespace plab::recordings
{

void Things::note(const Entry& entry)
{
    if (const auto* o = entry.as<plab_v2_SceneObject>())
        objects_[{o->run, o->handle}] = {o->component_id, std::string_view(o->shape_of) == "shaft", o->motion};
    else if (const auto* i = entry.as<plab_v2_Interaction>())
        note(*i, entry.log_time);
}

void Things::note(const plab_v2_Interaction& interaction, std::uint64_t log_time)
{
    Algorithm& now = algorithms_[interaction.component_id];
    // A new run has the algorithms that its scene names: that is not a swap.
    if (now.run == interaction.run && !now.type.empty() && now.type != interaction.type_name)
        changes_.push_back({interaction.run, interaction.since, log_time, interaction.component_id, now.type, interaction.type_name});
    now = {interaction.run, interaction.type_name};
}

const Thing* Things::find(std::uint64_t run, std::uint32_t handle) const
{
    const auto found = objects_.find({run, handle});
    return found == objects_.end() ? nullptr : &found->second;
}

std::string Things::name_of(std::uint64_t run, std::uint32_t handle) const
{
    const Thing* const thing = find(run, handle);
    return thing == nullptr ? "#" + std::to_string(handle) : thing->id;
}

std::optional<std::uint32_t> Things::handle_of(std::uint64_t run, const std::string& id) const
{
    for (auto at = objects_.lower_bound({run, 0}); at != objects_.end() && at->first.first == run; ++at)
        if (at->second.id == id) return at->first.second;
    std::uint32_t handle = 0;
    const char* const last = id.data() + id.size();
    if (!id.starts_with('#') || std::from_chars(id.data() + 1, last, handle).ptr != last) return {};
    return handle;
}

bool Things::is_shaft(const std::string& id) const
{
    for (const auto& [key, thing] : objects_)
        if (thing.id == id) return thing.is_shaft;
    return false;
}

std::vector<std::string> Things::objects() const
{
    std::set<std::string> ids;
    for (const auto& [key, thing] : objects_) ids.insert(thing.id);
    return {ids.begin(), ids.end()};
}

std::vector<std::string> Things::interactions() const
{
    std::vector<std::string> ids;
    for (const auto& [id, algorithm] : algorithms_) ids.push_back(id);
    return ids;
}

}  // namespace plab::recordings
