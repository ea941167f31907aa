#include "bench/peers/figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "figures/axes.h"
#include "figures/drawing.h"

namespace plab::peers
{
namespace
{

using figures::Drawing;
using figures::Ink;
using figures::Panel;
using figures::Scale;
using figures::Spot;

constexpr double kWidth = 480, kHeight = 400;                               // px, of a panel with its margins
constexpr double kLeft = 72, kRight = 18, kTop = 34, kBottom = 52;          // px
constexpr double kHead = 40, kFoot = 40;                                    // px
constexpr double kLeastError = 1e-17, kMostError = 1e3, kLeastCost = 1e-6;  // where what is beyond stands

struct EngineStyle
{
    const char* engine;
    const char* text;
    int series;
    int shape;
};
constexpr std::array<EngineStyle, 4> kEngineStyles{
    {{"ode", "ODE", 0, 1}, {"bullet", "Bullet", 2, 2}, {"simbody", "Simbody", 3, 3}, {"plab", "pLab", 5, 0}}};

const EngineStyle& style_of(const std::string& engine)
{
    const auto found =
        std::find_if(kEngineStyles.begin(), kEngineStyles.end(), [&engine](const EngineStyle& l) { return engine == l.engine; });
    return found == kEngineStyles.end() ? kEngineStyles.front() : *found;
}

/// One metric of a case, at its place in the drawing.
class Diagram
{
public:
    Diagram(Drawing& drawing, const CaseResult& result, std::size_t metric, Spot corner)
        : drawing_(&drawing), points_(&result.points), metric_(metric)
    {
        const Metric& m = result.which.metrics[metric];
        panel_.left = corner.x + kLeft, panel_.top = corner.y + kTop;
        panel_.width = kWidth - kLeft - kRight, panel_.height = kHeight - kTop - kBottom;
        std::vector<double> costs, errors;
        for (const Point& p : *points_)
            if (p.counts(metric)) costs.push_back(cost_of(p)), errors.push_back(error_of(p));
        panel_.x = Scale::around(Scale::Kind::Log, costs);
        panel_.y = Scale::around(Scale::Kind::Log, errors);
        drawing.words({corner.x + kLeft, corner.y + kTop - 10}, m.text + (m.unit == "1" ? "" : ", " + m.unit), {13, {Ink::Role::Text}});
        draw_panel(drawing, panel_, "processor time, ms per simulated second", "");
    }
    void draw()
    {
        for (const Point& p : *points_)
            if (p.counts(metric_)) mark(p, false);
        draw_front(false, {Ink::Role::Muted});
        draw_front(true, Ink::series(style_of("plab").series));
    }

private:
    static double cost_of(const Point& p) { return std::fmax(p.cost, kLeastCost); }
    double error_of(const Point& p) const { return std::clamp(p.figures[metric_], kLeastError, kMostError); }
    Spot place_of(const Point& p) const { return panel_.at(cost_of(p), error_of(p)); }
    void mark(const Point& p, bool filled)
    {
        const EngineStyle& style = style_of(p.run.engine);
        drawing_->marker(
            place_of(p), style.shape, filled ? 5 : 3.5, Ink::series(style.series), filled,
            p.run.label() + ": " + figures::short_number(p.figures[metric_]) + " at " + figures::short_number(p.cost) + " ms/s");
    }
    /// A staircase: the least error available at no more cost.
    void draw_front(bool of_plab, const Ink& ink)
    {
        const auto kept = front(*points_, metric_, of_plab);
        if (kept.empty()) return;
        std::vector<Spot> stairs;
        for (const std::size_t i : kept)
        {
            const Spot at = place_of((*points_)[i]);
            if (!stairs.empty()) stairs.push_back({at.x, stairs.back().y});
            stairs.push_back(at);
        }
        stairs.push_back({panel_.right(), stairs.back().y});
        drawing_->line(std::move(stairs), {ink, of_plab ? 2.2 : 1.5, false});
        for (const std::size_t i : kept) mark((*points_)[i], true);
        name_points(kept, of_plab);
    }
    /// Each setting once, at its first point on the front, unless the name would overlap another.
    void name_points(const std::vector<std::size_t>& kept, bool of_plab)
    {
        std::string last;
        double low = -1e9;
        for (const std::size_t i : kept)
        {
            const Point& p = (*points_)[i];
            const std::string name = of_plab ? p.run.settings : std::string(style_of(p.run.engine).text) + " " + p.run.settings;
            const Spot at = place_of(p);
            if (name == last || std::fabs(at.y - low) < 12) continue;
            const bool left = at.x + figures::text_width(name, 10) + 8 > panel_.right();
            const Spot where{at.x + (left ? -8 : 8), at.y + (of_plab ? 12 : -6)};
            drawing_->words(where, name, {10, {Ink::Role::Text}, left ? figures::Anchor::End : figures::Anchor::Start});
            last = name, low = at.y;
        }
    }

    Drawing* drawing_;
    const std::vector<Point>* points_;
    std::size_t metric_;
    Panel panel_;
};

void draw_legend(Drawing& drawing, double y)
{
    double x = kLeft;
    for (const EngineStyle& style : kEngineStyles)
    {
        drawing.marker({x, y - 4}, style.shape, 5, Ink::series(style.series), true);
        drawing.words({x + 10, y}, style.text, {12, {Ink::Role::Text}});
        x += 84;
    }
    drawing.words({x, y}, "lines: least error at no more cost, pLab's and the peers'; hollow: behind", {12, {Ink::Role::Muted}});
}

}  // namespace

bool draw_case(const CaseResult& result, const std::string& path)
{
    const std::size_t n = result.which.metrics.size();
    const double width = kWidth * static_cast<double>(std::clamp<std::size_t>(n, 2, 3));
    const double height = kHead + kHeight * static_cast<double>((n + 2) / 3) + kFoot;
    Drawing drawing(width, height, result.which.title + ": error against processor time, one thread");
    drawing.words({kLeft, 26}, drawing.title(), {16, {Ink::Role::Text}, figures::Anchor::Start, true});
    for (std::size_t m = 0; m < n; ++m)
        Diagram(drawing, result, m, {kWidth * static_cast<double>(m % 3), kHead + kHeight * static_cast<double>(m / 3)}).draw();
    draw_legend(drawing, height - 16);
    std::ofstream svg(path + ".svg", std::ios::binary);
    svg << drawing.svg(true);
    return static_cast<bool>(svg.flush()) && drawing.write_png(path + ".png").ok();
}

}  // namespace plab::peers
