/// pLab beside its peers, in words: which of them is the more accurate at which cost.

#include <cmath>
#include <cstdio>
#include <utility>

#include "bench/peers/results.h"

namespace plab::peers
{
namespace
{

/// Factors below this are the noise of rounding.
constexpr double kEven = 1.005;

std::string figure(double v)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", v);
    return text;
}

std::string setting_of(const Point& p)
{
    return p.run.settings + (p.run.control.empty() ? " dt " + p.run.step.text() : " tol " + p.run.control);
}

/// A point of the peers' front and pLab's best result for it.
struct Standing
{
    const Point* peer = nullptr;
    const Point* own = nullptr;  ///< of pLab, the least error among those that cost no more; null: none is as cheap
    double lead = 0;             ///< the peer's error by pLab's; 0: none is as cheap

    bool leads() const { return lead >= kEven; }
    bool lags() const { return lead < 1; }
};

const Point* best_within(const std::vector<Point>& points, std::size_t metric, double cost)
{
    const Point* best = nullptr;
    for (const Point& p : points)
        if (p.is_plab() && p.counts(metric) && p.cost <= cost && (best == nullptr || p.figures[metric] < best->figures[metric])) best = &p;
    return best;
}

std::vector<Standing> standings(const CaseResult& result, std::size_t metric)
{
    std::vector<Standing> out;
    for (const std::size_t i : front(result.points, metric, false))
    {
        Standing s{&result.points[i], nullptr, 0};
        s.own = best_within(result.points, metric, s.peer->cost);
        if (s.own != nullptr) s.lead = std::fmax(s.peer->figures[metric], kRounding) / std::fmax(s.own->figures[metric], kRounding);
        out.push_back(s);
    }
    return out;
}

std::string verdict(const Standing& s)
{
    if (s.own == nullptr) return "lags";
    if (s.lags()) return "lags " + figure(1 / s.lead) + "x";
    return s.leads() ? "leads " + figure(s.lead) + "x" : "even";
}

void summarize(const CaseResult& result, std::size_t metric, std::string& out)
{
    const Metric& m = result.which.metrics[metric];
    out += "\n### " + result.which.title + ": " + m.text + (m.unit == "1" ? "" : ", " + m.unit) + "\n\n";
    out += "| ms/s | peer | its error | pLab's best at no more cost | ms/s | its error | pLab |\n|---:|---|---:|---|---:|---:|---|\n";
    const std::vector<Standing> all = standings(result, metric);
    for (const Standing& s : all)
    {
        out += "| " + figure(s.peer->cost) + " | " + s.peer->run.label() + " | " + figure(s.peer->figures[metric]) + " | ";
        out += s.own == nullptr ? "none as cheap | | | "
                                : setting_of(*s.own) + " | " + figure(s.own->cost) + " | " + figure(s.own->figures[metric]) + " | ";
        out += verdict(s) + " |\n";
    }
    if (all.empty()) out += "| | no peer has a point | | | | | |\n";
    std::string own_front;
    for (const std::size_t i : front(result.points, metric, true))
    {
        const Point& p = result.points[i];
        own_front += (own_front.empty() ? "" : "; ") + figure(p.cost) + " → " + figure(p.figures[metric]) + " (" + setting_of(p) + ")";
    }
    out += "\npLab's front, ms/s → error: " + (own_front.empty() ? "none" : own_front) + ".\n";
}

std::string overview_line(const CaseResult& result, std::size_t metric)
{
    const std::vector<Standing> all = standings(result, metric);
    std::size_t leads = 0, even = 0;
    double least = 0, most = 0;
    std::string lags;
    for (const Standing& s : all)
    {
        if (s.lags())
        {
            lags += (lags.empty() ? "" : "; ") + figure(s.peer->cost) + " ms/s: " + s.peer->run.label() + " " +
                    figure(s.peer->figures[metric]) + ", pLab " + (s.own ? figure(s.own->figures[metric]) : "has none as cheap");
            continue;
        }
        if (!s.leads())
        {
            ++even;
            continue;
        }
        least = leads == 0 ? s.lead : std::fmin(least, s.lead);
        most = std::fmax(most, s.lead);
        ++leads;
    }
    const std::string range = leads == 0 ? "" : ", " + figure(least) + "x to " + figure(most) + "x";
    return "| " + result.which.id + " | " + result.which.metrics[metric].text + " | " + std::to_string(leads) + " of " +
           std::to_string(all.size()) + range + (even == 0 ? "" : "; even at " + std::to_string(even)) + " | " +
           (lags.empty() ? "nowhere" : lags) + " |\n";
}

/// One line per settings and reason.
void report_failures(const CaseResult& result, std::string& out)
{
    for (const std::string& note : result.notes) out += "- " + note + "\n";
    std::vector<std::pair<std::string, std::string>> reported;  // line, steps
    for (const Point& p : result.points)
    {
        if (p.outcome == Outcome::Done) continue;
        const std::string line = "- " + p.run.engine + " " + p.run.settings + ": " + name_of(p.outcome) + ", " + p.why;
        const std::string step = p.run.control.empty() ? p.run.step.text() : p.run.control;
        const auto place = std::find_if(reported.begin(), reported.end(), [&line](const auto& t) { return t.first == line; });
        if (place == reported.end())
            reported.emplace_back(line, step);
        else
            place->second += ", " + step;
    }
    for (const auto& [line, steps] : reported) out += line + " (" + steps + ")\n";
}

}  // namespace

std::string overview_of(const std::vector<CaseResult>& results)
{
    std::string out = "| case | metric | pLab leads at points of the peers' front | pLab lags |\n|---|---|---|---|\n";
    for (const CaseResult& r : results)
        for (std::size_t m = 0; m < r.which.metrics.size(); ++m) out += overview_line(r, m);
    return out;
}

std::string summary_of(const std::vector<CaseResult>& results)
{
    std::string out = "# Overview\n\n" + overview_of(results);
    for (const CaseResult& r : results)
    {
        out += "\n## Case " + r.which.id + "\n";
        for (std::size_t m = 0; m < r.which.metrics.size(); ++m) summarize(r, m, out);
        std::string failures;
        report_failures(r, failures);
        if (!failures.empty()) out += "\nLeft out or failed:\n\n" + failures;
    }
    return out;
}

}  // namespace plab::peers
