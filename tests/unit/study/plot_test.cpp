// Pictures: scales, ticks, the front, and that the output is well-formed.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "figures/axes.h"
#include "study/plot.h"
#include "study/write.h"
#include "support/text.h"

using namespace plab;
using namespace plab::study;
using namespace plab::figures;
using namespace plab::study::plot;
using plab::test::has;

namespace
{

study::Point point(const std::string& algorithm, const std::string& dt, double error, double cpu)
{
    study::Point p;
    p.combination.algorithm = algorithm, p.combination.dt = dt;
    p.record.dt = 1.0 / std::stod(dt.substr(2)), p.record.reached = 1, p.record.steps = 10;
    p.record.energy.time = {0, 1}, p.record.energy.drift = {0, -error}, p.record.energy.energy = {1, 1 - error}, p.record.energy.scale = 1;
    p.errors = {{error, error, error, error}}, p.resolved = {true}, p.cpu_min = p.cpu_median = cpu, p.energy_drift = error;
    return p;
}

StudyResult sample()
{
    StudyResult r;
    r.title = "A & <B>", r.until = 1, r.repeat = 1;
    r.quantities.resize(1);
    r.quantities[0].name = "ball.position", r.quantities[0].unit = "m";
    r.reference.kind = "exact", r.reference.scale = {1}, r.reference.order = {4}, r.reference.uncertainty = {{1e-9, 1e-9, 1e-9, 1e-9}};
    r.points = {point("Euler", "1/10", 1e-1, 1e-3), point("Euler", "1/20", 5e-2, 2e-3), point("Better", "1/10", 1e-4, 1.5e-3),
                point("Better", "1/20", 6.25e-6, 3e-3), point("Worse", "1/10", 2e-1, 4e-3)};
    r.points.push_back(point("Broken", "1/10", NAN, 1e-3));
    r.points.back().record.outcome = Outcome::NotFinite, r.points.back().record.why = "the state of <ball> was not finite";
    return r;
}

/// Every element that opens closes; attributes are quoted.
bool well_formed(const std::string& xml)
{
    std::vector<std::string> open;
    for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at + 1))
    {
        const std::size_t end = xml.find('>', at);
        if (end == std::string::npos) return false;
        const std::string tag = xml.substr(at + 1, end - at - 1);
        if (tag.empty() || tag[0] == '?' || tag[0] == '!') continue;
        const std::string name = tag.substr(tag[0] == '/' ? 1 : 0, tag.find_first_of(" />\n", 1) - (tag[0] == '/' ? 1 : 0));
        if (tag[0] == '/')
        {
            if (open.empty() || open.back() != tag.substr(1)) return false;
            open.pop_back();
        }
        else if (tag.back() != '/')
            open.push_back(name);
    }
    return open.empty();
}

}  // namespace

TEST_CASE("scales map their ends to 0 and 1, and numbers are short")
{
    const Scale log = Scale::around(Scale::Kind::Log, {1e-6, 1e-2, 0, -1, NAN});
    CHECK(log.low < 1e-6);
    CHECK(log.high > 1e-2);
    CHECK(log.at(log.low) == doctest::Approx(0));
    CHECK(log.at(log.high) == doctest::Approx(1));
    const Scale sym = Scale::around(Scale::Kind::SymLog, {-1e-3, 1e-9, 2});
    CHECK(sym.at(0) > sym.at(-1e-3));
    CHECK(sym.at(1e-9) > sym.at(0));
    CHECK(sym.at(sym.high) == doctest::Approx(1));
    for (const Mark& t : marks_of(log)) CHECK(t.value > 0);
    CHECK(power_of_ten(-12) == "10⁻¹²");
    CHECK(short_number(0.00031) == "3.1·10⁻⁴");
    CHECK(short_number(12.345) == "12.3");
    CHECK(short_number(9.97e-8) == "1.0·10⁻⁷");
    CHECK(short_number(0) == "0");
}

TEST_CASE("the front holds the points that no other point dominates")
{
    const StudyResult r = sample();
    CHECK(pareto_front(r) == std::vector<std::size_t>{0, 2, 3});
    CHECK(algorithms_of(r).size() == 4);
    const std::vector<std::string> reported = findings(r);
    CHECK(has(reported.front(), "Better at 1/20 s is the most accurate"));
    CHECK(std::any_of(reported.begin(), reported.end(), [](const auto& s) { return has(s, "Worse is never the best choice"); }));
    CHECK(std::any_of(reported.begin(), reported.end(), [](const auto& s) { return has(s, "Better 4.0"); }));
    CHECK(
        std::any_of(reported.begin(), reported.end(), [](const auto& s) { return has(s, "One run gave no result (not finite): Broken"); }));
}

TEST_CASE("pictures are well-formed SVG and PNG; the report contains them, without external resources")
{
    const StudyResult r = sample();
    const auto pictures = pictures_of(r);
    REQUIRE(pictures.size() == 4);
    for (const Picture& p : pictures)
    {
        CHECK_MESSAGE(well_formed(p.drawing.svg(true)), p.file);
        CHECK(!has(p.drawing.svg(false), "nan"));
    }
    const std::string file = std::string(PLAB_BINARY_DIR) + "/unit_study_plot.png";
    REQUIRE(pictures[0].drawing.write_png(file, 1).ok());
    std::ifstream png(file, std::ios::binary);
    std::string head(4, ' ');
    png.read(head.data(), 4);
    CHECK(head == "\x89PNG");
    const std::string html = report_html(r);
    CHECK(has(html, "A &amp; &lt;B&gt;"));
    CHECK(has(html, "&lt;ball&gt; was not finite"));
    CHECK(!has(html, "src="));
    CHECK(!has(html, "href=\"http"));
    CHECK(!has(html, "@import"));
    CHECK(has(results_csv(r), "Broken"));
    CHECK(has(results_json(r), "\"outcome\": \"not finite\""));
}

TEST_CASE("a performance profile counts failures as unsolved")
{
    const double never = std::numeric_limits<double>::infinity();
    const Drawing d = performance_profile("profile", {"a", "b"}, {{1, 2}, {never, 1}});
    CHECK(well_formed(d.svg(true)));
}
