#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "figures/axes.h"
#include "study/plot.h"

namespace plab::study::plot
{

using namespace figures;

namespace
{

constexpr double kMostDigits = 15;

/// Cividis (Nunez, Anderton, Renslow 2018): the same to readers with and without colour vision.
Ink color_of(double digits)
{
    constexpr std::array<std::array<double, 3>, 6> stops{
        {{0, 34, 78}, {53, 69, 108}, {102, 105, 112}, {148, 142, 119}, {200, 184, 102}, {254, 232, 56}}};
    const double at = std::clamp(digits / kMostDigits, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(at), stops.size() - 2);
    const double f = at - static_cast<double>(i);
    const auto mix = [&](std::size_t c)
    { return static_cast<std::uint8_t>(std::lround(stops[i][c] + f * (stops[i + 1][c] - stops[i][c]))); };
    return Ink::rgb(mix(0), mix(1), mix(2));
}

double longest(const std::vector<std::string>& texts, double size)
{
    double out = 0;
    for (const std::string& t : texts) out = std::max(out, text_width(t, size));
    return out;
}

}  // namespace

Drawing heat_map(const std::string& title, const std::vector<std::string>& rows, const std::vector<std::string>& columns,
                 const std::vector<std::vector<Cell>>& cells)
{
    const double left = 30 + std::min(longest(rows, 12), 380.0), cell_height = 26;
    const double cell_width = std::clamp(longest(columns, 12) + 16, 74.0, 170.0);
    const bool tilted = longest(columns, 12) + 10 > cell_width;
    const double top = tilted ? 56 + std::min(longest(columns, 12), 260.0) : 76;
    Drawing d(std::max(left + cell_width * static_cast<double>(columns.size()) + 30, 420.0),
              top + cell_height * static_cast<double>(rows.size()) + 24, title);
    d.words({16, 26}, title, {16, {}, Anchor::Start, true, false});
    for (std::size_t c = 0; c < columns.size(); ++c)
    {
        const double x = left + cell_width * (static_cast<double>(c) + 0.5);
        d.words({tilted ? x + 4 : x, top - 8}, columns[c], {12, {}, tilted ? Anchor::Start : Anchor::Middle, false, tilted});
    }
    for (std::size_t r = 0; r < rows.size(); ++r)
    {
        const double y = top + cell_height * static_cast<double>(r);
        d.words({left - 10, y + 17}, rows[r], {12, {}, Anchor::End, false, false});
        for (std::size_t c = 0; c < columns.size(); ++c)
        {
            const Cell& cell = cells[r][c];
            const double x = left + cell_width * static_cast<double>(c);
            const bool known = !std::isnan(cell.digits);
            d.box({x + 1, y + 1}, cell_width - 2, cell_height - 2, known ? color_of(cell.digits) : Ink{Ink::Role::Grid, 0, 0, 0, 0},
                  cell.hint);
            char text[16];
            std::snprintf(text, sizeof text, "%.1f", cell.digits);
            const Ink ink = !known                             ? Ink{Ink::Role::Muted, 0, 0, 0, 0}
                            : cell.digits < 0.55 * kMostDigits ? Ink::rgb(255, 255, 255)
                                                               : Ink::rgb(20, 20, 20);
            d.words({x + cell_width / 2, y + 17}, known ? (cell.word.empty() ? text : cell.word) : cell.word,
                    {12, ink, Anchor::Middle, false, false});
        }
    }
    return d;
}

namespace
{

Cell cell_of(const StudyResult& r, const study::Point& p, double error, const std::string& what)
{
    if (!p.record.ok()) return {std::nan(""), std::string(name_of(p.record.outcome)), p.record.why};
    std::string hint = p.combination.label() + ", " + what + ": error " + short_number(error);
    for (std::size_t k = 0; k < r.quantities.size() && k < p.errors.size(); ++k)
        hint += "\n" + r.quantities[k].name + ": " + short_number(p.errors[k].series_absolute) + " " + r.quantities[k].unit;
    return {digits(error), "", hint};
}

/// The place of a text among the others; at the end if it is new.
std::size_t place_of(std::vector<std::string>& all, const std::string& text)
{
    const auto found = std::find(all.begin(), all.end(), text);
    if (found == all.end()) return all.push_back(text), all.size() - 1;
    return static_cast<std::size_t>(found - all.begin());
}

/// Algorithms by step lengths: of the worst quantity.
Drawing by_step(const StudyResult& r)
{
    std::vector<std::string> rows, columns;
    for (const study::Point& p : r.points) place_of(rows, p.combination.algorithm), place_of(columns, p.combination.dt + " s");
    std::vector<std::vector<Cell>> cells(rows.size(), std::vector<Cell>(columns.size(), Cell{std::nan(""), "", "not run"}));
    for (const study::Point& p : r.points)
        cells[place_of(rows, p.combination.algorithm)][place_of(columns, p.combination.dt + " s")] = cell_of(r, p, p.error(), "worst");
    return heat_map("Correct digits: " + r.title, rows, columns, cells);
}

}  // namespace

Drawing digit_map(const StudyResult& r)
{
    std::set<std::string> lengths;
    for (const study::Point& p : r.points) lengths.insert(p.combination.dt);
    if (lengths.size() > 1 && lengths.count("") == 0) return by_step(r);
    std::vector<std::string> rows, columns;
    for (const Quantity& q : r.quantities) columns.push_back(q.name);
    std::vector<std::vector<Cell>> cells;
    for (const study::Point& p : r.points)
    {
        rows.push_back(p.combination.label());
        std::vector<Cell>& row = cells.emplace_back();
        for (std::size_t k = 0; k < columns.size(); ++k)
            row.push_back(cell_of(r, p, k < p.errors.size() ? p.errors[k].series : std::nan(""), columns[k]));
    }
    return heat_map("Correct digits: " + r.title, rows, columns, cells);
}

Drawing performance_profile(const std::string& title, const std::vector<std::string>& solvers, const std::vector<std::vector<double>>& cost)
{
    // ratio[s]: cost over the best cost of each problem, ascending.
    std::vector<std::vector<double>> ratios(solvers.size());
    double widest = 10;
    for (const std::vector<double>& problem : cost)
    {
        const double best = *std::min_element(problem.begin(), problem.end());
        for (std::size_t s = 0; s < solvers.size(); ++s)
            if (std::isfinite(problem[s]) && best > 0) ratios[s].push_back(problem[s] / best), widest = std::max(widest, problem[s] / best);
    }
    Drawing d(860, 480, title);
    Panel p;
    p.left = 84, p.top = 48, p.width = 860 - 84 - std::min(longest(solvers, 12), 300.0) - 56, p.height = 370;
    p.x.kind = Scale::Kind::Log, p.x.low = 1, p.x.high = widest * 1.5, p.y.low = 0, p.y.high = 1.03;
    d.words({84, 26}, title, {16, {}, Anchor::Start, true, false});
    draw_panel(d, p, "cost, as a multiple of the cheapest that reaches the tolerance", "share of problems solved");
    for (std::size_t s = 0; s < solvers.size(); ++s)
    {
        std::sort(ratios[s].begin(), ratios[s].end());
        std::vector<Spot> line{p.at(1, 0)};
        for (std::size_t i = 0; i < ratios[s].size(); ++i)
        {
            const double share = static_cast<double>(i + 1) / static_cast<double>(cost.size());
            line.push_back({p.at(ratios[s][i], 0).x, line.back().y});
            line.push_back(p.at(ratios[s][i], share));
        }
        line.push_back({p.right(), line.back().y});
        const Ink ink = Ink::series(static_cast<int>(s));
        d.line(std::move(line), {ink, 2, s >= Ink::kSeries}, solvers[s]);
        const double y = p.top + 8 + 20.0 * static_cast<double>(s);
        d.line({{p.right() + 16, y}, {p.right() + 36, y}}, {ink, 2.5, s >= Ink::kSeries});
        d.words({p.right() + 42, y + 4}, solvers[s], {12, {}, Anchor::Start, false, false});
    }
    return d;
}

}  // namespace plab::study::plot
