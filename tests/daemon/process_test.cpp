// The real program in a process of its own.
#include <doctest/doctest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/text.h"

namespace
{

using plab::test::quoted;

struct Outcome
{
    int code = -1;
    std::string text;  ///< standard output and error
};

Outcome plabd(const std::string& arguments)
{
    const std::string command = quoted(std::string(PLAB_BINARY_DIR) + "/bin/plabd") + " " + arguments + " --no-bus 2>&1";
    std::FILE* pipe = popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    Outcome out;
    char buffer[4096];
    while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe)) out.text.append(buffer, n);
    const int status = pclose(pipe);
    out.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    return out;
}

std::string temporary(const std::string& name) { return std::string(PLAB_BINARY_DIR) + "/daemon_test_" + name; }

std::string read(const std::string& file)
{
    std::ifstream in(file);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

using plab::test::has;

const std::string kScene = quoted(std::string(PLAB_SOURCE_DIR) + "/scenes/fan_and_balloons.xml");

}  // namespace

TEST_CASE("the end state is JSON with the documented keys")
{
    const std::string file = temporary("end.json");
    const Outcome run = plabd(kScene + " --until 1 --out " + quoted(file));
    REQUIRE_MESSAGE(run.code == 0, run.text);
    const auto json = nlohmann::json::parse(read(file));
    CHECK(json["time"] == 1.0);
    CHECK(json["step"] == 240);
    CHECK(json["hash"].get<std::string>().size() == 16);
    CHECK(json["momentum"].size() == 3);
    CHECK(json["objects"]["red"]["position"].size() == 3);
    CHECK(json["objects"]["red"]["orientation"].size() == 4);
    CHECK(json["objects"]["red"].contains("linear_velocity"));
    CHECK(json["objects"]["red"].contains("angular_velocity"));
    CHECK(json["objects"]["fan"].contains("angle"));
    CHECK(json["objects"]["fan"].contains("angular_velocity"));
    CHECK(json["interactions"]["gears"]["type"] == "Constraint/AngularVelocity/Graph");
    CHECK(json["interactions"]["wind"]["cost_ns_per_step"].get<double>() > 0);
    CHECK(json["interactions"]["contact"]["cost_ns_per_step"].get<double>() > 0);
    CHECK(std::abs(json["ledger"]["unexplained"].get<double>()) < 1e-9);
}

TEST_CASE("standing contacts are in the end state, under ids that stay")
{
    const std::string scene = temporary("resting.xml");
    std::ofstream(scene) << "<plab version=\"1\"><component id=\"floor\" type=\"Shape/Plane\"/><component id=\"ground\" "
                            "type=\"State/Static\" shape=\"floor\"/>"
                            "<component id=\"s\" type=\"Shape/Box\" half_extents=\"0.5 0.5 0.5\"/><component id=\"box\" "
                            "type=\"State/RigidBody\" mass=\"1\" shape=\"s\" "
                            "position=\"0 0 0.6\"/><component id=\"g\" type=\"Field/Gravity\" between=\"box\"/><component id=\"contact\" "
                            "type=\"CDetection/ODE\" "
                            "between=\"box ground\"/></plab>";
    const auto one = nlohmann::json::parse(plabd(quoted(scene) + " --until 1 --out -").text),
               two = nlohmann::json::parse(plabd(quoted(scene) + " --until 2 --out -").text);
    REQUIRE(one["contacts"].size() == 1);
    CHECK(one["contacts"][0]["resting"] == true);
    CHECK(one["contacts"][0]["ids"].size() == 4);
    CHECK(one["contacts"] == two["contacts"]);
}

TEST_CASE("a trace has a row for each interval and does not disturb")
{
    const std::string file = temporary("trace.csv");
    const Outcome with = plabd(kScene + " --until 1 --trace " + quoted(file) + " --every 0.1 --out -"),
                  without = plabd(kScene + " --until 1 --out -");
    REQUIRE(with.code == 0);
    std::istringstream rows(read(file));
    std::string header, row;
    std::getline(rows, header);
    const auto columns = std::count(header.begin(), header.end(), ',');
    int n = 0;
    for (; std::getline(rows, row); ++n) CHECK(std::count(row.begin(), row.end(), ',') == columns);
    CHECK(n == 11);
    CHECK(nlohmann::json::parse(with.text)["hash"] == nlohmann::json::parse(without.text)["hash"]);
}

TEST_CASE("swaps and sets of the command line take effect at their step, or the run fails")
{
    const Outcome swapped = plabd(kScene + " --until 5 --swap \"0:contact.response=Response/None\" --out -");
    REQUIRE(swapped.code == 0);
    CHECK(has(swapped.text, "contact.response Response/Impulse -> Response/None"));
    CHECK(plabd(kScene + " --until 1 --set \"10:red.mass=0.05\"").code == 0);
    const Outcome refused = plabd(kScene + " --until 1 --swap \"10:gears=Field/Gravity\"");
    CHECK(refused.code == 1);
    CHECK(has(refused.text, "cannot be exchanged"));
    const Outcome late = plabd(kScene + " --until 1 --swap \"5000:contact.response=Response/None\"");
    CHECK(late.code == 1);
    CHECK(has(late.text, "did not reach"));
}

TEST_CASE("wrong use is 2, bad scenes are 1, both with a message")
{
    CHECK(plabd("").code == 2);
    CHECK(plabd(kScene + " --nonsense").code == 2);
    CHECK(plabd(kScene + " --swap nothing").code == 2);
    CHECK(plabd(kScene + " --check --expand").code == 2);
    const Outcome missing = plabd("no_such_file.xml");
    CHECK(missing.code == 1);
    CHECK(has(missing.text, "no_such_file.xml"));
    const std::string bad = temporary("bad.xml");
    std::ofstream(bad) << "<plab version=\"1\">\n  <component id=\"a\" type=\"State/Shaft\" inertia=\"-1\" colour=\"1 0 0\"/>\n  "
                          "<component id=\"a\" type=\"State/Shft\"/>\n</plab>\n";
    const Outcome check = plabd("--check " + quoted(bad));
    CHECK(check.code == 1);
    CHECK(has(check.text, "bad.xml:2:3:"));
    CHECK(has(check.text, "inertia"));
    CHECK(has(check.text, "color"));
    CHECK(has(check.text, "bad.xml:3:3:"));
    CHECK(has(check.text, "State/Shaft"));
}

TEST_CASE("the live table of a scene with governors begins with how many have each level, what that costs and how large the error is")
{
    const std::string scene = temporary("levels.xml");
    std::ofstream(scene)
        << "<plab version=\"1\"><component id=\"ball\" type=\"Shape/Sphere\" radius=\"0.5\"/>"
           "<component id=\"drone\" type=\"State/Kinematic\" position=\"0 -3 0\" linear_velocity=\"4 0 0\"/>"
           "<component id=\"eye\" type=\"Viewer/Attached\" body=\"drone\"/><repeat id=\"row\" count=\"30\" step=\"2 0 0\">"
           "<component id=\"engine\" type=\"Solver/RungeKutta4\"/><component id=\"bob\" type=\"State/RigidBody\" mass=\"1\" "
           "shape=\"ball\" angular_velocity=\"3 2 1\" solver=\"engine\"/></repeat>"
           "<component id=\"lod\" type=\"Governor/Distance\" watches=\"engine*\" every=\"0.1\" dwell=\"0.2\" distances=\"5 15\" "
           "levels=\"Solver/SemiImplicitEuler; Solver/RungeKutta4; Solver/DormandPrince54\"/></plab>";
    const Outcome run = plabd(quoted(scene) + " --until 3 --table");
    REQUIRE_MESSAGE(run.code == 0, run.text);
    const std::size_t last = run.text.rfind("levels of detail");
    REQUIRE(last != std::string::npos);
    CHECK(last < run.text.find("objects\n", last));
    const std::string table = run.text.substr(last, run.text.find("objects\n", last) - last);
    int components = 0;
    for (const char* const level : {"1 of 3", "2 of 3", "3 of 3"})
    {
        CHECK_MESSAGE(has(table, level), table);
        const std::string line = table.substr(table.find(level), table.find('\n', table.find(level)) - table.find(level));
        std::istringstream words(line.substr(6));
        double cost = 0;
        int count = 0;
        words >> count >> cost;
        components += count;
        CHECK_MESSAGE(cost > 0, line);
    }
    CHECK(components == 30);
    CHECK(has(table, "unknown"));  // SemiImplicitEuler measures no error, and neither does this governor
    CHECK(has(run.text, "level.changed engine"));
    CHECK(has(run.text, "cost "));
}

TEST_CASE("what rules have made: explained, and frozen into a scene without rules")
{
    const std::string scene = quoted(std::string(PLAB_SOURCE_DIR) + "/scenes/workshop.xml");
    const Outcome none = plabd("--explain " + scene), made = plabd("--explain --until 9.5 " + scene);
    CHECK(has(none.text, "mesh, wheels that mesh turn against one another: nothing yet"));
    CHECK(has(made.text, "mesh, wheels that mesh turn against one another: mesh.large_gear.small_gear (Constraint/Gear)"));
    const Outcome frozen = plabd("--expand --until 9.5 " + scene);
    CHECK(frozen.code == 0);
    CHECK(!has(frozen.text, "Rule/Pair"));
    CHECK(has(frozen.text, "clutch.axle"));
    // What was frozen goes on as the scene itself does.
    const std::string file = temporary("frozen.xml");
    std::ofstream(file) << frozen.text;
    const auto frozen_end = nlohmann::json::parse(plabd(quoted(file) + " --no-bus --until 4 --out -").text);
    const auto whole_end = nlohmann::json::parse(plabd(scene + " --no-bus --until 13.5 --out -").text);
    for (const char* const id : {"red", "green"})
        for (int k = 0; k < 3; ++k)
        {
            const double one = frozen_end["objects"][id]["position"][k].get<double>();
            const double other = whole_end["objects"][id]["position"][k].get<double>();
            CHECK(std::abs(one - other) < 1e-6);
        }
    CHECK(whole_end["objects"]["red"]["position"][0].get<double>() > 1.7);
}

TEST_CASE("help, version, check, expand, explain")
{
    CHECK(has(plabd("--help").text, "Examples:"));
    CHECK(has(plabd("--version").text, "plabd 0."));
    CHECK(plabd("--check " + kScene).code == 0);
    const std::string file = temporary("long.xml");
    std::ofstream(file) << plabd("--expand " + kScene).text;
    CHECK(nlohmann::json::parse(plabd(quoted(file) + " --until 2 --out -").text)["hash"] ==
          nlohmann::json::parse(plabd(kScene + " --until 2 --out -").text)["hash"]);
    const Outcome explain = plabd("--explain " + kScene);
    CHECK(has(explain.text, "one degree of freedom"));
    CHECK(has(explain.text, "Field/Gravity"));
}

TEST_CASE("the trace has work and outputs of interactions: forces of joints, residuals of responses")
{
    const std::string scene = temporary("joint.xml"), file = temporary("joint.csv");
    std::ofstream(scene) << "<plab version=\"1\"><component id=\"bob\" type=\"State/RigidBody\" mass=\"2\" inertia=\"1 1 1\"/>"
                            "<component id=\"hook\" type=\"State/Static\"/>"
                            "<component id=\"weld\" type=\"Constraint/Fixed\" a=\"hook\" b=\"bob\"/>"
                            "<component id=\"g\" type=\"Field/Gravity\" between=\"bob\"/></plab>";
    const Outcome run = plabd(quoted(scene) + " --until 0.1 --trace " + quoted(file));
    REQUIRE_MESSAGE(run.code == 0, run.text);
    std::istringstream lines(read(file));
    std::string header, line, last;
    std::getline(lines, header);
    while (std::getline(lines, line)) last = line;
    const auto cells = [](const std::string& text)
    {
        std::vector<std::string> out;
        std::istringstream in(text);
        for (std::string cell; std::getline(in, cell, ',');) out.push_back(cell);
        return out;
    };
    const std::vector<std::string> names = cells(header), values = cells(last);
    REQUIRE(values.size() == names.size());
    const auto value = [&](const std::string& name)
    {
        const auto at = std::find(names.begin(), names.end(), name);
        REQUIRE_MESSAGE(at != names.end(), name);
        return std::stod(values[static_cast<std::size_t>(at - names.begin())]);
    };
    CHECK(value("weld.force.z") == doctest::Approx(2 * 9.81).epsilon(1e-9));
    CHECK(std::abs(value("weld.work")) < 1e-9);
    CHECK(std::abs(value("weld.position_error")) < 1e-9);
    CHECK(value("bob.position.z") == doctest::Approx(0).epsilon(1e-9));
}

TEST_CASE("--reference prints one type, by its whole or short name, or a kind")
{
    const Outcome one = plabd("--reference Response/Rows"), same = plabd("--reference Rows"), kind = plabd("--reference Response");
    REQUIRE_MESSAGE(one.code == 0, one.text);
    CHECK(one.text.starts_with("### Response/Rows\n"));
    CHECK_FALSE(has(one.text, "### Response/Impulse"));
    CHECK(same.text == one.text);
    CHECK(has(kind.text, "### Response/Impulse\n"));
    CHECK(has(kind.text, one.text));
    CHECK_FALSE(has(kind.text, "### Manager/"));
    const Outcome unknown = plabd("--reference Rose");
    CHECK(unknown.code == 1);
    CHECK(has(unknown.text, "unknown type 'Rose'"));
    CHECK(has(plabd("--reference Impulse").text, "'Constraint/AngularVelocity/Impulse' or 'Response/Impulse': give the whole name"));
}

TEST_CASE("the reference of Script/Lua lists what a script can use, with units and limits")
{
    const Outcome lua = plabd("--reference Lua");
    REQUIRE(lua.code == 0);
    for (const char* line : {"| `participant:add_force(force)` |", "| `body.velocity` | m/s |", "| `step.dt` | s |",
                             "| `math.atan(y, x)` |", "texts of 4096 bytes"})
        CHECK_MESSAGE(has(lua.text, line), line);
}

TEST_CASE("short names of types work on the command line and in a scene")
{
    const Outcome run =
        plabd(kScene + " --until 0.1 --swap \"10:contact.response=None\" --swap \"12:contact.resolution=LocalRoot\" --log-level info");
    CHECK_MESSAGE(run.code == 0, run.text);
    CHECK(has(run.text, "Response/Impulse -> Response/None"));
    CHECK(has(run.text, "-> Resolution/LocalRoot"));
}

TEST_CASE("too many components are refused where they come in, with the place and the option that allows more")
{
    const std::string scene = temporary("many.xml");
    std::ofstream(scene) << "<plab version=\"1\">\n  <repeat count=\"900000\" step=\"1 0 0\">\n    <component id=\"b\" "
                            "type=\"State/RigidBody\" mass=\"1\"/>\n  </repeat>\n</plab>";
    const Outcome run = plabd(quoted(scene) + " --check");
    CHECK(run.code == 1);
    CHECK(has(run.text, "many.xml:2:"));
    CHECK(has(run.text, "makes 900000 components: a scene has at most 100000 (--max-components N raises that)"));
    std::ofstream(scene) << "<plab version=\"1\">\n  <repeat count=\"30\">\n    <component id=\"b\" "
                            "type=\"State/RigidBody\" mass=\"1\" inertia=\"1 1 1\"/>\n  </repeat>\n</plab>";
    CHECK(plabd(quoted(scene) + " --check --max-components 20").code == 1);
    CHECK(plabd(quoted(scene) + " --check --max-components 40").code == 0);
}
