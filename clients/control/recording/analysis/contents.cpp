#include "control/recording/analysis/contents.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>

namespace plab::analysis
{
namespace
{

/// Steps and times of most types; collisions, events and hashes contain the step only.
template <class T>
RunPosition place_in(const T& sample)
{
    RunPosition out;
    if constexpr (requires { sample.run; }) out.run = sample.run;
    if constexpr (requires { sample.step; }) out.step = sample.step;
    if constexpr (requires { sample.time; }) out.time = sample.time;
    return out;
}

template <class T>
constexpr bool has_run = requires(const T& sample)
{
    sample.run;
};

/// "reset", "load scenes/a.xml": the operation that begins a run.
std::string cause_in(const plab_v2_Journal& journal)
{
    constexpr std::array<std::string_view, 4> begins{"reset", "load", "restore", "rewind"};
    for (std::uint32_t i = 0; i < journal.operations._length; ++i)
    {
        const plab_v2_Operation& o = journal.operations._buffer[i];
        if (std::find(begins.begin(), begins.end(), o.verb) == begins.end()) continue;
        const std::string_view what = *o.argument != 0 ? o.argument : o.target;
        return std::string(o.verb) + (what.empty() ? "" : " ") + std::string(what);
    }
    return {};
}

}  // namespace

std::optional<RunPosition> run_position_of(const Entry& entry)
{
    return std::visit(
        [](const auto& content) -> std::optional<RunPosition>
        {
            if constexpr (std::is_same_v<std::decay_t<decltype(content)>, std::monostate>)
                return {};
            else if constexpr (!has_run<std::decay_t<decltype(*content)>>)
                return {};
            else
                return place_in(*content);
        },
        entry.content);
}

Run& Runs::at(std::uint64_t number, std::uint64_t log_time)
{
    // A late message of the run before may follow the first of the next.
    const auto found = std::find_if(runs_.rbegin(), runs_.rend(), [&](const Run& run) { return run.number == number; });
    if (found != runs_.rend()) return *found;
    Run& run = runs_.emplace_back();
    run.number = number, run.begin = run.end = log_time;
    return run;
}

void Runs::note(const Entry& entry)
{
    const auto place = run_position_of(entry);
    if (!place) return;
    Run& run = at(place->run, entry.log_time);
    run.end = std::max(run.end, entry.log_time);
    if (const auto* journal = entry.as<plab_v2_Journal>(); journal != nullptr && run.cause.empty()) run.cause = cause_in(*journal);
    if (!place->step || !place->time) return;
    if (!run.has_steps) run.first_step = *place->step, run.first_time = *place->time;
    run.last_step = run.has_steps ? std::max(run.last_step, *place->step) : *place->step;
    run.last_time = run.has_steps ? std::max(run.last_time, *place->time) : *place->time;
    run.has_steps = true;
}

std::optional<std::size_t> Runs::index_of(std::uint64_t number) const
{
    for (std::size_t i = 0; i < runs_.size(); ++i)
        if (runs_[i].number == number) return i;
    return {};
}

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

namespace
{

Swap swap_of(const Change& change) { return {change.run, change.step, {}, change.log_time, change.component, change.from, change.to, ""}; }

bool is_same(const Change& change, const Swap& swap)
{
    return change.run == swap.run && change.component == swap.component && change.step == swap.step;
}

}  // namespace

void Swaps::note(const Entry& entry)
{
    const auto* journal = entry.as<plab_v2_Journal>();
    if (journal == nullptr) return;
    has_journal_ = true;
    for (std::uint32_t i = 0; i < journal->operations._length; ++i)
    {
        const plab_v2_Operation& o = journal->operations._buffer[i];
        if (std::string_view(o.verb) != "swap") continue;
        swaps_.push_back({journal->run, journal->step, journal->time, entry.log_time, o.target, "", o.argument, journal->origin});
    }
}

std::vector<Swap> Swaps::all(const Things& things) const
{
    std::vector<Swap> out = swaps_;
    for (Swap& swap : out)
        for (const Change& change : things.changes())
            if (is_same(change, swap)) swap.from = change.from;
    if (has_journal_) return out;
    for (const Change& change : things.changes()) out.push_back(swap_of(change));
    return out;
}

}  // namespace plab::analysis
