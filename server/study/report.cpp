// report.html: what was studied, the results, and all numbers behind them.
#include <cmath>
#include <set>

#include "figures/axes.h"
#include "figures/page.h"
#include "model/exact_text.h"
#include "model/values.h"
#include "study/plot/figures.h"
#include "study/write.h"

namespace plab::study
{
namespace
{

using figures::Page;
using figures::PageCell;
using figures::short_number;

std::string key_of(double v)
{
    if (!std::isfinite(v)) return "-";
    char text[40];
    std::snprintf(text, sizeof text, "%.9e", v);
    return text;
}

PageCell cell(double v, const std::string& hint = {}) { return {short_number(v), key_of(v), hint}; }

PageCell count(const std::optional<std::uint64_t>& n)
{
    return n ? PageCell{std::to_string(*n), std::to_string(*n), ""} : PageCell{"–", "-", ""};
}

std::string lead_of(const StudyResult& r)
{
    std::set<std::string> lengths;
    for (const Point& p : r.points) lengths.insert(p.combination.dt.empty() ? short_number(p.record.dt) : p.combination.dt);
    std::string quantities;
    for (std::size_t i = 0; i < r.quantities.size(); ++i)
        quantities += (i == 0 ? "" : i + 1 == r.quantities.size() ? " and " : ", ") + r.quantities[i].name;
    const std::size_t algorithms = plot::algorithms_of(r).size();
    return std::to_string(r.points.size()) + " runs of " + r.scene_file + ": " + std::to_string(algorithms) +
           (algorithms == 1 ? " choice" : " choices") + " of algorithms at " + std::to_string(lengths.size()) +
           (lengths.size() == 1 ? " step length" : " step lengths") + ", " + short_number(r.until) +
           " simulated seconds each. Compared: " + quantities + ".";
}

void add_table(Page& page, const StudyResult& r)
{
    page.heading("Every run");
    page.paragraph("Click a column header to sort by it. Errors are the largest of the whole series over all quantities.");
    std::vector<PageCell> head{{"run", "", ""},
                               {"digits", "", "-log10 of the error"},
                               {"error", "", "mixed relative error |y-r|/(a+|r|), attitudes in rad"},
                               {"at the end", "", "the same at the last instant"}};
    for (const Quantity& q : r.quantities) head.push_back({q.name, "", "largest absolute error, " + (q.unit.empty() ? "1" : q.unit)});
    for (const auto& [name, hint] : std::initializer_list<std::pair<const char*, const char*>>{
             {"ms/s", "CPU milliseconds per simulated second, least of the timed runs"},
             {"median", "the same, median"},
             {"µs/step", "CPU microseconds per step, least"},
             {"energy", "drift of energy relative to the largest energy of the run"},
             {"violation", "largest declared error of a constraint"},
             {"overlap", "largest penetration left at the end of a step, m"},
             {"missed", "impacts of the reference that were missed, and impacts that the reference does not have"},
             {"impact t", "largest error of an impact's time, s"},
             {"evaluations", "of forces"},
             {"trials", "trial advances made to locate events"},
             {"allocations",
              "calls of the allocator in warm steps: after a tenth of the run and at least 20 steps, from its start and from each swap"}})
        head.push_back({name, "", hint});
    std::vector<std::vector<PageCell>> rows;
    for (const Point& p : r.points)
    {
        const RunRecord& x = p.record;
        auto& row = rows.emplace_back();
        char d[16];
        std::snprintf(d, sizeof d, "%.1f", digits(p.error()));
        row.push_back({p.combination.label(), "", "state hash " + model::hash_text(x.hash)});
        if (x.ok() && std::isfinite(p.error()))
            row.push_back({(p.is_resolved() || p.error() == 0 ? "" : "≥ ") + std::string(d), key_of(digits(p.error())), ""});
        else
            row.push_back({x.ok() ? "–" : std::string(name_of(x.outcome)), "-", x.why});
        row.push_back(cell(p.error())), row.push_back(cell(p.final_error()));
        for (const Distance& e : p.errors) row.push_back(cell(e.series_absolute, "mixed: " + short_number(e.series)));
        row.push_back(cell(1e3 * p.cpu_per_second())), row.push_back(cell(1e3 * p.cpu_median / x.reached)),
            row.push_back(cell(1e6 * p.cpu_per_step()));
        row.push_back(cell(p.energy_drift)), row.push_back(cell(x.violation)), row.push_back(cell(x.penetration));
        const ContactFigures& c = p.contacts;
        row.push_back(c.known ? PageCell{std::to_string(c.missed) + (c.extra > 0 ? " (+" + std::to_string(c.extra) + ")" : ""),
                                         std::to_string(c.missed), "of " + std::to_string(c.expected)}
                              : PageCell{"–", "-", ""});
        row.push_back(c.known && c.expected > 0 ? cell(c.worst_time_error) : PageCell{"–", "-", ""});
        row.push_back(count(std::optional(x.evaluations))), row.push_back({std::to_string(x.trials), std::to_string(x.trials), ""}),
            row.push_back(count(x.allocations));
    }
    page.table(head, rows);
}

/// The method that a component reported, if it is more than its type.
void add_resolved(Page& page, const StudyResult& r)
{
    std::vector<std::vector<PageCell>> rows;
    std::set<std::string> listed;
    for (const Point& p : r.points)
        for (const PartFigures& part : p.record.parts)
        {
            std::string figures;
            for (const auto& [name, v] : part.largest) figures += (figures.empty() ? "" : ", ") + name + " up to " + short_number(v);
            if ((part.resolved.empty() || part.resolved == part.requested) && figures.empty()) continue;
            if (!listed.insert(p.combination.algorithm + part.id + part.resolved + figures).second) continue;
            rows.push_back(
                {{p.combination.label(), "", ""}, {part.id, "", ""}, {part.requested, "", ""}, {part.resolved, "", ""}, {figures, "", ""}});
        }
    if (rows.empty()) return;
    page.heading("What did the work");
    page.paragraph(
        "Requested and resolved algorithm of each solver, coupling, detection and response, where it is more than the type's name.");
    page.table({{"run", "", ""}, {"component", "", ""}, {"requested", "", ""}, {"resolved", "", ""}, {"largest outputs", "", ""}}, rows);
}

void add_failures(Page& page, const StudyResult& r)
{
    std::vector<std::vector<PageCell>> rows;
    for (const Point& p : r.points)
    {
        std::string warnings;
        for (const auto& [kind, n] : p.record.warnings) warnings += (warnings.empty() ? "" : ", ") + kind + " × " + std::to_string(n);
        if (p.record.ok() && warnings.empty()) continue;
        rows.push_back({{p.combination.label(), "", ""},
                        {std::string(name_of(p.record.outcome)), "", ""},
                        cell(p.record.reached),
                        {p.record.ok() ? p.record.first_warning : p.record.why, "", ""},
                        {warnings, "", ""}});
    }
    if (rows.empty()) return;
    page.heading("Failures and warnings");
    page.table({{"run", "", ""}, {"outcome", "", ""}, {"reached, s", "", ""}, {"why", "", ""}, {"events", "", ""}}, rows);
}

void add_swaps(Page& page, const StudyResult& r)
{
    std::vector<std::vector<PageCell>> rows;
    for (const Point& p : r.points)
        for (const simulation::Reply& reply : p.record.swaps)
        {
            for (const simulation::SwapReport& s : reply.swaps)
                rows.push_back({{p.combination.label(), "", ""},
                                {std::to_string(reply.step), std::to_string(reply.step), ""},
                                {s.id + ": " + s.from + " → " + s.to, "", ""},
                                cell(s.with_new.energy - s.energy_before),
                                cell(s.with_old.energy - s.energy_before),
                                cell(length(s.with_new.momentum - s.with_old.momentum)),
                                cell(1e-3 * reply.pause_ns)});
            if (!reply.done)
                rows.push_back({{p.combination.label(), "", ""},
                                {std::to_string(reply.step), "", ""},
                                {"refused: " + (reply.errors.empty() ? "" : reply.errors.front().text()), "", ""},
                                cell(NAN),
                                cell(NAN),
                                cell(NAN),
                                cell(NAN)});
        }
    if (rows.empty()) return;
    page.heading("Swaps inside the runs");
    page.paragraph(
        "Over the first step after each swap: change of energy with the new component, what the old one would have given, the difference "
        "of "
        "momentum between the two, and the pause.");
    page.table({{"run", "", ""},
                {"step", "", ""},
                {"swap", "", ""},
                {"energy, J", "", ""},
                {"with the old, J", "", ""},
                {"momentum, N s", "", ""},
                {"pause, µs", "", ""}},
               rows);
}

void add_method(Page& page, const StudyResult& r)
{
    page.heading("How it was measured");
    std::vector<std::vector<PageCell>> rows;
    for (std::size_t k = 0; k < r.quantities.size(); ++k)
        rows.push_back({{r.quantities[k].name, "", ""},
                        {r.quantities[k].measure == Measure::Geodesic ? "geodesic angle, rad" : "|y − r| / (a + |r|)", "", ""},
                        r.quantities[k].measure == Measure::Geodesic ? PageCell{"–", "-", ""} : cell(r.reference.scale[k]),
                        cell(r.reference.uncertainty[k].series),
                        cell(r.reference.order[k])});
    page.facts(
        {{"reference", r.reference.words},
         {"timing",
          r.repeat > 0 ? "least and median of " + std::to_string(r.repeat) +
                             " interleaved runs after one that was recorded; CPU time of one thread, steps only, no plotting, no publishing"
                       : "not timed"},
         {"machine", r.machine.processor + "; " + r.machine.system},
         {"build", "plab " + r.machine.version + ", " + r.machine.compiler + ", " + r.machine.flags}});
    for (const std::string& note : r.notes) page.paragraph(note);
    page.table({{"quantity", "", ""},
                {"measure", "", ""},
                {"length a", "", ""},
                {"uncertainty of the reference", "", ""},
                {"its observed order", "", ""}},
               rows);
    page.paragraph("Timings of different machines do not compare; ratios within this page do. To do it again:");
    page.code(r.command);
}

}  // namespace

std::string report_html(const StudyResult& r)
{
    Page page(r.title, lead_of(r));
    const std::vector<std::string> sentences = findings(r);
    if (!sentences.empty()) page.list(sentences);
    page.heading("Pictures");
    for (const plot::Picture& picture : plot::pictures_of(r)) page.figure(picture.drawing, picture.caption);
    add_table(page, r);
    add_failures(page, r);
    add_swaps(page, r);
    add_resolved(page, r);
    add_method(page, r);
    return page.html();
}

}  // namespace plab::study
