#include "bench/peers/results.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <nlohmann/json.hpp>

namespace plab::peers
{
namespace
{

/// Below this a figure is rounding: two such figures are equal.
constexpr double kRounding = 1e-15;
/// An error has to be less than this share of the one before for a point to be ahead: settings that do the same differ by rounding.
constexpr double kGain = 0.995;
/// A figure that is no answer any more. Not a number compares as false as well.
constexpr double kBlownUp = 1e6;

std::string figure(double v)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", v);
    return text;
}

/// For machines.
std::string full(double v)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", v);
    return text;
}

std::string quoted(const std::string& text)
{
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + "\"";
}

std::string step_text(const Run& run) { return run.control.empty() ? run.step.text() : ""; }

/// pLab's point of least error among those that cost no more; null: none is as cheap.
const Point* best_within(const std::vector<Point>& points, std::size_t metric, double cost)
{
    const Point* best = nullptr;
    for (const Point& p : points)
        if (p.is_plab() && p.counts(metric) && p.cost <= cost && (best == nullptr || p.figures[metric] < best->figures[metric])) best = &p;
    return best;
}

std::string verdict(double peer, double own)
{
    const double factor = std::fmax(peer, kRounding) / std::fmax(own, kRounding);
    if (factor >= 1) return factor < 1.005 ? "even" : "leads " + figure(factor) + "x";
    return "lags " + figure(1 / factor) + "x";
}

void summarize(const CaseResult& result, std::size_t metric, std::string& out)
{
    const Metric& m = result.which.metrics[metric];
    out += "\n### " + result.which.title + ": " + m.text + (m.unit == "1" ? "" : ", " + m.unit) + "\n\n";
    out += "| ms/s | peer | its error | pLab's best at no more cost | ms/s | its error | pLab |\n|---:|---|---:|---|---:|---:|---|\n";
    const auto peers = front(result.points, metric, false);
    for (const std::size_t i : peers)
    {
        const Point& peer = result.points[i];
        const Point* own = best_within(result.points, metric, peer.cost);
        out += "| " + figure(peer.cost) + " | " + peer.run.label() + " | " + figure(peer.figures[metric]) + " | ";
        if (own == nullptr)
            out += "none as cheap | | | lags |\n";
        else
            out += own->run.settings + (own->run.control.empty() ? " dt " + own->run.step.text() : " tol " + own->run.control) + " | " +
                   figure(own->cost) + " | " + figure(own->figures[metric]) + " | " + verdict(peer.figures[metric], own->figures[metric]) +
                   " |\n";
    }
    if (peers.empty()) out += "| | no peer has a point | | | | | |\n";
    std::string own_front;
    for (const std::size_t i : front(result.points, metric, true))
    {
        const Point& p = result.points[i];
        own_front += (own_front.empty() ? "" : "; ") + figure(p.cost) + " → " + figure(p.figures[metric]) + " (" + p.run.settings + " " +
                     (p.run.control.empty() ? p.run.step.text() : p.run.control) + ")";
    }
    out += "\npLab's front, ms/s → error: " + (own_front.empty() ? "none" : own_front) + ".\n";
}

/// One line per settings and reason.
void tell_failures(const CaseResult& result, std::string& out)
{
    for (const std::string& note : result.notes) out += "- " + note + "\n";
    std::vector<std::pair<std::string, std::string>> told;  // line, steps
    for (const Point& p : result.points)
    {
        if (p.outcome == Outcome::Done) continue;
        const std::string line = "- " + p.run.engine + " " + p.run.settings + ": " + name_of(p.outcome) + ", " + p.why;
        const std::string step = p.run.control.empty() ? p.run.step.text() : p.run.control;
        const auto place = std::find_if(told.begin(), told.end(), [&line](const auto& t) { return t.first == line; });
        if (place == told.end())
            told.emplace_back(line, step);
        else
            place->second += ", " + step;
    }
    for (const auto& [line, steps] : told) out += line + " (" + steps + ")\n";
}

}  // namespace

bool Point::counts(std::size_t metric) const { return outcome == Outcome::Done && metric < figures.size() && figures[metric] < kBlownUp; }

std::vector<std::size_t> front(const std::vector<Point>& points, std::size_t metric, bool of_plab)
{
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (points[i].is_plab() == of_plab && points[i].counts(metric)) order.push_back(i);
    const auto before = [&](std::size_t a, std::size_t b)
    {
        if (points[a].cost != points[b].cost) return points[a].cost < points[b].cost;
        return points[a].figures[metric] < points[b].figures[metric];
    };
    std::sort(order.begin(), order.end(), before);
    std::vector<std::size_t> kept;
    for (const std::size_t i : order)
        if (kept.empty() || std::fmax(points[i].figures[metric], kRounding) < kGain * points[kept.back()].figures[metric])
            kept.push_back(i);
    return kept;
}

std::string csv_of(const std::vector<CaseResult>& results)
{
    std::string out =
        "case,engine,settings,step,tolerance,outcome,why,cost_ms_per_s,least_cost_ms_per_s,memory_mb,repetitions,metric,error\n";
    for (const CaseResult& r : results)
        for (const Point& p : r.points)
            for (std::size_t m = 0; m < r.which.metrics.size(); ++m)
                out += r.which.id + "," + p.run.engine + "," + quoted(p.run.settings) + "," + step_text(p.run) + "," + p.run.control + "," +
                       name_of(p.outcome) + "," + quoted(p.why) + "," + full(p.cost) + "," + full(p.cost_least) + "," + full(p.memory) +
                       "," + std::to_string(p.repetitions) + "," + r.which.metrics[m].name + "," +
                       (m < p.figures.size() ? full(p.figures[m]) : "") + "\n";
    return out;
}

std::string json_of(const std::vector<CaseResult>& results)
{
    using nlohmann::json;
    json all = json::array();
    for (const CaseResult& r : results)
    {
        json points = json::array();
        for (const Point& p : r.points)
        {
            json figures = json::object();
            for (std::size_t m = 0; m < p.figures.size(); ++m)
                figures[r.which.metrics[m].name] = std::isfinite(p.figures[m]) ? json(p.figures[m]) : json(nullptr);
            points.push_back({{"engine", p.run.engine},
                              {"settings", p.run.settings},
                              {"step", step_text(p.run)},
                              {"tolerance", p.run.control},
                              {"outcome", name_of(p.outcome)},
                              {"why", p.why},
                              {"cost_ms_per_s", p.cost},
                              {"least_cost_ms_per_s", p.cost_least},
                              {"memory_mb", p.memory},
                              {"repetitions", p.repetitions},
                              {"errors", figures}});
        }
        all.push_back({{"case", r.which.id}, {"title", r.which.title}, {"points", points}, {"notes", r.notes}});
    }
    return all.dump(1) + "\n";
}

std::string summary_of(const std::vector<CaseResult>& results)
{
    std::string out;
    for (const CaseResult& r : results)
    {
        out += "\n## Case " + r.which.id + "\n";
        for (std::size_t m = 0; m < r.which.metrics.size(); ++m) summarize(r, m, out);
        std::string failures;
        tell_failures(r, failures);
        if (!failures.empty()) out += "\nLeft out or failed:\n\n" + failures;
    }
    return out;
}

}  // namespace plab::peers
