#include "simulation/levels/level_change.h"

#include <cmath>

#include "plab/number_text.h"

namespace plab::simulation
{
namespace
{

std::string seconds_text(double seconds)
{
    if (std::isnan(seconds)) return "unknown";
    if (seconds < 1e-6) return rounded_text(1e9 * seconds) + " ns";
    if (seconds < 1e-3) return rounded_text(1e6 * seconds) + " us";
    return rounded_text(1e3 * seconds) + " ms";
}

std::string error_text(double error, const std::string& unit)
{
    return std::isnan(error) ? "unknown" : rounded_text(error) + (unit.empty() ? "" : " " + unit);
}

}  // namespace

bool FigurePair::knows_both() const { return !std::isnan(before) && !std::isnan(after); }

bool FigurePair::knows_any() const { return !std::isnan(before) || !std::isnan(after); }

const FigurePair& better(const FigurePair& first, const FigurePair& second)
{
    if (first.knows_both() || !second.knows_any()) return first;
    return second.knows_both() || !first.knows_any() ? second : first;
}

std::string LevelChange::text() const
{
    return "cost " + seconds_text(cost.before) + " -> " + seconds_text(cost.after) + (is_trial ? " (trial)" : "") + ", error " +
           error_text(error.before, error.unit) + " -> " + error_text(error.after, error.unit);
}

}  // namespace plab::simulation
