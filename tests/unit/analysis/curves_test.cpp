// Quantities by name, as functions of time.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>

#include "control/recording/analysis/curves.h"
#include "made_recording.h"

using namespace plab;
using namespace plab::analysis;
using namespace plab::test;

namespace
{

Log opened(const std::string& path)
{
    auto log = Log::open(path);
    REQUIRE(log.ok());
    return log.take();
}

std::vector<figures::Curve> curves(const Log& log, const std::string& quantity, const Span& span = {})
{
    auto parsed = parse_signal(quantity, log.things());
    REQUIRE_MESSAGE(parsed.ok(), parsed.error().text());
    return curves_of(log, *parsed, span);
}

/// The value at a time, interpolated between the neighbouring points.
double value_at(const figures::Curve& curve, double time)
{
    for (std::size_t i = 1; i < curve.points.size(); ++i)
    {
        const auto& [t0, v0] = curve.points[i - 1];
        const auto& [t1, v1] = curve.points[i];
        if (t0 <= time && time <= t1 && t1 > t0) return v0 + (v1 - v0) * (time - t0) / (t1 - t0);
    }
    return std::nan("");
}

std::string refused_curve(const Log& log, const std::string& quantity)
{
    const auto parsed = parse_signal(quantity, log.things());
    REQUIRE(!parsed.ok());
    return parsed.error().text();
}

}  // namespace

TEST_CASE("quantities of bodies, shafts, interactions and the scene")
{
    const Log log = opened(make_recording("curves.mcap"));
    struct Expected
    {
        const char* quantity;
        double value;
        const char* unit;
    };
    constexpr double t = 1.5;
    const Expected all[] = {{"red.position.y", std::sin(t), "m"},
                            {"red.position.norm", std::sqrt(t * t + std::sin(t) * std::sin(t) + 4), "m"},
                            {"red.orientation.w", std::cos(t), ""},
                            {"red.velocity.x", 1, "m/s"},
                            {"red.angular_velocity.z", 2, "rad/s"},
                            {"blue.speed", 2 * t, "m/s"},
                            {"axle.angle", 3 * t, "rad"},
                            {"axle.speed", 3, "rad/s"},
                            {"contact.response.cost", 100, "ns"},
                            {"contact.response.error", 1e-6 * (1 + t), ""},
                            {"contact.response.work", -t, "J"},
                            {"contact.response.contacts", 4, ""},
                            {"contact.response.force", 3, "N"},
                            {"contact.response.force.y", 2, "N"},
                            {"energy.kinetic", 10 + t, "J"},
                            {"energy.total", 15 + t, "J"},
                            {"angular_momentum.z", 2, "N m s"},
                            {"real_time_factor", 2, ""},
                            {"contacts", 4, ""}};
    for (const Expected& e : all)
    {
        const std::vector<figures::Curve> found = curves(log, e.quantity);
        REQUIRE_MESSAGE(found.size() == 1, e.quantity);
        CHECK_MESSAGE(value_at(found[0], t) == doctest::Approx(e.value).epsilon(1e-4), e.quantity);
        CHECK_MESSAGE(found[0].unit == e.unit, e.quantity);
    }
}

TEST_CASE("a vector without a component means all of them; a span limits the curves")
{
    const Log log = opened(make_recording("curves_vector.mcap"));
    const std::vector<figures::Curve> found = curves(log, "red.position", {0.5, 0.75});
    REQUIRE(found.size() == 3);
    CHECK(found[1].name == "red.position.y");
    CHECK(found[1].points.front().first == 0.5);
    CHECK(found[1].points.back().first == 0.75);
    CHECK(found[1].points.size() == 26);
    CHECK(found[1].points.front().second == std::sin(50 * kMadeStep));
}

TEST_CASE("frames that name only moved objects give the same curves")
{
    const Log log = opened(make_recording("curves_moved.mcap", {.only_moved = true}));
    CHECK(value_at(curves(log, "axle.angle")[0], 1.5) == 0);
    CHECK(curves(log, "axle.angle")[0].points.size() == 201);
    // Recorded at every tenth step, kept in between.
    CHECK(curves(log, "blue.position.z")[0].points[47].second == doctest::Approx(0.16));
    CHECK(curves(log, "red.position.x")[0].points[47].second == doctest::Approx(0.47));
}

TEST_CASE("a curve is interrupted where a run ends")
{
    const Log log = opened(make_recording("curves_runs.mcap", {.steps_after = 50}));
    const figures::Curve x = curves(log, "red.position.x")[0];
    REQUIRE(x.points.size() == 201 + 1 + 51);
    CHECK(std::isnan(x.points[201].second));
    CHECK(x.points[202].second == 0);
    CHECK(x.points[202].first == doctest::Approx(2.01));
}

TEST_CASE("the cost and pace in the first metrics of a run were measured before it, and are not part of the curve")
{
    const Log log = opened(make_recording("curves_first.mcap", {.steps_after = 100}));
    for (const char* quantity : {"real_time_factor", "step_cost", "contact.response.cost"})
    {
        const auto curve = curves(log, quantity).at(0);
        REQUIRE(curve.points.size() > 4);
        for (const auto& [time, value] : curve.points)
            CHECK_MESSAGE((std::isnan(value) || value == 2 || value == 50000 || value == 100 || value == 2000), quantity << " " << value);
    }
    // Values that belong to the scene's state count from the first sample on.
    CHECK(curves(log, "contact.response.work").at(0).points.front().first == 0.0);
}

TEST_CASE("a long series keeps its peaks in little memory")
{
    Thinned thinned(0, 1000);
    for (int i = 0; i < 1'000'000; ++i) thinned.add(i * 1e-3, i == 123'456 ? 50.0 : std::sin(i * 1e-2));
    const auto points = thinned.take();
    CHECK(points.size() <= 4 * Thinned::kSlots + 4);
    CHECK(points.size() > Thinned::kSlots);
    CHECK(std::any_of(points.begin(), points.end(), [](const auto& p) { return p.second == 50.0 && p.first == 123.456; }));
    CHECK(std::is_sorted(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.first < b.first; }));
}

TEST_CASE("without a catalogue objects have numbers, and interactions the names of the metrics")
{
    const Log log = opened(make_recording("curves_nameless.mcap", {.with_catalogue = false}));
    CHECK(value_at(curves(log, "#1.position.x")[0], 1.5) == doctest::Approx(1.5));
    CHECK(value_at(curves(log, "contact.response.cost")[0], 1.5) == 100);
}

TEST_CASE("unknown quantities are refused_curve with a list of the known ones")
{
    const Log log = opened(make_recording("curves_refused.mcap"));
    CHECK(refused_curve(log, "rde.position").find("did you mean 'red'") != std::string::npos);
    CHECK(refused_curve(log, "red.height").find("a body has position") != std::string::npos);
    CHECK(refused_curve(log, "red.position.q").find("a body has position") != std::string::npos);
    CHECK(refused_curve(log, "red").find("no quantity 'red'") != std::string::npos);
    CHECK(curves(log, "contact.response.nothing")[0].points.empty());
    CHECK(refused_curve(log, "axle.position.x").find("a shaft has angle, speed") != std::string::npos);
    CHECK(refused_curve(log, "axle.position.x").find("a body has") == std::string::npos);
    CHECK(refused_curve(log, "red.angle").find("a shaft has") == std::string::npos);
}

TEST_CASE("swaps, runs and events are marked where they were")
{
    const Log log = opened(make_recording("moments.mcap", {.steps_after = 20}));
    const auto all = moments_of(log, {}, true);
    using Kind = figures::Moment::Kind;
    const auto count = [&](Kind kind) { return std::count_if(all.begin(), all.end(), [&](const auto& m) { return m.kind == kind; }); };
    CHECK(count(Kind::Change) == 1);
    CHECK(count(Kind::Break) == 1);
    CHECK(count(Kind::Alarm) == 1);
    CHECK(count(Kind::Notice) == 3);
    for (const figures::Moment& m : all)
    {
        if (m.kind == Kind::Change) CHECK(m.words == "contact.response: Response/Impulse → Response/None");
        if (m.kind == Kind::Change) CHECK(m.at == 1.0);
        if (m.kind == Kind::Break) CHECK(m.words == "run 2: reset");
        if (m.kind == Kind::Alarm) CHECK(m.at == 0.8);
    }
    CHECK(moments_of(log, {}, false).size() == 3);
}

TEST_CASE("a chart is written in both formats, without NaN in it")
{
    const Log log = opened(make_recording("chart.mcap", {.steps_after = 20}));
    figures::Chart chart;
    chart.title = "a < b", chart.curves = curves(log, "red.position"), chart.moments = moments_of(log, {}, true);
    const figures::Drawing drawing = draw(chart);
    const std::string svg = drawing.svg(true);
    CHECK(svg.find("a &lt; b") != std::string::npos);
    CHECK(svg.find("nan") == std::string::npos);
    CHECK(svg.find("run 2: reset") != std::string::npos);
    for (const char* name : {"chart.svg", "chart.png"}) REQUIRE(figures::write_picture(drawing, fresh_path(name)).ok());
    CHECK(!figures::write_picture(drawing, fresh_path("chart.gif")).ok());
    CHECK(!figures::write_picture(drawing, fresh_path("no_folder") + "/chart.svg").ok());
    // No curve, one point, values that a logarithmic scale cannot show.
    chart.curves.clear();
    CHECK(draw(chart).svg(true).find("nothing to draw") != std::string::npos);
    chart.curves = {{"one", "m", {{1, 1}}}, {"none", "m", {{1, 0}, {2, -1}}}};
    chart.kind = figures::Scale::Kind::Log;
    CHECK(draw(chart).svg(true).find("nan") == std::string::npos);
}

TEST_CASE("a chart draws equal curves once, under all their names, and its time axis is as wide as in any other chart")
{
    const std::vector<std::pair<double, double>> points{{0, 1}, {1, 2}, {2, 1}};
    figures::Chart chart;
    chart.curves = {
        {"first", "J", points}, {"second", "J", points}, {"other unit", "m", points}, {"third", "J", {{0, 1}, {1, 2}, {2, 1.5}}}};
    const std::string svg = draw(chart).svg(true);
    CHECK(svg.find(">first, second<") != std::string::npos);
    CHECK(svg.find(">third<") != std::string::npos);
    CHECK(svg.find(">other unit<") != std::string::npos);
    // Eight equal ones do not fill the legend; a long name is cut and does not move the panel.
    for (int i = 0; i < 7; ++i) chart.curves.push_back({"a name of some length " + std::to_string(i), "J", points});
    const std::string many = draw(chart).svg(true);
    CHECK(many.find(">first, second and 7 more<") != std::string::npos);
    const auto right_end = [](const figures::Chart& c)
    {
        // The legend begins beside the panel.
        const std::string text = draw(c).svg(true);
        const std::size_t at = text.find(">" + c.curves.front().name.substr(0, 5));
        const std::size_t x = text.rfind("x=\"", at);
        return text.substr(x, text.find('"', x + 3) - x);
    };
    figures::Chart narrow, broad;
    narrow.curves = {{"short", "J", points}}, broad.curves = {{"short but then a very long name that does not fit at all", "J", points}};
    CHECK(right_end(narrow) == right_end(broad));
    CHECK(draw(broad).svg(true).find("…<") != std::string::npos);
}

TEST_CASE("a chart's time axis goes as far as it is told to")
{
    figures::Chart chart;
    chart.curves = {{"short", "J", {{4, 1}, {5, 2}}}};
    CHECK(draw(chart).svg(true).find(">10<") == std::string::npos);
    chart.times = {{0, 10}};
    CHECK(draw(chart).svg(true).find(">10<") != std::string::npos);
}
