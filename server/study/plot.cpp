#include "study/plot.h"

#include <algorithm>
#include <cmath>

#include "figures/axes.h"

namespace plab::study::plot
{

using namespace figures;

namespace
{

const Ink kMuted{Ink::Role::Muted, 0, 0, 0, 0};
constexpr double kWidth = 860, kHeight = 520;

Ink ink_of(std::size_t algorithm) { return Ink::series(static_cast<int>(algorithm)); }
int shape_of(std::size_t algorithm) { return static_cast<int>(algorithm % Drawing::kMarkers); }

/// For a failed run, the error until the failure is not comparable.
double error_of(const Point& p) { return p.record.ok() ? p.error() : std::nan(""); }
double shown(double error) { return std::isnan(error) ? error : std::max(error, kLeastError); }
double milliseconds(const Point& p) { return 1e3 * p.cpu_per_second(); }

std::size_t algorithm_index(const std::vector<std::string>& algorithms, const Point& p)
{
    return static_cast<std::size_t>(std::find(algorithms.begin(), algorithms.end(), p.combination.algorithm) - algorithms.begin());
}

/// The panel beside a legend of these names.
Panel panel_beside(double widest, const Scale& x, const Scale& y)
{
    Panel p;
    p.left = 84, p.top = 48, p.x = x, p.y = y;
    p.width = kWidth - p.left - std::min(widest, 300.0) - 56, p.height = kHeight - p.top - 62;
    return p;
}

double widest(const std::vector<std::string>& names)
{
    double out = 60;
    for (const std::string& n : names) out = std::max(out, text_width(n, 12));
    return out;
}

void draw_legend(Drawing& d, const Panel& p, const std::vector<std::string>& algorithms)
{
    double y = p.top + 8;
    for (std::size_t i = 0; i < algorithms.size() && y < p.bottom(); ++i, y += 20)
    {
        d.line({{p.right() + 16, y}, {p.right() + 36, y}}, {ink_of(i), 1.5, i >= Ink::kSeries});
        d.marker({p.right() + 26, y}, shape_of(i), 4.5, ink_of(i), true);
        d.words({p.right() + 42, y + 4}, algorithms[i], {12, {}, Anchor::Start, false, false});
    }
}

void draw_title(Drawing& d, const std::string& title, const std::string& scene)
{
    d.words({84, 26}, title, {16, {}, Anchor::Start, true, false});
    d.words({84 + text_width(title, 16) * 1.1 + 14, 26}, scene, {13, kMuted, Anchor::Start, false, false});
}

double uncertainty_of(const StudyResult& r)
{
    double out = 0;
    for (const Distance& u : r.reference.uncertainty) out = std::isnan(u.series) ? out : std::max(out, u.series);
    return out;
}

/// Errors in this region are errors of the reference as well.
void draw_unresolved(Drawing& d, const Panel& p, double uncertainty, Labels& labels)
{
    if (!(uncertainty > p.y.low)) return;
    const double y = p.at(p.x.low, std::min(uncertainty, p.y.high)).y;
    // Over the grid, inside the frame.
    d.box({p.left + 1, y}, p.width - 1, p.bottom() - y - 1, {Ink::Role::Shade, 0, 0, 0, 0}, "the reference is not known better than this");
    const std::string text = "below " + short_number(uncertainty) + ": not resolved by the reference";
    d.words({p.left + 8, p.bottom() - 8}, text, {11, kMuted, Anchor::Start, false, false});
    labels.occupy(p.left, p.bottom() - 20, p.left + 16 + text_width(text, 11), p.bottom());
}

std::string hint_of(const StudyResult& r, const Point& p)
{
    std::string out = p.combination.label() + "\nerror " + short_number(p.error()) + ", at the end " + short_number(p.final_error());
    out += "\n" + short_number(milliseconds(p)) + " ms per simulated second";
    for (std::size_t k = 0; k < r.quantities.size(); ++k)
        out += "\n" + r.quantities[k].name + ": " + short_number(p.errors[k].series_absolute) + " " + r.quantities[k].unit;
    return out;
}

void draw_front(Drawing& d, const Panel& p, const StudyResult& r)
{
    const std::vector<std::size_t> front = pareto_front(r);
    std::vector<Spot> steps;
    for (const std::size_t i : front)
    {
        const Spot at = p.at(milliseconds(r.points[i]), shown(r.points[i].error()));
        if (!steps.empty()) steps.push_back({at.x, steps.back().y});
        steps.push_back(at);
    }
    if (!steps.empty()) steps.push_back({p.right(), steps.back().y});
    if (steps.size() > 1) d.line(std::move(steps), {{Ink::Role::Front, 0, 0, 0, 0}, 5, false}, "Pareto front: no other is better in both");
}

/// The points of an algorithm in a diagram, the longest step first.
struct Series
{
    std::vector<const Point*> points;
    std::vector<Spot> spots;
};

/// Of the series after `k`: how many have a point here too. They are drawn over this one.
std::size_t covers(const std::vector<Series>& series, std::size_t k, Spot at)
{
    constexpr double kSame = 4;  // px
    const auto is_here = [&](const Spot& other) { return std::hypot(other.x - at.x, other.y - at.y) < kSame; };
    return static_cast<std::size_t>(std::count_if(series.begin() + static_cast<std::ptrdiff_t>(k) + 1, series.end(),
                                                  [&](const Series& s) { return std::any_of(s.spots.begin(), s.spots.end(), is_here); }));
}

Series series_of(const Panel& p, const StudyResult& r, const std::string& algorithm, double (*x_of)(const Point&))
{
    Series out;
    for (const Point& q : r.points)
        if (q.combination.algorithm == algorithm && std::isfinite(error_of(q)) && std::isfinite(x_of(q)) && x_of(q) > 0)
            out.points.push_back(&q);
    std::stable_sort(out.points.begin(), out.points.end(), [](const Point* a, const Point* b) { return a->record.dt > b->record.dt; });
    for (const Point* q : out.points) out.spots.push_back(p.at(x_of(*q), shown(error_of(*q))));
    return out;
}

/// Points of each algorithm, joined in the order of their step lengths; those are named where `labels` has room. What others cover is
/// drawn larger, so that it is seen around them.
void draw_series(Drawing& d, const Panel& p, const StudyResult& r, const std::vector<std::string>& algorithms, double (*x_of)(const Point&),
                 Labels* labels)
{
    constexpr std::size_t kMostAround = 4;
    std::vector<Series> series;
    for (const std::string& algorithm : algorithms) series.push_back(series_of(p, r, algorithm, x_of));
    for (std::size_t k = 0; k < series.size(); ++k)
    {
        const Series& s = series[k];
        std::vector<double> around;
        for (const Spot& at : s.spots) around.push_back(static_cast<double>(std::min(covers(series, k, at), kMostAround)));
        const double width = around.empty() ? 0 : *std::min_element(around.begin(), around.end());
        if (s.spots.size() > 1) d.line(s.spots, {ink_of(k), 1.5 + 2.5 * width, k >= Ink::kSeries});
        for (std::size_t i = 0; i < s.spots.size(); ++i)
            d.marker(s.spots[i], shape_of(k), 5.5 + 3.5 * around[i], ink_of(k), s.points[i]->is_resolved(), hint_of(r, *s.points[i]));
    }
    if (!labels) return;
    for (const Series& s : series)
        for (const Spot& at : s.spots) labels->occupy(at, 5);
    for (const Series& s : series)
        for (std::size_t i = 0; i < s.spots.size(); ++i)
            if (const std::string& dt = s.points[i]->combination.dt; !dt.empty()) labels->add(d, s.spots[i], dt);
}

/// Runs that have a cost but no error are drawn at the upper edge.
void draw_failures(Drawing& d, const Panel& p, const StudyResult& r, const std::vector<std::string>& algorithms,
                   double (*x_of)(const Point&))
{
    for (const Point& q : r.points)
    {
        if (std::isfinite(error_of(q)) || !(x_of(q) > 0) || !std::isfinite(x_of(q))) continue;
        const Spot at{p.at(x_of(q), p.y.low).x, p.top + 8};
        const Ink ink = ink_of(algorithm_index(algorithms, q));
        const std::string hint = q.combination.label() + ": " + std::string(name_of(q.record.outcome)) + "\n" + q.record.why;
        d.line({{at.x - 5, at.y - 5}, {at.x + 5, at.y + 5}}, {ink, 2, false}, hint);
        d.line({{at.x - 5, at.y + 5}, {at.x + 5, at.y - 5}}, {ink, 2, false}, hint);
    }
}

double step_of(const Point& p) { return p.record.dt; }

/// Errors of an algorithm by step length, shortest first.
std::vector<std::pair<double, double>> errors_by_step(const StudyResult& r, const std::string& algorithm)
{
    const double floor = 10 * std::max(kRoundOff, uncertainty_of(r));
    std::vector<std::pair<double, double>> out;
    for (const Point& q : r.points)
        if (q.combination.algorithm == algorithm && q.error() > floor && std::isfinite(error_of(q)))
            out.emplace_back(q.record.dt, q.error());
    std::sort(out.begin(), out.end());
    return out;
}

bool near(const std::pair<double, double>& a, const std::pair<double, double>& b)
{
    return a.first == b.first && std::fabs(std::log(a.second / b.second)) < 0.1;
}

/// The step lengths as they were written, where there are few; else none.
std::vector<Mark> step_marks(const StudyResult& r, const Scale& x)
{
    constexpr std::size_t kMost = 8;
    std::vector<Mark> out;
    for (const Point& q : r.points)
    {
        const bool there =
            std::any_of(out.begin(), out.end(), [&](const Mark& m) { return std::fabs(x.at(m.value) - x.at(q.record.dt)) < 0.05; });
        if (q.combination.dt.empty() || q.record.dt <= 0) return {};
        if (!there) out.push_back({q.record.dt, q.combination.dt});
    }
    return out.size() <= kMost ? out : std::vector<Mark>();
}

/// A right triangle below the two shortest steps of an algorithm that are above round-off, with the observed slope.
void draw_slope(Drawing& d, const Panel& p, const std::vector<std::pair<double, double>>& e, Ink ink, Labels& labels)
{
    const double slope = std::log(e[1].second / e[0].second) / std::log(e[1].first / e[0].first);
    // A smaller slope is not an order: such errors are bounded by a tolerance.
    if (!(slope > 0.7) || slope > 12) return;
    const double x0 = e[0].first, x1 = e[1].first, y0 = e[0].second / 1.6;
    const double y1 = y0 * std::pow(x1 / x0, slope);
    if (y0 < p.y.low || y1 > p.y.high) return;
    d.line({p.at(x0, y0), p.at(x1, y0), p.at(x1, y1), p.at(x0, y0)}, {ink, 1, true},
           "slope between the two shortest steps above round-off");
    char text[16];
    std::snprintf(text, sizeof text, "%.2f", slope);
    labels.add(d, p.at(x1, std::sqrt(y0 * y1)), text, 12, ink, true);
}

}  // namespace

std::vector<std::string> algorithms_of(const StudyResult& r)
{
    std::vector<std::string> out;
    for (const Point& p : r.points)
        if (std::find(out.begin(), out.end(), p.combination.algorithm) == out.end()) out.push_back(p.combination.algorithm);
    return out;
}

std::vector<std::size_t> pareto_front(const StudyResult& r)
{
    // Below round-off, or the resolution of the reference, no algorithm is better than another.
    const double floor = std::max(kRoundOff, uncertainty_of(r));
    const auto shown_error = [&](const Point& p) { return std::max(p.error(), floor); };
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < r.points.size(); ++i)
        if (r.points[i].record.ok() && std::isfinite(r.points[i].error()) && r.points[i].cpu_per_second() > 0) order.push_back(i);
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b)
              {
                  const Point &x = r.points[a], &y = r.points[b];
                  return std::pair(x.cpu_per_second(), shown_error(x)) < std::pair(y.cpu_per_second(), shown_error(y));
              });
    std::vector<std::size_t> out;
    for (const std::size_t i : order)
        if (out.empty() || shown_error(r.points[i]) < shown_error(r.points[out.back()])) out.push_back(i);
    return out;
}

Drawing work_precision(const StudyResult& r)
{
    std::vector<double> costs, errors;
    for (const Point& q : r.points)
        if (q.cpu_per_second() > 0) costs.push_back(milliseconds(q)), errors.push_back(shown(error_of(q)));
    const std::vector<std::string> algorithms = algorithms_of(r);
    Drawing d(kWidth, kHeight, "Error against CPU time: " + r.title);
    Panel p = panel_beside(widest(algorithms), Scale::around(Scale::Kind::Log, costs), Scale::around(Scale::Kind::Log, errors));
    draw_title(d, "Error against CPU time", r.title);
    Labels labels;
    draw_panel(d, p, "CPU time, ms per simulated second", "largest error, whole series");
    draw_unresolved(d, p, uncertainty_of(r), labels);
    draw_front(d, p, r);
    draw_series(d, p, r, algorithms, &milliseconds, &labels);
    draw_failures(d, p, r, algorithms, &milliseconds);
    draw_legend(d, p, algorithms);
    return d;
}

std::optional<Drawing> convergence(const StudyResult& r)
{
    std::vector<double> steps, errors;
    for (const Point& q : r.points)
        if (std::isfinite(error_of(q))) steps.push_back(q.record.dt), errors.push_back(shown(error_of(q)));
    if (steps.empty() || std::all_of(steps.begin(), steps.end(), [&](double s) { return s == steps.front(); })) return {};
    const std::vector<std::string> algorithms = algorithms_of(r);
    Drawing d(kWidth, kHeight, "Error against step length: " + r.title);
    Panel p = panel_beside(widest(algorithms), Scale::around(Scale::Kind::Log, steps), Scale::around(Scale::Kind::Log, errors));
    draw_title(d, "Error against step length", r.title);
    p.x_marks = step_marks(r, p.x);
    Labels labels;
    draw_panel(d, p, "step length, s", "largest error, whole series");
    draw_unresolved(d, p, uncertainty_of(r), labels);
    std::vector<std::pair<double, double>> drawn;
    for (const Point& q : r.points)
        if (std::isfinite(error_of(q))) labels.occupy(p.at(q.record.dt, shown(error_of(q))), 5);
    for (std::size_t k = 0; k < algorithms.size(); ++k)
    {
        const auto e = errors_by_step(r, algorithms[k]);
        // Algorithms whose lines coincide share a triangle.
        if (e.size() < 2 || std::any_of(drawn.begin(), drawn.end(), [&](const auto& other) { return near(other, e[0]); })) continue;
        draw_slope(d, p, e, ink_of(k), labels);
        drawn.push_back(e[0]);
    }
    draw_series(d, p, r, algorithms, &step_of, nullptr);
    draw_failures(d, p, r, algorithms, &step_of);
    draw_legend(d, p, algorithms);
    return d;
}

}  // namespace plab::study::plot
