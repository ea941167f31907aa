#include "simulation/requests/request_words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace plab::simulation
{
namespace
{

std::string in_us(double ns)
{
    char text[32];
    std::snprintf(text, sizeof text, ns < 9.95e3 ? "%.2f" : ns < 9.995e4 ? "%.1f" : "%.0f", 1e-3 * ns);
    return text;
}

std::string in_words(const Spread& s) { return in_us(s.median) + " us (" + in_us(s.low) + " to " + in_us(s.high) + ")"; }

}  // namespace

bool costs_differ(const Spread& with_old, const Spread& with_new)
{
    constexpr double kShare = 0.25, kLeast = 500;  // ns
    const double gap = std::abs(with_new.median - with_old.median);
    return differ(with_old, with_new) && gap > std::max(kLeast, kShare * std::min(with_new.median, with_old.median));
}

std::string text_of_costs(const TrialReport& trial)
{
    const Spread &now = trial.with_new, &before = trial.with_old;
    if (!now.is_known()) return {};
    std::string out = "a step costs " + in_words(now);
    if (!before.is_known()) return out;
    out += ", " + in_words(before) + " before: ";
    if (!costs_differ(before, now)) return out + "no significant difference";
    return out + in_us(std::abs(now.median - before.median)) + (now.median > before.median ? " us more" : " us less");
}

std::string text_of(const TrialReport& trial)
{
    char text[160];
    const double ms = 1e-6 * trial.ns;
    const char* const what = trial.everything ? "everything" : trial.objects == 1 ? "object" : "objects";
    switch (trial.outcome)
    {
        case TrialReport::Outcome::None:
            return "none";
        case TrialReport::Outcome::GivenUp:
            std::snprintf(text, sizeof text, "given up after %.1f ms (budget %.3g ms)", ms, 1e-6 * trial.budget_ns);
            return text;
        case TrialReport::Outcome::Made:
        case TrialReport::Outcome::WithoutOld:
            break;
    }
    if (trial.everything)
        std::snprintf(text, sizeof text, "made: %s, %.3g ms", what, ms);
    else if (trial.sample_of != 0)
        std::snprintf(text, sizeof text, "made: a sample of %zu of %zu objects%s, %.3g ms", trial.objects, trial.sample_of,
                      trial.held ? " with what touches them held still" : "", ms);
    else
        std::snprintf(text, sizeof text, "made: %zu %s, %.3g ms", trial.objects, what, ms);
    const std::string costs = text_of_costs(trial);
    return std::string(text) + (trial.outcome == TrialReport::Outcome::WithoutOld ? ", the old one's step was given up" : "") +
           (costs.empty() ? "" : "; " + costs);
}

}  // namespace plab::simulation
