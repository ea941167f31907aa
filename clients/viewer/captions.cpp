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

}  // namespace

void Captions::use(const link::CatalogueContents& scene)
{
    const std::uint64_t run = scene.scene ? scene.scene->run : 0;
    if (run != run_) algorithms_.clear();
    run_ = run;
    title_ = !scene.scene ? "" : scene.scene->title.empty() ? scene.scene->file : scene.scene->title;
    known_.clear();
    for (const auto& [id, interaction] : scene.interactions)
    {
        std::vector<Change>& changes = algorithms_[id];
        if (changes.empty() || changes.back().second != interaction.type_name)
            changes.emplace_back(interaction.since, interaction.type_name);
        if (changes.size() > kMostChanges) changes.erase(changes.begin());
        const link::InteractionMetrics* const metrics = link::find_metrics(scene.metrics, id);
        known_[id] = {metrics != nullptr ? metrics->cost_ns : 0, interaction.quarantined};
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

std::vector<std::string> Captions::grouped_lines(std::int64_t step) const
{
    struct Group
    {
        std::string algorithm, first;
        double cost = 0;
        std::size_t count = 0;
    };
    std::map<std::string, Group> by_algorithm;
    for (const auto& [id, known] : known_)
    {
        const std::string algorithm = algorithm_at(id, step) + (known.is_quarantined ? " (quarantined)" : "");
        Group& group = by_algorithm.try_emplace(algorithm, Group{algorithm, id}).first->second;
        group.cost += known.cost, ++group.count;
    }
    std::vector<Group> groups;
    for (auto& [algorithm, group] : by_algorithm) groups.push_back(std::move(group));
    std::size_t left_out = 0;
    if (groups.size() > kMostLines)
    {
        std::stable_sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) { return a.cost > b.cost; });
        for (std::size_t k = kMostLines; k < groups.size(); ++k) left_out += groups[k].count;
        groups.resize(kMostLines);
        std::sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) { return a.algorithm < b.algorithm; });
    }
    std::vector<std::string> out;
    for (const Group& g : groups)
        out.push_back(g.count == 1 ? g.first + ": " + g.algorithm : g.algorithm + ": " + std::to_string(g.count) + ", such as " + g.first);
    if (left_out > 0) out.push_back("and " + std::to_string(left_out) + " more");
    return out;
}

std::vector<std::string> Captions::lines(const State& state) const
{
    char time[48];
    std::snprintf(time, sizeof time, "t = %.3f s", state.time);
    std::vector<std::string> out{title_.empty() ? time : title_ + ", " + time};
    if (known_.size() > kMostLines)
        for (std::string& line : grouped_lines(state.step)) out.push_back(std::move(line));
    else
        for (const auto& [id, known] : known_)
            out.push_back(id + ": " + algorithm_at(id, state.step) + (known.is_quarantined ? " (quarantined)" : ""));
    for (std::string& line : out) line = shortened(std::move(line));
    return out;
}

}  // namespace plab::view
