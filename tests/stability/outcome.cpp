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
constexpr std::string_view kSlow = "slow: ", kOfTheTime = " % of the time";

/// Cuts "slow: N % of the time" off the end of `how`.
std::optional<double> take_reached(std::string& how)
{
    const std::size_t at = how.rfind(kSlow);
    if (at == std::string::npos || !how.ends_with(kOfTheTime)) return {};
    const double percent = std::strtod(how.c_str() + at + kSlow.size(), nullptr);
    how.erase(at < 2 ? 0 : at - 2);  // with the comma before it
    return percent;
}

bool agree_on_pace(std::optional<double> a, std::optional<double> b)
{
    if (a.has_value() != b.has_value()) return false;
    if (!a) return true;
    const double least = std::min(*a, *b), most = std::max(*a, *b);
    return most <= kPace * least || most - least <= 1;
}

}  // namespace

std::string_view name_of(Verdict verdict) { return kNames[static_cast<std::size_t>(verdict)]; }

std::optional<Verdict> verdict_of(std::string_view name)
{
    const auto found = std::find(kNames.begin(), kNames.end(), name);
    if (found == kNames.end()) return {};
    return static_cast<Verdict>(found - kNames.begin());
}

std::string reason_of(const Outcome& outcome)
{
    if (!outcome.reached) return outcome.how;
    char percent[32];
    std::snprintf(percent, sizeof percent, "%.0f", *outcome.reached);
    return outcome.how + (outcome.how.empty() ? "" : ", ") + std::string(kSlow) + percent + std::string(kOfTheTime);
}

std::string to_line(const Outcome& outcome)
{
    char figure[32];
    std::snprintf(figure, sizeof figure, "%.1e", outcome.figure);
    const std::string reason = reason_of(outcome);
    return std::string(name_of(outcome.verdict)) + " " + figure + (reason.empty() ? "" : " ") + reason;
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
    out.reached = take_reached(out.how);
    return out;
}

bool agree(const Outcome& expected, const Outcome& measured)
{
    if (expected.verdict != measured.verdict || expected.how != measured.how) return false;
    if (!agree_on_pace(expected.reached, measured.reached)) return false;
    // A figure beyond all bounds only says that it is large; a verdict without one has 0.
    if (expected.verdict == Verdict::Diverged || expected.verdict == Verdict::Refused) return true;
    const double a = std::max(std::fabs(expected.figure), kRounding), b = std::max(std::fabs(measured.figure), kRounding);
    return b <= kMostRatio * a && a <= kMostRatio * b;
}

}  // namespace plab::stability
