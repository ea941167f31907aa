/// Writes the results of a study to its folder: results.csv, results.json, the pictures, report.html.
#pragma once

#include <string>

#include "study/study.h"

namespace plab::study
{

/// One row per combination. Columns are described in server/docs/study.md.
std::string results_csv(const StudyResult& result);
/// The same and more; numbers read back to the same bits, null if unknown.
std::string results_json(const StudyResult& result);
/// The reference's time series as CSV: time and the quantities, to be used as --reference FILE.
std::string time_series_csv(const StudyResult& result, const std::vector<double>& times, const std::vector<TimeSeries>& time_series);
/// One self-contained page: inline pictures, tables, plain words.
std::string report_html(const StudyResult& result);
/// The findings, one sentence each; for the report and the terminal.
std::vector<std::string> findings(const StudyResult& result);

/// Writes everything to a folder, which is created if necessary.
Result<void> write_all(const StudyResult& result, const std::string& folder);

}  // namespace plab::study
