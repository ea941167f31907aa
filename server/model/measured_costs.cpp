#include "model/measured_costs.h"

#include <algorithm>
#include <cstdio>

namespace plab::model
{
namespace
{

/// Costs closer than this are not ordered: the difference may be other load on the machine.
constexpr double kAlike = 1.1;

std::string figure(double us)
{
    if (us == kDear) return "more than " + std::to_string(kDearestStep) + " s";
    char text[32];
    std::snprintf(text, sizeof text, us < 999.5 ? "%.3g" : "%.0f", us);
    return text;
}

std::string ordinal(std::size_t n)
{
    const std::size_t last = n % 100 > 10 && n % 100 < 14 ? 0 : n % 10;
    return std::to_string(n) + (last == 1 ? "st" : last == 2 ? "nd" : last == 3 ? "rd" : "th");
}

double cost_in(const MeasuredCost& m, std::size_t kind) { return kind == 0 ? m.few : kind == 1 ? m.many : m.tied; }

MeasuredLadder ladder_of(const MeasuredFamily& family, std::size_t kind)
{
    MeasuredLadder out{family.prefix, family.scenes[kind], {}};
    for (const MeasuredCost& m : kMeasuredCosts)
        if (m.type.starts_with(family.prefix) && cost_in(m, kind) >= 0) out.algorithms.push_back({m.type, cost_in(m, kind)});
    std::stable_sort(out.algorithms.begin(), out.algorithms.end(), [](const auto& a, const auto& b) { return a.us < b.us; });
    return out;
}

}  // namespace

std::size_t MeasuredLadder::place_of(std::string_view type) const
{
    const auto it = std::find_if(algorithms.begin(), algorithms.end(), [&](const Algorithm& r) { return r.type == type; });
    if (it == algorithms.end()) return 0;
    return 1 + static_cast<std::size_t>(
                   std::count_if(algorithms.begin(), algorithms.end(), [&](const Algorithm& r) { return r.us * kAlike < it->us; }));
}

std::string MeasuredLadder::text() const
{
    std::string out;
    for (std::size_t k = 0; k < algorithms.size(); ++k)
    {
        if (k > 0) out += algorithms[k].us > kAlike * algorithms[k - 1].us ? " < " : " ~ ";
        out += "`" + std::string(algorithms[k].type.substr(family.size())) + "` " + figure(algorithms[k].us);
    }
    return out;
}

std::vector<MeasuredLadder> measured_ladders(std::string_view prefix)
{
    std::vector<MeasuredLadder> out;
    for (const MeasuredFamily& family : kMeasuredFamilies)
        for (std::size_t kind = 0; kind < family.scenes.size() && family.prefix.starts_with(prefix); ++kind)
            out.push_back(ladder_of(family, kind));
    return out;
}

std::string measured_cost_of(std::string_view type)
{
    for (const MeasuredFamily& family : kMeasuredFamilies)
        for (const MeasuredCost& m : kMeasuredCosts)
        {
            if (m.type != type || !type.starts_with(family.prefix)) continue;
            std::string out;
            for (std::size_t kind = 0; kind < family.scenes.size(); ++kind)
            {
                const MeasuredLadder ladder = ladder_of(family, kind);
                const std::size_t place = ladder.place_of(type);
                out += kind > 0 ? ", " : "";
                out += place == 0 ? "refused"
                                  : figure(cost_in(m, kind)) + (cost_in(m, kind) == kDear ? " (" : " us (") + ordinal(place) + " of " +
                                        std::to_string(ladder.algorithms.size()) + ")";
                out += " for " + std::string(ladder.scene);
            }
            return out;
        }
    return {};
}

}  // namespace plab::model
