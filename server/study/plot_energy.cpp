// Energy over time, and the list of all pictures of a study.
#include <algorithm>
#include <cmath>

#include "figures/chart.h"
#include "study/plot.h"

namespace plab::study::plot
{

using namespace figures;

namespace
{

constexpr std::size_t kMostLines = 12;

/// Each algorithm with its longest step that gave a result; more lines would not be readable.
std::vector<const Point*> lines_of(const StudyResult& r)
{
    std::vector<const Point*> out;
    for (const std::string& algorithm : algorithms_of(r))
    {
        const Point* best = nullptr;
        for (const Point& p : r.points)
            if (p.combination.algorithm == algorithm && p.record.ok() && p.record.energy.time.size() > 1 &&
                (!best || p.record.dt > best->record.dt))
                best = &p;
        if (best && out.size() < kMostLines) out.push_back(best);
    }
    return out;
}

}  // namespace

std::optional<Drawing> energy(const StudyResult& r)
{
    Chart chart;
    chart.title = "Unexplained energy", chart.subtitle = r.title, chart.kind = Scale::Kind::SymLog;
    double scale = 0, largest = 0;
    for (const Point* p : lines_of(r))
    {
        const EnergySeries& e = p->record.energy;
        Curve& curve = chart.curves.emplace_back(Curve{p->combination.label(), "drift, J", {}});
        for (std::size_t i = 0; i < e.time.size(); ++i) curve.points.emplace_back(e.time[i], e.drift[i]);
        scale = std::max(scale, e.scale);
        for (const double d : e.drift) largest = std::isfinite(d) ? std::max(largest, std::fabs(d)) : largest;
    }
    // A picture of round-off is meaningless.
    if (largest <= kRoundOff * scale || largest == 0) return {};
    chart.least = 0.1 * kRoundOff * scale;
    return draw(chart);
}

std::vector<Picture> pictures_of(const StudyResult& r)
{
    std::vector<Picture> out;
    if (r.reference.kind != "none")
    {
        out.push_back(
            {"work-precision",
             "Lower left is better. A line is an algorithm of the ladder, its markers are step lengths; the broad grey line is the Pareto "
             "front. Hollow markers lie within the reference's own uncertainty, crosses at the upper edge are runs without a result.",
             work_precision(r)});
        if (auto d = convergence(r))
            out.push_back({"convergence",
                           "Dashed triangles show the observed order of each algorithm, between its two shortest steps above round-off.",
                           std::move(*d)});
    }
    if (auto d = energy(r))
        out.push_back(
            {"energy",
             "Kinetic and stored energy, less the initial energy and less the work of everything that stores none: energy that the methods "
             "created (above 0) "
             "or lost (below). Each algorithm at its longest step that gave a result; of lines that lie upon one another the first is the "
             "broadest.",
             std::move(*d)});
    if (r.reference.kind != "none")
        out.push_back({"digits",
                       "Correct digits, −log₁₀ of the largest error of the whole series; of the worst quantity, where there is a column "
                       "per step length.",
                       digit_map(r)});
    return out;
}

}  // namespace plab::study::plot
