#include "study/write.h"

#include <cmath>
#include <filesystem>
#include <memory>

#include "model/exact_text.h"
#include "study/plot/figures.h"

namespace plab::study
{
namespace
{

std::string exact_number(double v) { return model::exact_text(v, ""); }

/// A cell of CSV: in quotes where it has to be.
std::string cell(const std::string& text)
{
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + "\"";
}

struct Closer
{
    void operator()(std::FILE* f) const { std::fclose(f); }
};

std::string row_of(const StudyResult& r, const Point& p)
{
    const RunRecord& x = p.record;
    const auto count = [](const std::optional<std::uint64_t>& n) { return n ? std::to_string(*n) : std::string(); };
    std::string settings, resolved;
    for (const Setting& s : p.combination.settings) settings += (settings.empty() ? "" : " ") + s.text();
    for (const PartFigures& part : x.parts) resolved += (resolved.empty() ? "" : "; ") + part.id + "=" + part.resolved;
    std::string out = cell(p.combination.algorithm) + "," + cell(settings) + "," + exact_number(x.dt) + "," +
                      std::string(name_of(x.outcome)) + "," + cell(x.why) + "," + exact_number(x.reached) + "," + std::to_string(x.steps) +
                      "," + exact_number(p.error()) + "," + exact_number(p.final_error()) + "," + exact_number(digits(p.error())) + "," +
                      (p.is_resolved() ? "1" : "0");
    for (std::size_t k = 0; k < r.quantities.size(); ++k)
    {
        const Distance e = k < p.errors.size() ? p.errors[k] : Distance{NAN, NAN, NAN, NAN};
        out += "," + exact_number(e.series) + "," + exact_number(e.last) + "," + exact_number(e.series_absolute) + "," +
               exact_number(e.last_absolute);
    }
    out += "," + exact_number(p.energy_drift) + "," + exact_number(x.momentum_change) + "," + exact_number(x.angular_momentum_change) +
           "," + exact_number(x.shaft_momentum_change) + "," + exact_number(x.violation) + "," + exact_number(x.penetration) + "," +
           exact_number(x.residual);
    out += "," + (p.contacts.known ? std::to_string(p.contacts.expected) + "," + std::to_string(p.contacts.missed) + "," +
                                         std::to_string(p.contacts.extra) + "," + exact_number(p.contacts.worst_time_error)
                                   : std::string(",,,"));
    out += "," + exact_number(p.cpu_min) + "," + exact_number(p.cpu_median) + "," + exact_number(p.cpu_per_second()) + "," +
           exact_number(p.cpu_per_step());
    out += "," + std::to_string(x.evaluations) + "," + std::to_string(x.trials) + "," + std::to_string(x.rewinds) + "," +
           count(x.allocations) + "," + model::hash_text(x.hash) + "," + cell(x.first_warning) + "," + cell(resolved);
    return out + "\n";
}

}  // namespace

std::string results_csv(const StudyResult& r)
{
    std::string out = "algorithm,settings,dt,outcome,why,reached,steps,error,final_error,digits,resolved_by_reference";
    for (const Quantity& q : r.quantities)
        out += "," + q.name + ":error," + q.name + ":final_error," + q.name + ":absolute," + q.name + ":final_absolute";
    out += ",energy_drift,momentum_change,angular_momentum_change,shaft_momentum_change,violation,penetration,residual";
    out += ",impacts_expected,impacts_missed,impacts_extra,impact_time_error,cpu_min,cpu_median,cpu_per_simulated_second,cpu_per_step";
    out += ",evaluations,trials,rewinds,allocations,hash,first_warning,resolved\n";
    for (const Point& p : r.points) out += row_of(r, p);
    return out;
}

std::string time_series_csv(const StudyResult& r, const std::vector<double>& times, const std::vector<TimeSeries>& time_series)
{
    std::string out = "time";
    for (const Quantity& q : r.quantities)
        for (std::size_t i = 0; i < q.width; ++i) out += "," + q.column(i);
    for (std::size_t n = 0; n < times.size(); ++n)
    {
        out += "\n" + exact_number(times[n]);
        for (const TimeSeries& c : time_series)
            for (std::size_t i = 0; i < c.width; ++i) out += "," + (n < c.samples() ? exact_number(c.at(n)[i]) : std::string());
    }
    return out + "\n";
}

Result<void> write_file(const std::string& path, const std::string& text)
{
    std::unique_ptr<std::FILE, Closer> file(std::fopen(path.c_str(), "w"));
    const bool written = file && std::fwrite(text.data(), 1, text.size(), file.get()) == text.size();
    const bool closed = file && std::fclose(file.release()) == 0;
    return written && closed ? Result<void>() : Result<void>(reason("cannot write " + path));
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
        if (auto written = write_file(folder + "/" + name, text); !written) return written;
    return {};
}

}  // namespace plab::study
