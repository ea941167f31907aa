#include "study/swaps.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "model/names.h"
#include "model/numbers.h"
#include "model/text.h"
#include "model/units.h"
#include "model/values.h"
#include "study/settings.h"

namespace plab::study
{
namespace
{

/// A time is on a step boundary to within this part of a step.
constexpr double kOnBoundary = 1e-6;

Error wrong(const PlannedSwap& swap, const std::string& why) { return reason("--swap '" + swap.text + "': " + why); }

/// "0.5s", "500 ms", "1/2 s".
Result<double> parse_time(std::string_view text)
{
    const std::size_t unit = std::min(text.find_last_of("0123456789.") + 1, text.size());
    Field seconds;
    seconds.name = "time", seconds.type = FieldType::Real, seconds.unit = unit::second;
    const auto value =
        model::parse_value(std::string(text.substr(0, unit)) + " " + std::string(model::trimmed(text.substr(unit))), seconds);
    if (!value) return value.errors();
    return std::get<double>(*value);
}

/// "120" or "0.5s" into the swap; false if it is neither.
bool read_when(std::string_view text, PlannedSwap& out)
{
    Tick step = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), step);
    if (error == std::errc() && end == text.data() + text.size() && step >= 0) return out.step = step, true;
    if (text.empty() || !model::is_letter(text.back())) return false;
    const auto time = parse_time(text);
    if (!time || !(*time >= 0)) return false;
    out.time = *time;
    return true;
}

std::string seconds(double t) { return model::format_real(t) + " s"; }

/// The step of length dt that begins at t, if one does.
std::optional<Tick> step_at(double t, const model::StepLength& dt)
{
    const double n = std::round(t / dt.seconds);
    if (!(n < 9e15)) return {};
    const Tick step = static_cast<Tick>(n);
    return std::fabs(dt.at(step) - t) <= kOnBoundary * dt.seconds ? std::optional(step) : std::nullopt;
}

Error no_step_at(const PlannedSwap& swap, const model::StepLength& dt, const std::vector<model::StepLength>& all)
{
    const auto shared = common_instants(all);
    return wrong(swap, "no step of dt = " + seconds(dt.seconds) + " begins at " + seconds(swap.time) +
                           (shared ? "; all runs have steps at multiples of " + seconds(shared->seconds) : ""));
}

Error too_late(const PlannedSwap& swap, double until)
{
    const std::string end = "the runs end at " + seconds(until);
    return wrong(swap, swap.step ? end + ", before step " + std::to_string(*swap.step) + " (" + seconds(swap.time) + ")"
                                 : end + ": a swap must come before that");
}

const model::ComponentSpec* component_of(const model::SceneSpec& scene, const std::string& id)
{
    const model::ComponentSpec* c = scene.find(id);
    return c && !c->alias_of.empty() ? component_of(scene, c->alias_of) : c;
}

Error unknown_id(const model::SceneSpec& scene, const PlannedSwap& swap)
{
    std::vector<std::string> ids;
    for (const model::ComponentSpec& c : scene.components) ids.push_back(c.id);
    return wrong(swap, "no component has the id '" + swap.id + "'" + model::did_you_mean(swap.id, ids));
}

Result<void> settle(PlannedSwap& swap, const std::vector<model::StepLength>& lengths, double until)
{
    if (swap.step)
    {
        const model::StepLength& first = lengths.front();
        swap.time = first.at(*swap.step);
        for (const model::StepLength& dt : lengths)
            if (dt.at(*swap.step) != swap.time)
                return wrong(swap, "step " + std::to_string(*swap.step) + " is at " + seconds(swap.time) +
                                       " with dt = " + seconds(first.seconds) + " and at " + seconds(dt.at(*swap.step)) +
                                       " with dt = " + seconds(dt.seconds) + ": give a time, which is the same for all, such as " +
                                       model::format_real(swap.time) + "s:" + swap.id + "=" + swap.type);
    }
    if (swap.time >= until * (1 - 1e-12)) return too_late(swap, until);
    for (const model::StepLength& dt : lengths)
        if (!step_at(swap.time, dt)) return no_step_at(swap, dt, lengths);
    return {};
}

}  // namespace

Result<PlannedSwap> parse_swap(const std::string& text)
{
    const std::size_t colon = text.find(':'), equal = text.rfind('=');
    PlannedSwap out;
    out.text = text;
    const bool parts = colon != std::string::npos && equal != std::string::npos && equal > colon + 1 && equal + 1 < text.size();
    if (!parts || !read_when(model::trimmed(std::string_view(text).substr(0, colon)), out))
        return reason(
            "--swap needs STEP:ID=TYPE or TIME:ID=TYPE, the time with its unit, such as 120:contact.response=Response/None or "
            "0.5s:contact.response=None, not '" +
            text + "'");
    out.id = text.substr(colon + 1, equal - colon - 1), out.type = text.substr(equal + 1);
    return out;
}

Result<void> settle_times(std::vector<PlannedSwap>& swaps, const std::vector<model::StepLength>& lengths, double until)
{
    for (PlannedSwap& swap : swaps)
        if (auto done = settle(swap, lengths, until); !done) return done;
    std::stable_sort(swaps.begin(), swaps.end(), [](const PlannedSwap& a, const PlannedSwap& b) { return a.time < b.time; });
    return {};
}

Result<std::vector<SwapAt>> swaps_of(const std::vector<PlannedSwap>& settled, const model::SceneSpec& scene, model::TypeSource& types)
{
    std::vector<SwapAt> out;
    model::SceneSpec then = scene;
    for (const PlannedSwap& swap : settled)
    {
        const auto step = step_at(swap.time, scene.settings.dt);
        if (!step) return no_step_at(swap, scene.settings.dt, {scene.settings.dt});
        const model::ComponentSpec* c = component_of(then, swap.id);
        if (!c) return unknown_id(then, swap);
        const std::string id = c->id;
        auto after = apply(then, types, {{id, swap.type}});
        if (!after) return reason("--swap " + after.error().reason);
        then = after.take();
        out.push_back({*step, id, then.find(id)->type});
    }
    return out;
}

}  // namespace plab::study
