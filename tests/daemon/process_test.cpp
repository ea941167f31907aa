// The real program in a process of its own.
#include <doctest/doctest.h>
#include <sys/wait.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

namespace
{

struct Outcome
{
    int code = -1;
    std::string text;  ///< standard output and error
};

Outcome plabd(const std::string& arguments)
{
    const std::string command = std::string(PLAB_BINARY_DIR) + "/bin/plabd " + arguments + " --no-bus 2>&1";
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

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const std::string kScene = std::string(PLAB_SOURCE_DIR) + "/scenes/fan_and_balloons.xml";

}  // namespace

TEST_CASE("the end state is JSON with the documented keys")
{
    const std::string file = temporary("end.json");
    const Outcome run = plabd(kScene + " --until 1 --out " + file);
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
    const auto one = nlohmann::json::parse(plabd(scene + " --until 1 --out -").text),
               two = nlohmann::json::parse(plabd(scene + " --until 2 --out -").text);
    REQUIRE(one["contacts"].size() == 1);
    CHECK(one["contacts"][0]["resting"] == true);
    CHECK(one["contacts"][0]["ids"].size() == 4);
    CHECK(one["contacts"] == two["contacts"]);
}

TEST_CASE("a trace has a row for each interval and does not disturb")
{
    const std::string file = temporary("trace.csv");
    const Outcome with = plabd(kScene + " --until 1 --trace " + file + " --every 0.1 --out -"),
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
    const Outcome check = plabd("--check " + bad);
    CHECK(check.code == 1);
    CHECK(has(check.text, "bad.xml:2:3:"));
    CHECK(has(check.text, "inertia"));
    CHECK(has(check.text, "color"));
    CHECK(has(check.text, "bad.xml:3:3:"));
    CHECK(has(check.text, "State/Shaft"));
}

TEST_CASE("help, version, check, expand, explain")
{
    CHECK(has(plabd("--help").text, "Examples:"));
    CHECK(has(plabd("--version").text, "plabd 0."));
    CHECK(plabd("--check " + kScene).code == 0);
    const std::string file = temporary("long.xml");
    std::ofstream(file) << plabd("--expand " + kScene).text;
    CHECK(nlohmann::json::parse(plabd(file + " --until 2 --out -").text)["hash"] ==
          nlohmann::json::parse(plabd(kScene + " --until 2 --out -").text)["hash"]);
    const Outcome explain = plabd("--explain " + kScene);
    CHECK(has(explain.text, "one degree of freedom"));
    CHECK(has(explain.text, "Field/Gravity"));
}
