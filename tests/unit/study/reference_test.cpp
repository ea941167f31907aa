// The estimate of the solution from three runs: extrapolated if they converge like a method, marked as uncertain if they do not.
#include "study/reference.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "study/study.h"
#include "study/write.h"

using namespace plab::study;

namespace
{

/// Three runs whose values at t = 1 s are given; the solution is known to the caller.
Reference three(double y1, double y2, double y4)
{
    std::vector<RunRecord> runs(3);
    const double last[] = {y1, y2, y4};
    for (std::size_t i = 0; i < 3; ++i)
    {
        Quantity q;
        q.name = "ball.x", q.width = 1;
        runs[i].times = {0, 1}, runs[i].quantities = {q}, runs[i].time_series = {{1, {0, last[i]}}};
    }
    return auto_reference(runs, "Algorithm", "0.1");
}

/// Runs with errors kSmall h^p at h = 1/10, 1/20, 1/40 from the solution 2: so small that mixed errors have their order, too.
constexpr double kSmall = 1e-4;
Reference of_order(double p)
{
    return three(2 + kSmall * std::pow(0.1, p), 2 + kSmall * std::pow(0.05, p), 2 + kSmall * std::pow(0.025, p));
}

double error_of(const Reference& r) { return std::fabs(r.time_series[0].values[1] - 2); }

}  // namespace

TEST_CASE("orders of methods are extrapolated, and the correction is the uncertainty")
{
    for (const double p : {0.91, 0.95, 1.0, 1.1, 1.5, 2.0, 4.0})
    {
        CAPTURE(p);
        const Reference r = of_order(p);
        CHECK(r.converges);
        CHECK(r.order[0] == doctest::Approx(p).epsilon(0.01));
        CHECK(error_of(r) < 0.2 * kSmall * std::pow(0.025, p));
        CHECK(error_of(r) <= r.uncertainty[0].series_absolute);
        CHECK(r.words.find("extrapolated by Richardson") != std::string::npos);
    }
}

TEST_CASE("below order 0.9 nothing is extrapolated: not converged, and an uncertainty that holds")
{
    for (const double p : {0.89, 0.62, 0.5, 0.3, 0.21})
    {
        CAPTURE(p);
        const Reference r = of_order(p);
        CHECK(!r.converges);
        CHECK(!r.converged[0]);
        CHECK(r.time_series[0].values[1] == 2 + kSmall * std::pow(0.025, p));
        // Continued convergence at the observed order ends within the uncertainty; it is no wider, unless the runs differ by more.
        CHECK(r.uncertainty[0].series_absolute >= error_of(r) * (1 - 1e-9));
        const double most = kSmall * (std::pow(0.1, p) - std::pow(0.05, p));
        CHECK(r.uncertainty[0].series_absolute < 1.01 * std::max(error_of(r), most));
        char order[40];
        std::snprintf(order, sizeof order, "(observed order %.2f)", r.order[0]);
        CHECK(r.words.find("not converged, the finest run is used unchanged: ball.x " + std::string(order)) != std::string::npos);
    }
}

TEST_CASE("runs that do not converge get an uncertainty larger than their differences")
{
    for (const auto& [y1, y2, y4] : {std::tuple{2.1, 1.9, 2.1}, {2.1, 2.2, 2.4}, {2.0, 2.001, 2.1}, {2.0, 2.0, 2.1}})
    {
        const Reference r = three(y1, y2, y4);
        const double most = std::max(std::fabs(y1 - y2), std::fabs(y2 - y4));
        CHECK(!r.converges);
        CHECK(r.time_series[0].values[1] == y4);
        CHECK(r.uncertainty[0].series_absolute == doctest::Approx(most / (std::pow(2.0, 0.2) - 1)));
    }
}

TEST_CASE("runs that agree to round-off have converged; runs with an implausible order have not")
{
    const Reference same = three(2, 2 + 4e-16, 2);
    CHECK(same.converges);
    CHECK(std::isnan(same.order[0]));
    const Reference jump = three(2.1, 2, 2);
    CHECK(!jump.converges);
    CHECK(jump.uncertainty[0].series_absolute == doctest::Approx(0.1));
    CHECK(jump.words.find("unchanged: ball.x") != std::string::npos);
}

TEST_CASE("an uncertain reference is reported")
{
    StudyResult r;
    r.reference = of_order(0.62);
    const auto reported = findings(r);
    REQUIRE(reported.size() == 1);
    CHECK(reported[0].starts_with("The reference is uncertain: Algorithm with dt = 0.1 s, halved twice; not converged"));
    CHECK(reported[0].find("0.62") != std::string::npos);
    r.reference = of_order(1);
    CHECK(findings(r).empty());
}
