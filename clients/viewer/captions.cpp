#include "viewer/captions.h"

#include <algorithm>
#include <cstdio>

namespace plab::view
{
namespace
{

/// Number of remembered changes of one algorithm: frames lag behind the catalogue by less than that.
constexpr std::size_t kMostChanges = 64;

std::string shortened(std::string line)
{
    if (line.size() <= Captions::kLongestLine) return line;
    line.resize(Captions::kLongestLine - 3);
    return line + "...";
}

/// Ids, limited to the most expensive ones if there are too many; in order of ids.
std::vector<std::string> choose(const link::CatalogueContents& scene)
{
    std::vector<std::pair<double, std::string>> ranked;
    for (const auto& [id, interaction] : scene.interactions)
    {
        const link::InteractionMetrics* const metrics = link::find_metrics(scene.metrics, id);
        ranked.emplace_back(metrics != nullptr ? metrics->cost_ns : 0.0, id);
    }
    if (ranked.size() > Captions::kMostLines)
    {
        std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
        ranked.resize(Captions::kMostLines);
        std::sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    }
    std::vector<std::string> ids;
    for (auto& [cost, id] : ranked) ids.push_back(std::move(id));
    return ids;
}

}  // namespace

void Captions::use(const link::CatalogueContents& scene)
{
    const std::uint64_t run = scene.scene ? scene.scene->run : 0;
    if (run != run_) algorithms_.clear();
    run_ = run;
    title_ = !scene.scene ? "" : scene.scene->title.empty() ? scene.scene->file : scene.scene->title;
    shown_ = choose(scene);
    left_out_ = scene.interactions.size() - shown_.size();
    quarantined_.clear();
    for (const auto& [id, interaction] : scene.interactions)
    {
        std::vector<Change>& changes = algorithms_[id];
        if (changes.empty() || changes.back().second != interaction.type_name)
            changes.emplace_back(interaction.since, interaction.type_name);
        if (changes.size() > kMostChanges) changes.erase(changes.begin());
        quarantined_[id] = interaction.quarantined;
    }
}

const std::string& Captions::algorithm_at(const std::string& id, std::int64_t step) const
{
    const std::vector<Change>& changes = algorithms_.at(id);
    // The first known algorithm is also used for earlier times, for lack of better information.
    auto change = changes.end() - 1;
    while (change != changes.begin() && change->first > step) --change;
    return change->second;
}

std::vector<std::string> Captions::lines(const State& state) const
{
    char time[48];
    std::snprintf(time, sizeof time, "t = %.3f s", state.time);
    std::vector<std::string> out{shortened(title_.empty() ? time : title_ + ", " + time)};
    for (const std::string& id : shown_)
        out.push_back(shortened(id + ": " + algorithm_at(id, state.step) + (quarantined_.at(id) ? " (quarantined)" : "")));
    if (left_out_ > 0) out.push_back("and " + std::to_string(left_out_) + " more");
    return out;
}

}  // namespace plab::view
