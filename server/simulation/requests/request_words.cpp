#include "simulation/requests/request_words.h"

#include <cstdio>

namespace plab::simulation
{

std::string text_of(const TrialReport& trial)
{
    char text[128];
    const double ms = 1e-6 * trial.ns;
    const char* const what = trial.everything ? "everything" : trial.objects == 1 ? "object" : "objects";
    switch (trial.fate)
    {
        case TrialReport::Fate::None:
            return "none";
        case TrialReport::Fate::GivenUp:
            std::snprintf(text, sizeof text, "given up after %.1f ms (budget %.3g ms)", ms, 1e-6 * trial.budget_ns);
            return text;
        case TrialReport::Fate::Made:
        case TrialReport::Fate::WithoutOld:
            break;
    }
    if (trial.everything)
        std::snprintf(text, sizeof text, "made: %s, %.3g ms", what, ms);
    else
        std::snprintf(text, sizeof text, "made: %zu %s, %.3g ms", trial.objects, what, ms);
    return std::string(text) + (trial.fate == TrialReport::Fate::WithoutOld ? ", the old one's step was given up" : "");
}

}  // namespace plab::simulation
