// What a comparison of a governor found: in sentences, as a picture, as files.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "figures/axes.h"
#include "figures/page.h"
#include "plab/csv.h"
#include "program/text_out.h"
#include "study/govern.h"

namespace plab::study
{
namespace
{

using namespace figures;

const Ink kMuted{Ink::Role::Muted, 0, 0, 0, 0};

std::string ms(double seconds) { return short_number(1e3 * seconds) + " ms"; }

std::string figures_of(const GovernPoint& p) { return ms(p.cpu) + " per simulated second, " + short_number(p.error.pixels) + " pixels"; }

/// "below and left of" and "level" in one sentence.
std::string compared(const GovernPoint& governed, const GovernPoint& fixed)
{
    const double cost = fixed.cpu / governed.cpu, error = fixed.error.pixels / governed.error.pixels;
    const std::string name = fixed.name + " for all: ";
    if (cost >= 1 && error >= 1)
        return name + "the governor is " + short_number(cost) + " times as fast and " + short_number(error) + " times as exact.";
    if (cost >= 1)
        return name + "the governor is " + short_number(cost) + " times as fast, and " + short_number(1 / error) + " times less exact.";
    if (error >= 1)
        return name + "the governor takes " + short_number(1 / cost) + " times as long, and is " + short_number(error) + " times as exact.";
    return name + "it is faster, by " + short_number(1 / cost) + ", and more exact, by " + short_number(1 / error) +
           ": the governor loses.";
}

std::string hint_of(const GovernPoint& p, const std::vector<std::string>& levels)
{
    std::string out = p.name + "\n" + figures_of(p) + " (largest " + short_number(p.error.worst_pixels) + ")";
    for (std::size_t k = 0; p.governed && k < p.shares.size(); ++k) out += "\n" + short_number(100 * p.shares[k]) + " % " + levels[k];
    return out;
}

/// The type of a level without its parameters; "most exact levels" as it is.
std::string label_of(const std::string& name) { return name.find('/') < name.find(' ') ? name.substr(0, name.find(' ')) : name; }

/// Exact zeros have no place on a logarithmic axis.
double shown(double pixels, double least) { return std::max(pixels, least); }

}  // namespace

std::vector<std::string> govern_findings(const GovernResult& r)
{
    const GovernPoint& governed = r.points.front();
    std::vector<std::string> out{r.governor + " (" + r.type + "): " + figures_of(governed) + "."};
    for (const GovernPoint& p : r.points)
        if (!p.governed) out.push_back(compared(governed, p));
    const bool has_variants = r.points.size() > 1 && r.points[1].governed;
    for (std::size_t k = 1; k < r.points.size() && has_variants; ++k)
    {
        const GovernPoint& p = r.points[k];
        if (p.governed)
        {
            const auto times = gain(r, p);
            out.push_back(p.name + ": " + figures_of(p) + (times ? ", gain " + short_number(*times) : std::string()) + ".");
        }
        else if (const GovernPoint* better = better_than(r, p))
            out.push_back(p.name + " for all is beaten in both by \"" + better->name + "\": " + short_number(p.cpu / better->cpu) +
                          " times as fast and " + short_number(p.error.pixels / better->error.pixels) + " times as exact.");
        else
            out.push_back(p.name + " for all: no governed run is both faster and more exact.");
    }
    if (const auto times = gain(r))
        out.push_back(*times > 1 ? "The governed point is below and left of the line that joins the single levels: with one level for all, "
                                   "its error would cost " +
                                       short_number(*times) + " times its CPU time."
                                 : "The governed point is not below and left of the line that joins the single levels: with one level for "
                                   "all, its error would cost " +
                                       short_number(*times) + " times its CPU time.");
    if (!governed.error.worst.empty())
        out.push_back("Its largest error: " + short_number(governed.error.worst_pixels) + " pixels, of " + governed.error.worst + " at " +
                      short_number(governed.error.worst_at) + " s, with " + governed.error.worst_level + ".");
    if (r.budget > 0)
        out.push_back("Of 100 steps, 99 took at most " + ms(governed.step_99) + " of a budget of " + ms(r.budget) + " (" +
                      short_number(governed.step_99 / r.budget) + ").");
    return out;
}

Drawing govern_picture(const GovernResult& r)
{
    std::vector<double> costs, errors;
    double least = 1e300;
    for (const GovernPoint& p : r.points)
        if (p.error.pixels > 0) least = std::min(least, p.error.pixels);
    for (const GovernPoint& p : r.points) costs.push_back(1e3 * p.cpu), errors.push_back(shown(p.error.pixels, 0.1 * least));
    const std::string title = "Governed, and one level for all";
    Drawing d(860, 520, title + ": " + r.title);
    Panel p;
    p.left = 84, p.top = 48, p.width = 600, p.height = 410;
    p.x = Scale::around(Scale::Kind::Log, costs), p.y = Scale::around(Scale::Kind::Log, errors);
    d.words({84, 26}, title, {16, {}, Anchor::Start, true, false});
    d.words({84 + text_width(title, 16) * 1.1 + 14, 26}, r.title, {13, kMuted, Anchor::Start, false, false});
    draw_panel(d, p, "CPU time of the whole scene, ms per simulated second", "error in the picture, pixels (root mean square)");
    Labels labels;
    std::vector<Spot> line;
    for (std::size_t k = 1; k < r.points.size(); ++k)
        if (!r.points[k].governed) line.push_back(p.at(costs[k], errors[k]));
    std::sort(line.begin(), line.end(), [](const Spot& a, const Spot& b) { return a.x < b.x; });
    if (line.size() > 1) d.line(line, {kMuted, 1.2, true}, "one level for all");
    for (std::size_t k = 0; k < r.points.size(); ++k) labels.occupy(p.at(costs[k], errors[k]), 6);
    for (std::size_t k = 0; k < r.points.size(); ++k)
    {
        const Spot at = p.at(costs[k], errors[k]);
        const bool governed = r.points[k].governed;
        d.marker(at, governed ? 3 : 0, governed ? 8 : 5.5, Ink::series(governed ? 1 : 0), true, hint_of(r.points[k], r.levels));
        const std::string name = k == 0     ? r.type
                                 : governed ? r.points[k].name.substr(r.points[k].name.find(' ') + 1)
                                            : label_of(r.points[k].name);
        labels.add(d, at, name, 12, {}, governed);
    }
    return d;
}

namespace
{

std::string csv_of(const GovernResult& r)
{
    CsvRow rows;
    rows.put("choice,cpu_per_simulated_second,step_median,step_99,step_longest,error_pixels,worst_pixels,error_metres");
    for (const std::string& level : r.levels) rows.put("share " + level);
    rows.end();
    for (const GovernPoint& p : r.points)
    {
        rows.text(p.name).exact(p.cpu).exact(p.step_median).exact(p.step_99).exact(p.step_longest);
        rows.exact(p.error.pixels).exact(p.error.worst_pixels).exact(p.error.metres);
        for (std::size_t k = 0; k < r.levels.size(); ++k) (void)(p.governed && k < p.shares.size() ? rows.exact(p.shares[k]) : rows.none());
        rows.end();
    }
    return rows.take();
}

/// A line for each step: what it took with each choice, s of CPU time; and of the governed run what was decided before it.
std::string steps_of(const GovernResult& r)
{
    CsvRow rows;
    rows.put("step");
    std::size_t longest = 0;
    for (const GovernPoint& p : r.points) rows.text(p.name), longest = std::max(longest, p.steps.size());
    rows.text("deciding").text("trials").text("exchanged").end();
    for (std::size_t n = 0; n < longest; ++n)
    {
        rows.exact(static_cast<double>(n + 1));
        for (const GovernPoint& p : r.points) (void)(n < p.steps.size() ? rows.exact(p.steps[n].seconds) : rows.none());
        const std::vector<GovernStep>& governed = r.points.front().steps;
        const GovernStep now = n < governed.size() ? governed[n] : GovernStep{};
        rows.exact(now.deciding).exact(static_cast<double>(now.trials)).exact(static_cast<double>(now.exchanged)).end();
    }
    return rows.take();
}

std::string html_of(const GovernResult& r)
{
    Page page("Levels of detail: " + r.title, std::to_string(r.objects) + " bodies, " + std::to_string(r.components) +
                                                  " components under " + r.governor + " (" + r.type + "), " + short_number(r.until) +
                                                  " simulated seconds of " + r.scene_file + ".");
    page.list(govern_findings(r));
    page.figure(govern_picture(r),
                "Error against the run time of the whole scene; the dashed line joins the choices of one level for all.");
    page.paragraph(
        "The error: every " + short_number(r.between) + " s a second simulation continues for " + short_number(r.window) +
        " s from the state of the run, with the most exact level for all and steps " + std::to_string(r.refine) +
        " times shorter. At the end of this time the displacement of each body that a viewer sees (|dp| + r |angle|) counts in pixels "
        "of its picture. Bodies count on which a watched component acts.");
    std::vector<PageCell> head =
        text_cells({"choice", "ms/s", "step, ms", "99 %, ms", "longest, ms", "pixels", "largest", "m, all bodies"});
    for (const std::string& level : r.levels) head.push_back({level, "", "mean share of the components"});
    std::vector<std::vector<PageCell>> rows;
    for (const GovernPoint& p : r.points)
    {
        auto& row = rows.emplace_back();
        row.push_back(text_cell(p.name));
        for (const double seconds : {p.cpu, p.step_median, p.step_99, p.step_longest}) row.push_back(number_cell(1e3 * seconds));
        for (const double error : {p.error.pixels, p.error.worst_pixels, p.error.metres}) row.push_back(number_cell(error));
        for (std::size_t k = 0; k < r.levels.size(); ++k)
            row.push_back(p.governed && k < p.shares.size() ? number_cell(p.shares[k]) : no_cell());
    }
    page.heading("All figures");
    page.table(head, rows);
    page.heading("Again");
    page.code(r.command);
    return page.html();
}

}  // namespace

Result<void> write_govern(const GovernResult& r, const std::string& folder)
{
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return reason("cannot make the folder " + folder + ": " + error.message());
    const Drawing picture = govern_picture(r);
    if (auto written = picture.write_png(folder + "/govern.png"); !written) return written;
    for (const auto& [name, text] : {std::pair("govern.svg", picture.svg(true)), std::pair("govern.csv", csv_of(r)),
                                     std::pair("steps.csv", steps_of(r)), std::pair("report.html", html_of(r))})
        if (auto written = program::write_file(folder + "/" + name, text); !written) return written;
    return {};
}

}  // namespace plab::study
