// What a check of levels found: in sentences and as a table.
#include <filesystem>

#include "figures/axes.h"
#include "plab/csv.h"
#include "program/text_out.h"
#include "study/verify.h"

namespace plab::study
{

using figures::short_number;

namespace
{

/// Of estimates: what a viewer would see counts in metres.
std::string unit_of_estimates(const VerifiedGovernor& g) { return g.unit == "pixels" ? "m" : g.unit; }

void tell_estimates(const VerifiedGovernor& g, std::vector<std::string>& out)
{
    const std::string unit = " " + unit_of_estimates(g);
    for (const EstimateSpread& s : spreads_of(g.estimates))
    {
        const std::string name = g.id + ", " + s.level + ": ";
        out.push_back(s.samples == 0 ? name + "its error cannot be told from rounding."
                                     : name + "trial steps tell " + short_number(s.median) + " times the true error (median of " +
                                           std::to_string(s.samples) + " samples; 8 of 10 between " + short_number(s.tenth) + " and " +
                                           short_number(s.nine_tenths) + "), which is " + short_number(s.error) + unit + " in the median.");
    }
}

}  // namespace

std::vector<std::string> verify_findings(const VerifyResult& r)
{
    std::vector<std::string> out;
    for (const VerifiedGovernor& g : r.governors)
    {
        const std::string name = g.id + " (" + g.type + "): ";
        if (g.counted() == 0)
        {
            out.push_back(name + "all components had the most exact level in all intervals" +
                          (g.unit == "pixels" ? " in which a viewer saw them." : "."));
            tell_estimates(g, out);
            continue;
        }
        out.push_back(name + short_number(100 * g.share()) + " % of " + std::to_string(g.counted()) + " intervals of " +
                      short_number(g.interval) + " s have a true error of at most " + short_number(g.bound) + " " + g.unit + " (" +
                      std::to_string(g.components) + " components, " + std::to_string(r.objects) +
                      " moving bodies; the governor states a confidence of " + short_number(g.confidence) + ").");
        const VerifiedLevel& worst = *g.worst();
        out.push_back(name + "the largest error is " + short_number(worst.error) + " " + g.unit + ", of " + worst.component + " with " +
                      worst.level + " in the interval from " + short_number(worst.begin) + " s on.");
        tell_estimates(g, out);
    }
    return out;
}

namespace
{

std::string csv_of(const VerifyResult& r)
{
    CsvRow rows;
    rows.put("governor,type,unit,bound,interval_begin,interval,counted,held,worst_error,worst_component,worst_level");
    rows.end();
    for (const VerifiedGovernor& g : r.governors)
        for (const VerifiedInterval& i : g.intervals)
        {
            rows.text(g.id).text(g.type).text(g.unit).exact(g.bound).exact(i.begin).exact(g.interval);
            rows.exact(static_cast<double>(i.counted)).exact(static_cast<double>(i.held));
            if (i.counted > 0)
                rows.exact(i.worst.error).text(i.worst.component).text(i.worst.level);
            else
                rows.none().none().none();
            rows.end();
        }
    return rows.take();
}

std::string estimates_csv_of(const VerifyResult& r)
{
    CsvRow rows;
    rows.put("governor,level,component,interval_begin,unit,estimate,true_error");
    rows.end();
    for (const VerifiedGovernor& g : r.governors)
        for (const EstimateSample& s : g.estimates)
        {
            rows.text(g.id).text(s.level).text(s.component).exact(s.begin).text(unit_of_estimates(g));
            rows.exact(s.estimate).exact(s.error).end();
        }
    return rows.take();
}

}  // namespace

Result<void> write_verified(const VerifyResult& r, const std::string& folder)
{
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return reason("cannot make the folder " + folder + ": " + error.message());
    if (auto written = program::write_file(folder + "/levels.csv", csv_of(r)); !written) return written;
    return program::write_file(folder + "/estimates.csv", estimates_csv_of(r));
}

}  // namespace plab::study
