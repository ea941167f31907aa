#include "study/write.h"

#include <cmath>
#include <filesystem>

#include "plab/csv.h"
#include "program/text_out.h"
#include "study/plot.h"

namespace plab::study
{
namespace
{

void add_row(CsvRow& row, const StudyResult& r, const Point& p)
{
    const RunRecord& x = p.record;
    std::string settings, resolved;
    for (const Setting& s : p.combination.settings) settings += (settings.empty() ? "" : " ") + s.text();
    for (const PartFigures& part : x.parts) resolved += (resolved.empty() ? "" : "; ") + part.id + "=" + part.resolved;
    row.text(p.combination.algorithm).text(settings).exact(x.dt).text(name_of(x.outcome)).text(x.why).exact(x.reached).whole(x.steps);
    row.exact(p.error()).exact(p.final_error()).exact(digits(p.error())).whole(p.is_resolved() ? 1 : 0);
    for (std::size_t k = 0; k < r.quantities.size(); ++k)
    {
        const Distance e = k < p.errors.size() ? p.errors[k] : Distance{NAN, NAN, NAN, NAN};
        row.exact(e.series).exact(e.last).exact(e.series_absolute).exact(e.last_absolute);
    }
    row.exact(p.energy_drift).exact(x.momentum_change).exact(x.angular_momentum_change).exact(x.shaft_momentum_change);
    row.exact(x.violation).exact(x.penetration).exact(x.residual);
    const ContactFigures& c = p.contacts;
    (void)(c.known ? row.whole(c.expected).whole(c.missed).whole(c.extra).exact(c.worst_time_error) : row.none(4));
    row.exact(p.cpu_min).exact(p.cpu_median).exact(p.cpu_per_second()).exact(p.cpu_per_step());
    row.whole(x.evaluations).whole(x.trials).whole(x.rewinds);
    (void)(x.allocations ? row.whole(*x.allocations) : row.none());
    row.hexadecimal(x.hash).text(x.first_warning).text(resolved).end();
}

}  // namespace

std::string results_csv(const StudyResult& r)
{
    CsvRow rows;
    rows.put("algorithm,settings,dt,outcome,why,reached,steps,error,final_error,digits,resolved_by_reference");
    for (const Quantity& q : r.quantities)
        for (const char* figure : {":error", ":final_error", ":absolute", ":final_absolute"}) rows.put(q.name + figure);
    rows.put("energy_drift,momentum_change,angular_momentum_change,shaft_momentum_change,violation,penetration,residual");
    rows.put("impacts_expected,impacts_missed,impacts_extra,impact_time_error,cpu_min,cpu_median,cpu_per_simulated_second,cpu_per_step");
    rows.put("evaluations,trials,rewinds,allocations,hash,first_warning,resolved").end();
    for (const Point& p : r.points) add_row(rows, r, p);
    return rows.take();
}

std::string time_series_csv(const StudyResult& r, const std::vector<double>& times, const std::vector<TimeSeries>& time_series)
{
    CsvRow rows;
    rows.put("time");
    for (const Quantity& q : r.quantities)
        for (std::size_t i = 0; i < q.width; ++i) rows.put(q.column(i));
    rows.end();
    for (std::size_t n = 0; n < times.size(); ++n)
    {
        rows.exact(times[n]);
        for (const TimeSeries& c : time_series)
            for (std::size_t i = 0; i < c.width; ++i) (void)(n < c.samples() ? rows.exact(c.at(n)[i]) : rows.none());
        rows.end();
    }
    return rows.take();
}

Result<void> write_all(const StudyResult& r, const std::string& folder)
{
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return reason("cannot make the folder " + folder + ": " + error.message());
    std::vector<std::pair<std::string, std::string>> files{
        {"results.csv", results_csv(r)}, {"results.json", results_json(r)}, {"report.html", report_html(r)}};
    if (r.reference.kind != "none") files.emplace_back("reference.csv", time_series_csv(r, r.reference.times, r.reference.time_series));
    for (const plot::Picture& picture : plot::pictures_of(r))
    {
        files.emplace_back(picture.file + ".svg", picture.drawing.svg(true));
        if (auto written = picture.drawing.write_png(folder + "/" + picture.file + ".png"); !written) return written;
    }
    for (const auto& [name, text] : files)
        if (auto written = program::write_file(folder + "/" + name, text); !written) return written;
    return {};
}

}  // namespace plab::study
