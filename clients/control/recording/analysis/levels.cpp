#include "control/recording/analysis/levels.h"

#include <algorithm>

#include "control/recording/analysis/curves.h"

namespace plab::analysis
{
namespace
{

std::string_view level_text(const plab_v2_Interaction& interaction, std::string_view name)
{
    for (std::uint32_t i = 0; i < interaction.parameters._length; ++i)
    {
        const plab_v2_Parameter& p = interaction.parameters._buffer[i];
        if (std::string_view(p.kind) == "level" && std::string_view(p.name) == name) return p.text;
    }
    return {};
}

using LevelName = std::pair<std::string, std::string>;  // governor, algorithm

class LevelCounts
{
public:
    explicit LevelCounts(const Extent& extent) : extent_(extent) {}

    void note(const plab_v2_Interaction& interaction, double time)
    {
        if (time != time_) flush();
        if (interaction.run != run_) begin_run(interaction.run);
        time_ = time;
        const LevelName now{level_text(interaction, "governor"), level_text(interaction, "level_algorithm")};
        const auto known = level_of_.find(interaction.component_id);
        if (known != level_of_.end() && known->second == now) return;
        if (known != level_of_.end() && !known->second.first.empty()) change(known->second, -1);
        if (!now.first.empty()) change(now, 1);
        level_of_[interaction.component_id] = now;
    }
    std::vector<figures::Curve> take()
    {
        flush();
        time_ = extent_.end;
        for (Series& s : series_) s.changed = true;
        flush();
        std::vector<figures::Curve> out;
        for (Series& s : series_) out.push_back({s.level.second, "components of " + s.level.first, s.points.take()});
        return out;
    }

private:
    struct Series
    {
        LevelName level;
        Thinned points;
        int count = 0, drawn = 0;
        bool changed = false;
    };

    void change(const LevelName& level, int by)
    {
        auto found = std::find_if(series_.begin(), series_.end(), [&](const Series& s) { return s.level == level; });
        if (found == series_.end()) found = series_.insert(series_.end(), {level, Thinned(extent_.begin, extent_.end)});
        found->count += by, found->changed = true;
    }
    /// What has changed at the present time: a step of the curve.
    void flush()
    {
        for (Series& s : series_)
        {
            if (!s.changed) continue;
            s.points.add(time_, s.drawn), s.points.add(time_, s.count);
            s.drawn = s.count, s.changed = false;
        }
    }
    void begin_run(std::uint64_t run)
    {
        for (Series& s : series_) s.changed = s.changed || s.count != 0, s.count = 0;
        level_of_.clear();
        run_ = run;
    }

    Extent extent_;
    std::uint64_t run_ = 0;
    double time_ = 0;
    std::map<std::string, LevelName> level_of_;  ///< by component
    std::vector<Series> series_;
};

}  // namespace

std::vector<figures::Curve> levels_over_time(const Log& log)
{
    LevelCounts counts(extent_of(log, {}));
    Stream stream = log.stream({"plab/interactions"});
    while (const Entry* entry = stream.next())
        if (const auto* interaction = entry->as<plab_v2_Interaction>()) counts.note(*interaction, seconds(entry->log_time));
    return counts.take();
}

}  // namespace plab::analysis
