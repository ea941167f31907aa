#include "control/recordings/runs.h"

#include <algorithm>
#include <array>

namespace plab::recordings
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

}  // namespace plab::recordings
