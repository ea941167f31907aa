/// The measurements and their output.
#pragma once

#include <string>
#include <vector>

#include "bench/peers/case.h"
#include "bench/peers/measure.h"

namespace plab::peers
{

/// A run with the median of its repetitions.
struct Point
{
    Run run;
    Outcome outcome = Outcome::Done;
    std::string why;
    std::vector<double> figures;  ///< per metric
    double cost = 0;              ///< ms of processor time per simulated second, median
    double cost_least = 0;
    double memory = 0;  ///< MB
    int repetitions = 0;

    bool is_plab() const { return run.engine == "plab"; }
    /// Has a figure to compare in the metric.
    bool counts(std::size_t metric) const;
};

struct CaseResult
{
    Case which;
    std::vector<Point> points;
    std::vector<std::string> notes;
};

/// Below this a figure is rounding: two such figures are equal.
constexpr double kRounding = 1e-15;

std::string csv_of(const std::vector<CaseResult>& results);
std::string json_of(const std::vector<CaseResult>& results);

/// Indices of the points that no other point beats in both cost and error, cheapest first; equal errors (half a percent) count once.
std::vector<std::size_t> front(const std::vector<Point>& points, std::size_t metric, bool of_plab);

/// A table with one line per case and metric: at how many points of the peers' front pLab leads, and where it lags.
std::string overview_of(const std::vector<CaseResult>& results);
/// Per metric, at each point of the peers' front: pLab's least error at no more cost, and by what factor it leads or lags.
std::string summary_of(const std::vector<CaseResult>& results);

}  // namespace plab::peers
