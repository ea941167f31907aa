// Compares the contacts of a run with those of the reference.
#include <algorithm>
#include <cmath>
#include <map>

#include "study/study.h"

namespace plab::study
{
namespace
{

/// Longer sequences are matched one to one: the table would not fit.
constexpr std::size_t kMostAligned = 2000;

using Times = std::vector<double>;

/// Cost of leaving one out, s: half of the usual distance of neighbours, so that an impact is not matched with the next one.
double skip_cost(const Times& reference)
{
    Times gaps;
    for (std::size_t i = 1; i < reference.size(); ++i) gaps.push_back(reference[i] - reference[i - 1]);
    if (gaps.empty()) return std::numeric_limits<double>::max() / 8;
    std::nth_element(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2), gaps.end());
    return 0.5 * std::max(gaps[gaps.size() / 2], 1e-12);
}

void one_to_one(const Times& run, const Times& reference, ContactFigures& out)
{
    const std::size_t n = std::min(run.size(), reference.size());
    for (std::size_t i = 0; i < n; ++i) out.worst_time_error = std::max(out.worst_time_error, std::fabs(run[i] - reference[i]));
    out.missed += static_cast<int>(reference.size() - n), out.extra += static_cast<int>(run.size() - n);
}

/// Alignment by dynamic programming: cost[i][j] of the first i of the run and the first j of the reference.
void align(const Times& run, const Times& reference, ContactFigures& out)
{
    if (run.size() > kMostAligned || reference.size() > kMostAligned || reference.empty()) return one_to_one(run, reference, out);
    const double skip = skip_cost(reference);
    const std::size_t width = reference.size() + 1;
    std::vector<double> cost((run.size() + 1) * width);
    const auto at = [&](std::size_t i, std::size_t j) -> double& { return cost[i * width + j]; };
    for (std::size_t i = 0; i <= run.size(); ++i)
        for (std::size_t j = 0; j < width; ++j)
        {
            if (i == 0 || j == 0)
                at(i, j) = skip * static_cast<double>(i + j);
            else
                at(i, j) =
                    std::min({at(i - 1, j - 1) + std::fabs(run[i - 1] - reference[j - 1]), at(i - 1, j) + skip, at(i, j - 1) + skip});
        }
    std::size_t i = run.size(), j = reference.size();
    while (i > 0 && j > 0)
    {
        const double error = std::fabs(run[i - 1] - reference[j - 1]);
        if (at(i, j) == at(i - 1, j - 1) + error)
            out.worst_time_error = std::max(out.worst_time_error, error), --i, --j;
        else if (at(i, j) == at(i - 1, j) + skip)
            ++out.extra, --i;
        else
            ++out.missed, --j;
    }
    out.extra += static_cast<int>(i), out.missed += static_cast<int>(j);
}

using ByPair = std::map<std::pair<std::string, std::string>, Times>;

ByPair impacts_by_pair(const std::vector<RecordedContact>& contacts)
{
    ByPair out;
    for (const RecordedContact& c : contacts)
        if (c.kind == "contact.impact")
        {
            // Several points of one impact are one event.
            Times& times = out[std::minmax(c.a, c.b)];
            if (times.empty() || c.time != times.back()) times.push_back(c.time);
        }
    return out;
}

}  // namespace

ContactFigures compare_contacts(const std::vector<RecordedContact>& run, const std::vector<RecordedContact>& reference)
{
    ContactFigures out;
    out.known = true;
    ByPair ours = impacts_by_pair(run);
    const ByPair theirs = impacts_by_pair(reference);
    for (const auto& [pair, times] : theirs)
    {
        out.expected += static_cast<int>(times.size());
        align(ours[pair], times, out);
        ours.erase(pair);
    }
    for (const auto& [pair, times] : ours) out.extra += static_cast<int>(times.size());
    return out;
}

}  // namespace plab::study
