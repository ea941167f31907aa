// report.html: what was studied, the results, and all numbers behind them.
#include <cmath>
#include <set>

#include "figures/axes.h"
#include "figures/page.h"
#include "model/numbers.h"
#include "model/values.h"
#include "study/plot.h"
#include "study/write.h"

namespace plab::study
{
namespace
{

using figures::no_cell;
using figures::number_cell;
using figures::Page;
using figures::PageCell;
using figures::short_number;
using figures::text_cell;
using figures::text_cells;
using figures::whole_cell;

PageCell count(const std::optional<std::uint64_t>& n) { return n ? whole_cell(*n) : no_cell(); }

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
    page.paragraph(
        "Click a column header to sort by it; what it means appears when the pointer rests on it. `error` and `digits` are of the worst "
        "quantity at its worst moment.");
    std::vector<PageCell> head{{"run", "", ""},
                               {"digits", "", "-log10 of the error"},
                               {"error", "", "mixed relative error |y-r|/(a+|r|), attitudes in rad"},
                               {"at the end", "", "the same at the last instant"}};
    for (const Quantity& q : r.quantities)
        head.push_back({q.name + (q.unit.empty() ? "" : ", " + q.unit), "", "largest absolute error of the whole series"});
    for (const auto& [name, hint] : std::initializer_list<std::pair<const char*, const char*>>{
             {"CPU, ms/s", "CPU milliseconds per simulated second, least of the timed runs"},
             {"median", "the same, median"},
             {"CPU, µs/step", "CPU microseconds per step, least"},
             {"energy drift", "drift of energy relative to the largest energy of the run"},
             {"violation", "largest declared error of a constraint"},
             {"overlap, m", "largest penetration left at the end of a step"},
             {"missed impacts", "impacts of the reference that were missed, and impacts that the reference does not have"},
             {"impact time, s", "largest error of an impact's time"},
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
            row.push_back({(p.is_resolved() || p.error() == 0 ? "" : "≥ ") + std::string(d), number_cell(digits(p.error())).key, ""});
        else
            row.push_back({x.ok() ? "–" : std::string(name_of(x.outcome)), "-", x.why});
        row.push_back(number_cell(p.error())), row.push_back(number_cell(p.final_error()));
        for (const Distance& e : p.errors) row.push_back(number_cell(e.series_absolute, "mixed: " + short_number(e.series)));
        row.push_back(number_cell(1e3 * p.cpu_per_second())), row.push_back(number_cell(1e3 * p.cpu_median / x.reached)),
            row.push_back(number_cell(1e6 * p.cpu_per_step()));
        row.push_back(number_cell(p.energy_drift)), row.push_back(number_cell(x.violation)), row.push_back(number_cell(x.penetration));
        const ContactFigures& c = p.contacts;
        row.push_back(c.known ? PageCell{std::to_string(c.missed) + (c.extra > 0 ? " (+" + std::to_string(c.extra) + ")" : ""),
                                         std::to_string(c.missed), "of " + std::to_string(c.expected)}
                              : no_cell());
        row.push_back(c.known && c.expected > 0 ? number_cell(c.worst_time_error) : no_cell());
        row.push_back(count(std::optional(x.evaluations))), row.push_back(whole_cell(x.trials)), row.push_back(count(x.allocations));
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
            rows.push_back({text_cell(p.combination.label()), text_cell(part.id), text_cell(part.requested), text_cell(part.resolved),
                            text_cell(figures)});
        }
    if (rows.empty()) return;
    page.heading("What did the work");
    page.paragraph(
        "Requested and resolved algorithm of each solver, coupling, detection and response, where it is more than the type's name.");
    page.table(text_cells({"run", "component", "requested", "resolved", "largest outputs"}), rows);
}

void add_failures(Page& page, const StudyResult& r)
{
    std::vector<std::vector<PageCell>> rows;
    for (const Point& p : r.points)
    {
        std::string warnings;
        for (const auto& [kind, n] : p.record.warnings) warnings += (warnings.empty() ? "" : ", ") + kind + " × " + std::to_string(n);
        if (p.record.ok() && warnings.empty()) continue;
        rows.push_back({text_cell(p.combination.label()), text_cell(std::string(name_of(p.record.outcome))), number_cell(p.record.reached),
                        text_cell(p.record.ok() ? p.record.first_warning : p.record.why), text_cell(warnings)});
    }
    if (rows.empty()) return;
    page.heading("Failures and warnings");
    page.table(text_cells({"run", "outcome", "reached, s", "why", "events"}), rows);
}

void add_swaps(Page& page, const StudyResult& r)
{
    std::vector<std::vector<PageCell>> rows;
    for (const Point& p : r.points)
        for (const simulation::Reply& reply : p.record.swaps)
        {
            for (const simulation::SwapReport& s : reply.swaps)
                rows.push_back({text_cell(p.combination.label()), whole_cell(reply.step), text_cell(s.id + ": " + s.from + " → " + s.to),
                                number_cell(s.with_new.energy - s.energy_before), number_cell(s.with_old.energy - s.energy_before),
                                number_cell(length(s.with_new.momentum - s.with_old.momentum)), number_cell(1e-3 * reply.pause_ns)});
            if (!reply.done)
                rows.push_back({text_cell(p.combination.label()), text_cell(std::to_string(reply.step)),
                                text_cell("refused: " + (reply.errors.empty() ? "" : reply.errors.front().text())), number_cell(NAN),
                                number_cell(NAN), number_cell(NAN), number_cell(NAN)});
        }
    if (rows.empty()) return;
    page.heading("Swaps inside the runs");
    page.paragraph(
        "Over the first step after each swap: change of energy with the new component, what the old one would have given, the difference "
        "of "
        "momentum between the two, and the pause.");
    page.table(text_cells({"run", "step", "swap", "energy, J", "with the old, J", "momentum, N s", "pause, µs"}), rows);
}

void add_method(Page& page, const StudyResult& r)
{
    page.heading("How it was measured");
    std::vector<std::vector<PageCell>> rows;
    for (std::size_t k = 0; k < r.quantities.size(); ++k)
        rows.push_back({text_cell(r.quantities[k].name),
                        text_cell(r.quantities[k].measure == Measure::Geodesic ? "geodesic angle, rad" : "|y − r| / (a + |r|)"),
                        r.quantities[k].measure == Measure::Geodesic ? no_cell() : number_cell(r.reference.scale[k]),
                        number_cell(r.reference.uncertainty[k].series), number_cell(r.reference.order[k])});
    page.facts(
        {{"reference", r.reference.words},
         {"timing",
          r.repeat > 0 ? "least and median of " + std::to_string(r.repeat) +
                             " interleaved runs after one that was recorded; CPU time of one thread, steps only, no plotting, no publishing"
                       : "not timed"},
         {"machine", r.machine.processor + "; " + r.machine.system},
         {"build", "plab " + r.machine.version + ", " + r.machine.compiler + ", " + r.machine.flags}});
    for (const std::string& note : r.notes) page.paragraph(note);
    page.table(text_cells({"quantity", "measure", "length a", "uncertainty of the reference", "its observed order"}), rows);
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
