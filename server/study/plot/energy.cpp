// Energy over time, and what is made of all pictures of a study.
#include <algorithm>
#include <cmath>

#include "study/plot/axes.h"
#include "study/plot/figures.h"

namespace plab::study::plot
{
namespace
{

constexpr std::size_t kMostLines = 12;

/// Each rung with its longest step that gave a result; more lines than that nobody can read.
std::vector<const Point*> lines_of(const StudyResult& r)
{
    std::vector<const Point*> out;
    for (const std::string& rung : rungs_of(r))
    {
        const Point* best = nullptr;
        for (const Point& p : r.points)
            if (p.combination.rung == rung && p.record.ok() && p.record.energy.time.size() > 1 && (!best || p.record.dt > best->record.dt))
                best = &p;
        if (best && out.size() < kMostLines) out.push_back(best);
    }
    return out;
}

}  // namespace

std::optional<Drawing> energy(const StudyResult& r)
{
    const std::vector<const Point*> lines = lines_of(r);
    std::vector<double> times, drifts;
    std::vector<std::string> names;
    for (const Point* p : lines)
    {
        names.push_back(p->combination.label());
        const EnergySeries& e = p->record.energy;
        for (std::size_t i = 0; i < e.time.size(); ++i)
            if (std::isfinite(e.drift[i])) times.push_back(e.time[i]), drifts.push_back(e.drift[i]);
    }
    double scale = 0, largest = 0;
    for (const Point* p : lines) scale = std::max(scale, p->record.energy.scale);
    for (const double d : drifts) largest = std::max(largest, std::fabs(d));
    // A picture of round-off says nothing.
    if (largest <= kRoundOff * scale || largest == 0) return {};
    Drawing d(860, 520, "Energy over time: " + r.title);
    double legend = 60;
    for (const std::string& n : names) legend = std::max(legend, text_width(n, 12));
    Panel p;
    p.left = 96, p.top = 48, p.width = 860 - 96 - std::min(legend, 300.0) - 56, p.height = 410;
    p.x = Scale::around(Scale::Kind::Linear, times), p.y = Scale::around(Scale::Kind::SymLog, drifts);
    p.x.low = 0, p.y.threshold = std::max(p.y.threshold, 0.1 * kRoundOff * scale);
    d.words({96, 26}, "Energy that nobody put in", {16, {}, Anchor::Start, true, false});
    d.words({96 + text_width("Energy that nobody put in", 16) * 1.1 + 14, 26}, r.title,
            {13, {Ink::Role::Muted, 0, 0, 0, 0}, Anchor::Start, false, false});
    draw_panel(d, p, "time, s", "drift, J");
    for (std::size_t k = 0; k < lines.size(); ++k)
    {
        const EnergySeries& e = lines[k]->record.energy;
        std::vector<Spot> line;
        for (std::size_t i = 0; i < e.time.size(); ++i)
            if (std::isfinite(e.drift[i])) line.push_back(p.at(e.time[i], e.drift[i]));
        // The first are the broadest, so that lines that lie upon one another can all be seen.
        const double width = 1.6 + 0.5 * static_cast<double>(std::min<std::size_t>(lines.size() - 1 - k, 6));
        d.line(std::move(line), {Ink::series(static_cast<int>(k)), width, k >= Ink::kSeries}, names[k]);
        const double y = p.top + 8 + 20.0 * static_cast<double>(k);
        d.line({{p.right() + 16, y}, {p.right() + 36, y}}, {Ink::series(static_cast<int>(k)), 2.5, k >= Ink::kSeries});
        d.words({p.right() + 42, y + 4}, names[k], {12, {}, Anchor::Start, false, false});
    }
    return d;
}

std::vector<Picture> pictures_of(const StudyResult& r)
{
    std::vector<Picture> out;
    if (r.reference.kind != "none")
    {
        out.push_back(
            {"work-precision",
             "Lower left is better. A line is a rung of the ladder, its markers are step lengths; the broad grey line is the Pareto "
             "front. Hollow markers lie within the reference's own uncertainty, crosses at the upper edge are runs without a result.",
             work_precision(r)});
        if (auto d = convergence(r))
            out.push_back({"convergence",
                           "Dashed triangles show the observed order of each rung, between its two shortest steps above round-off.",
                           std::move(*d)});
    }
    if (auto d = energy(r))
        out.push_back(
            {"energy",
             "Kinetic and stored energy, less the start's and less the work of whatever stores none: what the methods made up (above 0) "
             "or lost (below). Each rung at its longest step that gave a result; of lines that lie upon one another the first is the "
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
