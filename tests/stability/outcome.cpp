#include "outcome.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace plab::stability
{

namespace
{

constexpr std::array<std::string_view, 5> kNames{"stable", "degraded", "refused", "diverged", "SILENT"};
constexpr double kMostRatio = 10;

}  // namespace

std::string_view name_of(Verdict verdict) { return kNames[static_cast<std::size_t>(verdict)]; }

std::optional<Verdict> verdict_of(std::string_view name)
{
    const auto found = std::find(kNames.begin(), kNames.end(), name);
    if (found == kNames.end()) return {};
    return static_cast<Verdict>(found - kNames.begin());
}

std::string to_line(const Outcome& outcome)
{
    char figure[32];
    std::snprintf(figure, sizeof figure, "%.1e", outcome.figure);
    return std::string(name_of(outcome.verdict)) + " " + figure + (outcome.how.empty() ? "" : " ") + outcome.how;
}

std::optional<Outcome> from_line(std::string_view line)
{
    const std::size_t first = line.find(' ');
    if (first == std::string_view::npos) return {};
    const auto verdict = verdict_of(line.substr(0, first));
    if (!verdict) return {};
    const std::string_view rest = line.substr(first + 1);
    const std::size_t second = rest.find(' ');
    Outcome out;
    out.verdict = *verdict;
    out.figure = std::strtod(std::string(rest.substr(0, second)).c_str(), nullptr);
    if (second != std::string_view::npos) out.how = rest.substr(second + 1);
    return out;
}

bool agree(const Outcome& expected, const Outcome& measured)
{
    if (expected.verdict != measured.verdict || expected.how != measured.how) return false;
    // A figure beyond all bounds only says that it is large; a verdict without one has 0.
    if (expected.verdict == Verdict::Diverged || expected.verdict == Verdict::Refused) return true;
    const double a = std::max(std::fabs(expected.figure), kRounding), b = std::max(std::fabs(measured.figure), kRounding);
    return b <= kMostRatio * a && a <= kMostRatio * b;
}

}  // namespace plab::stability
