#include "web/metrics_text.h"

#include <doctest/doctest.h>

#include "prometheus.h"

using namespace plab;
using namespace plab::web;
using namespace plab::test;

namespace
{

link::CatalogueContents measured_scene()
{
    link::CatalogueContents out;
    link::ServerInfo& server = out.server.emplace();
    server.name = "lab \"one\"\\\n", server.dt = 1.0 / 240, server.requests_done = 7, server.requests_refused = 2;
    server.dropped = {{"plab/states", 5}, {"plab/events", 0}};
    server.step = 1234, server.paused = true;
    out.objects["ball"].shape_of = "body", out.objects["box"].shape_of = "body", out.objects["wheel"].shape_of = "shaft";
    out.interactions["gears"].type_name = "Constraint/AngularVelocity/Graph";
    link::Metrics& metrics = out.metrics.emplace();
    metrics.step_ns = 7500, metrics.contacts = 3;
    metrics.ledger = {4.5, 0.25, 4.75, 0.5, -1e-9};
    link::InteractionMetrics gears{"gears", "Graph", "Graph", 250, 0.125, -2, false, {{"error", "the ratio", "rad/s", "account"}}};
    link::InteractionMetrics script{"script", "Script/Lua", "Script/Lua", 1000, 0, 0, true, {}};
    metrics.interactions = {gears, script};
    return out;
}

std::map<std::string, prometheus::Family> read(const std::string& text)
{
    prometheus::Reader reader;
    auto out = reader.read(text);
    CHECK_MESSAGE(reader.error().empty(), reader.error());
    return out;
}

}  // namespace

TEST_CASE("the figures of a server are Prometheus' text, in base units")
{
    const Figures figures = figures_of(measured_scene());
    auto out = read(metrics_text(&figures, {3, 11, 1}));
    CHECK(out["plab_up"].series.at(0).value == 1);
    CHECK(out["plab_server_info"].series.at(0).labels.at("server") == "lab \"one\"\\\n");
    CHECK(out["plab_step_duration_seconds"].series.at(0).value == 7.5e-6);
    CHECK(out["plab_step_length_seconds"].series.at(0).value == 1.0 / 240);
    CHECK(out["plab_contacts"].series.at(0).value == 3);
    CHECK(out["plab_energy_joules"].series.at(0).value == 4.5);
    CHECK(out["plab_energy_error_joules"].series.at(0).value == -1e-9);
    CHECK(out["plab_requests_total"].series.at(1).value == 2);
    CHECK(out["plab_dropped_samples_total"].series.size() == 2);
    CHECK(out["plab_objects"].series.at(0).value == 2);
    CHECK(out["plab_objects"].series.at(1).value == 1);
    CHECK(out["plab_web_pages"].series.at(0).value == 3);
    CHECK(out["plab_web_frames_replaced_total"].series.at(0).value == 11);
    // The dearest first; an error only where one is known.
    const auto& costs = out["plab_component_cost_seconds"].series;
    REQUIRE(costs.size() == 2);
    CHECK(costs[0].labels.at("component") == "script");
    CHECK(costs[1].value == 2.5e-7);
    CHECK(costs[1].labels.at("algorithm") == "Constraint/AngularVelocity/Graph");
    REQUIRE(out["plab_component_error"].series.size() == 1);
    CHECK(out["plab_component_error"].series[0].value == 0.125);
    CHECK(out["plab_component_quarantined"].series[0].value == 1);
    CHECK(out.count("plab_recording_bytes") == 0);
}

TEST_CASE("without a server there is still an answer, and numbers that are none are written as such")
{
    const auto none = read(metrics_text(nullptr, {}));
    CHECK(none.at("plab_up").series.at(0).value == 0);
    CHECK(none.count("plab_step") == 0);
    link::CatalogueContents scene = measured_scene();
    scene.metrics->deepest = INFINITY, scene.metrics->residual = NAN;
    const Figures figures = figures_of(scene);
    const auto out = read(metrics_text(&figures, {}));
    CHECK(std::isinf(out.at("plab_deepest_penetration_meters").series.at(0).value));
    CHECK(std::isnan(out.at("plab_residual_meters_per_second").series.at(0).value));
}

TEST_CASE("of many components the dearest have series of their own")
{
    link::CatalogueContents scene = measured_scene();
    for (std::size_t i = 0; i < kMostComponents; ++i)
        scene.metrics->interactions.push_back({"c" + std::to_string(i), "T", "T", 10, 0, 0, false, {}});
    const Figures figures = figures_of(scene);
    CHECK(figures.components.size() == kMostComponents);
    CHECK(figures.components[0].id == "script");
    CHECK(figures.components[1].id == "gears");
}

TEST_CASE("the reader of this test accepts nothing else")
{
    for (const char* text :
         {"", "a 1", "a 1\n", "# HELP a x\na 1\n", "# HELP a x\n# TYPE a gauge\nb 1\n", "# HELP a x\n# TYPE a gauge\na\n",
          "# HELP a x\n# TYPE a gauge\na 1 x\n", "# HELP a x\n# TYPE a gauge\na{b=1} 1\n", "# HELP a x\n# TYPE a gauge\na{b=\"1} 1\n",
          "# HELP a x\n# TYPE a gauge\na 1\na 2\n", "# HELP a x\n# TYPE a counter\na 1\n",
          "# HELP a_total x\n# TYPE a_total counter\na_total -1\n", "# HELP a x\n# TYPE a gauge\na nan\n",
          "# HELP a x\n# TYPE a gauge\na{b=\"\\t\"} 1\n"})
    {
        INFO(text);
        prometheus::Reader reader;
        CHECK(reader.read(text).empty());
        CHECK(!reader.error().empty());
    }
}
