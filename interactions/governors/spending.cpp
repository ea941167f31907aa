#include "spending.h"

#include <algorithm>
#include <cmath>

namespace plab::governors
{
namespace
{

constexpr double kMuch = 2;  ///< by which a step has to be worth more than one that was made already
/// s: what costs less is taken to cost this much.
constexpr double kLeastSeconds = 1e-12;

struct LevelStep
{
    double worth = 0;  ///< pixels per second
    std::size_t candidate = 0;
    std::int32_t from = 0, to = 0;
    double seconds = 0, at_worst = 0;
    bool doubtful() const { return at_worst > seconds; }
};

double price(const std::vector<double>& of, std::int32_t level) { return of[static_cast<std::size_t>(level)]; }

/// The steepest step from a level to a finer one; worth 0: no finer level has a smaller error.
LevelStep best_step(const Candidate& c, std::size_t index, std::int32_t from, const LevelPrices& prices)
{
    LevelStep best{0, index, from, from, 0, 0};
    const double error = c.errors[static_cast<std::size_t>(from)];
    for (auto to = from + 1; to < static_cast<std::int32_t>(prices.expected.size()); ++to)
    {
        const double removed = c.scale * (error - c.errors[static_cast<std::size_t>(to)]);
        const double seconds = c.weight * (price(prices.expected, to) - price(prices.expected, from));
        const double worth = removed / std::max(kLeastSeconds, seconds);
        if (removed > 0 && worth >= best.worth)
            best = {worth, index,   from,
                    to,    seconds, std::max(seconds, c.weight * (price(prices.worst, to) - price(prices.expected, from)))};
    }
    return best;
}

std::vector<LevelStep> steps_of(std::span<const Candidate> candidates, const LevelPrices& prices, double tolerance)
{
    std::vector<LevelStep> out;
    for (std::size_t k = 0; k < candidates.size(); ++k)
    {
        const Candidate& c = candidates[k];
        const auto error_at = [&](std::int32_t level) { return c.scale * c.errors[static_cast<std::size_t>(level)]; };
        for (std::int32_t from = c.least; error_at(from) > tolerance;)
        {
            LevelStep step = best_step(c, k, from, prices);
            if (step.worth <= 0) break;
            from = step.to;
            if (step.to <= c.present) step.worth *= kMuch;
            out.push_back(step);
        }
    }
    return out;
}

}  // namespace

std::vector<std::int32_t> choose_levels(std::span<const Candidate> candidates, const LevelPrices& prices, double seconds, double tolerance)
{
    std::vector<std::int32_t> levels;
    double spent = 0;
    for (const Candidate& c : candidates) levels.push_back(c.least), spent += c.weight * price(prices.expected, c.least);
    std::vector<LevelStep> steps = steps_of(candidates, prices, tolerance);
    std::stable_sort(steps.begin(), steps.end(), [](const LevelStep& a, const LevelStep& b) { return a.worth > b.worth; });
    std::vector<bool> tried(prices.expected.size(), false), tries(candidates.size(), false);
    for (const LevelStep& s : steps)
    {
        // An earlier step of this candidate did not fit, or is to be known before the next one is made.
        if (levels[s.candidate] != s.from || tries[s.candidate]) continue;
        const auto to = static_cast<std::size_t>(s.to);
        const bool one_tries = s.doubtful() && !tried[to];
        const double cost = s.doubtful() && !one_tries ? s.at_worst : s.seconds;
        if (cost > 0 && spent + cost > seconds) continue;
        spent += cost, levels[s.candidate] = s.to, tried[to] = tried[to] || one_tries, tries[s.candidate] = one_tries;
    }
    return levels;
}

}  // namespace plab::governors
