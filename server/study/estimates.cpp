#include "study/estimates.h"

#include <algorithm>
#include <cmath>

namespace plab::study
{
namespace
{

using simulation::Simulation;

constexpr std::size_t kMostComponents = 12;  ///< of one interval

double quantile(std::vector<double>& values, double share)
{
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace

Result<void> EstimateCheck::open(Simulation& exact, const simulation::Snapshot& state, const simulation::Ladder& ladder,
                                 const std::vector<std::string>& watched, double interval, const simulation::LevelBook& levels)
{
    drop();
    interval_ = interval;
    const std::size_t count = std::min(kMostComponents, watched.size());
    for (std::size_t n = 0; n < count; ++n)
    {
        const std::string& id = watched[n * watched.size() / count];
        const std::uint32_t component = exact.world().find(id);
        std::vector<std::string> objects;
        for (const Ref object : levels.objects_of(component)) objects.push_back(exact.world().id_of(object));
        double estimate = 0;
        for (std::size_t l = ladder.levels.size() - 1; l-- > 0;)
        {
            const LevelError told = exact.try_level(component, ladder.levels[l], ladder.levels[l + 1], interval);
            estimate += told_by(told);
            samples_.push_back({l, objects, {ladder.levels[l].text, id, exact.time(), estimate, 0}});
        }
    }
    for (std::size_t l = 0; l + 1 < ladder.levels.size(); ++l)
    {
        Simulation& course = *courses_.emplace_back(std::make_unique<Simulation>(types_));
        course.let_decide(false);
        if (auto restored = course.restore(state); !restored) return restored;
        if (auto given = give_all(course, watched, ladder.levels[l]); !given) return given;
        if (unit_ == "W") energies_.emplace_back().begin(course);
    }
    return {};
}

double EstimateCheck::told_by(const LevelError& error) const
{
    if (unit_ == "W") return error.power;
    return unit_ == "rad" ? error.angle : error.distance;
}

Result<void> EstimateCheck::follow(Simulation& exact)
{
    for (const auto& course : courses_) (void)course->step_once();
    for (std::size_t l = 0; l < energies_.size(); ++l)
        if (auto looked = energies_[l].look(*courses_[l], exact); !looked) return looked;
    std::vector<Ref> objects;
    for (Sampled& s : samples_)
    {
        const Simulation& course = *courses_[s.level];
        objects.clear();
        for (const std::string& id : s.objects)
            if (const std::uint32_t object = course.world().find(id); object != kNoIndex)
                objects.push_back(course.world().component(object).ref(object));
        if (!energies_.empty()) s.found.error = std::max(s.found.error, std::fabs(energies_[s.level].excess(course, objects)) / interval_);
        for (const Ref object : energies_.empty() ? std::span<const Ref>(objects) : std::span<const Ref>())
        {
            ObjectPair pair;
            if (!find_pair(course, exact, object, pair)) continue;
            const Apart a = apart(course, exact, pair);
            s.found.error = std::max(s.found.error, unit_ == "rad" ? a.radians : a.metres);
        }
    }
    return {};
}

void EstimateCheck::close(std::vector<EstimateSample>& out)
{
    for (Sampled& s : samples_) out.push_back(std::move(s.found));
    drop();
}

std::vector<EstimateSpread> spreads_of(const std::vector<EstimateSample>& samples)
{
    constexpr double kRounding = 1e-12;  // m or rad
    std::vector<EstimateSpread> out;
    for (const EstimateSample& s : samples)
        if (std::none_of(out.begin(), out.end(), [&](const EstimateSpread& known) { return known.level == s.level; }))
            out.emplace_back().level = s.level;
    for (EstimateSpread& spread : out)
    {
        std::vector<double> ratios, errors;
        for (const EstimateSample& s : samples)
            if (s.level == spread.level && s.error > kRounding && std::isfinite(s.estimate))
                ratios.push_back(s.estimate / s.error), errors.push_back(s.error);
        spread.samples = ratios.size();
        if (ratios.empty()) continue;
        spread.tenth = quantile(ratios, 0.1), spread.median = quantile(ratios, 0.5), spread.nine_tenths = quantile(ratios, 0.9);
        spread.error = quantile(errors, 0.5);
    }
    return out;
}

}  // namespace plab::study
