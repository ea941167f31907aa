#include "bench/peers/results.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

namespace plab::peers
{
namespace
{

/// An error has to be less than this share of the one before for a point to be ahead: settings that do the same differ by rounding.
constexpr double kGain = 0.995;
/// A figure too large to count as a result. NaN compares as false as well.
constexpr double kBlownUp = 1e6;

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

}  // namespace plab::peers
