// server/docs/reference.md is what `plabd --reference` prints. Renew it with that command when a declaration changed.
#include <algorithm>
#include <fstream>
#include <sstream>

#include "blueprint/writer.h"
#include "model/measured_costs.h"
#include "model/type_summary.h"
#include "simulation/step/step_tree.h"
#include "support/scene.h"

TEST_CASE("the reference of component types is current")
{
    std::ifstream file(std::string(PLAB_SOURCE_DIR) + "/server/docs/reference.md");
    REQUIRE(file);
    std::stringstream text;
    text << file.rdbuf();
    CHECK_MESSAGE(text.str() == plab::blueprint::write_reference(plab::test::library()),
                  "run: build/bin/plabd --reference > server/docs/reference.md");
}

using namespace plab;

TEST_CASE("step.md explains the nodes of the step in their order")
{
    std::ifstream file(std::string(PLAB_SOURCE_DIR) + "/server/docs/step.md");
    REQUIRE(file);
    std::vector<std::string> explained, nodes;
    for (std::string line; std::getline(file, line);)
    {
        std::istringstream words(line);
        std::string bar, stage, name;
        if (!(words >> bar >> stage >> bar >> name) || name.size() < 3 || name.front() != '`') continue;
        if (stage == "PreStep" || stage == "Step" || stage == "PostStep") explained.push_back(name.substr(1, name.size() - 2));
    }
    for (const simulation::StepNode& node : simulation::kStepTree) nodes.emplace_back(node.name);
    CHECK(explained == nodes);
}

TEST_CASE("each algorithm of a ladder was measured, and nothing else")
{
    const std::vector<std::string> names = test::library().names();
    std::vector<std::string> measured, expected;
    for (const model::MeasuredCost& m : model::kMeasuredCosts) measured.emplace_back(m.type);
    for (const model::MeasuredFamily& family : model::kMeasuredFamilies)
        for (const std::string& name : names)
            if (name.starts_with(family.prefix) && name != "Response/None") expected.push_back(name);  // it answers nothing
    std::sort(measured.begin(), measured.end()), std::sort(expected.begin(), expected.end());
    CHECK_MESSAGE(measured == expected, "run: build/bin/bench_algorithms --measured, for server/model/measured_costs.h");
}

TEST_CASE("ladders are printed in the order of the table, for each kind of scene")
{
    const auto ladders = model::measured_ladders();
    CHECK(ladders.size() == 3 * std::size(model::kMeasuredFamilies));
    for (const model::MeasuredLadder& ladder : ladders)
    {
        CAPTURE(ladder.family);
        CAPTURE(ladder.scene);
        REQUIRE(ladder.algorithms.size() > 1);
        CHECK(std::is_sorted(ladder.algorithms.begin(), ladder.algorithms.end(), [](const auto& a, const auto& b) { return a.us < b.us; }));
        // Where it is printed: the kind's reference names them in that order.
        const auto text = blueprint::write_reference(test::library(), std::string(ladder.family.substr(0, ladder.family.size() - 1)));
        REQUIRE_MESSAGE(text.ok(), test::reasons(text));
        const std::size_t row = text->find("| " + std::string(ladder.scene) + " | ");
        REQUIRE(row != std::string::npos);
        const std::string line = text->substr(row, text->find('\n', row) - row);
        std::size_t at = 0;
        for (const auto& algorithm : ladder.algorithms)
        {
            const std::size_t found = line.find("`" + std::string(algorithm.type.substr(ladder.family.size())) + "` ");
            CHECK_MESSAGE((found != std::string::npos && found > at), algorithm.type << " in " << line);
            at = found;
            // plabctl types prints the cost of a type by itself, with its place.
            const auto type = test::library().require(std::string(algorithm.type));
            REQUIRE(type.ok());
            const std::string cost = model::summary_of(**type).cost;
            CHECK_MESSAGE(
                cost.find(" of " + std::to_string(ladder.algorithms.size()) + ") for " + std::string(ladder.scene)) != std::string::npos,
                cost);
        }
    }
}

TEST_CASE("costs that are alike share a place")
{
    const model::MeasuredLadder ladder{"M/", "a scene", {{"M/A", 10}, {"M/B", 10.5}, {"M/C", 30}, {"M/D", model::kDear}}};
    CHECK(ladder.text() == "`A` 10 ~ `B` 10.5 < `C` 30 < `D` more than 5 s");
    CHECK(ladder.place_of("M/A") == 1);
    CHECK(ladder.place_of("M/B") == 1);
    CHECK(ladder.place_of("M/C") == 3);
    CHECK(ladder.place_of("M/D") == 4);
    CHECK(ladder.place_of("M/E") == 0);
}
