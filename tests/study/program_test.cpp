// The real program in a process of its own.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "support/process.h"
#include "support/text.h"

using namespace plab::test;

namespace
{

const std::string kFolder = std::string(PLAB_BINARY_DIR) + "/study_test";

std::string folder(const std::string& name)
{
    const std::string out = kFolder + "/" + name;
    std::filesystem::remove_all(out);
    return out;
}

Outcome study(std::vector<std::string> arguments)
{
    arguments.insert(arguments.begin(), program("plab-study"));
    return run(std::move(arguments), Milliseconds(60000));
}

std::string read(const std::string& file)
{
    std::ifstream in(file);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

nlohmann::json results(const std::string& where) { return nlohmann::json::parse(read(where + "/results.json")); }

}  // namespace

TEST_CASE("a study writes its report, tables and pictures, and says what it found")
{
    const std::string where = folder("box");
    const Outcome done = study({scene_file("studies/free_box.xml"), "--vary", "solver=SemiImplicitEuler,RungeKutta4", "--vary",
                                "dt=1/50,1/100", "--reference", "exact:torque-free", "--quantity", "box.orientation", "--quantity",
                                "box.angular_velocity", "--until", "2", "--repeat", "2", "-o", where});
    REQUIRE_MESSAGE(done.code == 0, done.errors);
    CHECK(has(done.output, "RungeKutta4 at 1/100 s is the most accurate"));
    CHECK_MESSAGE(done.errors.empty(), done.errors);  // progress is for a terminal, or on request
    for (const char* file : {"report.html", "results.csv", "results.json", "reference.csv", "work-precision.svg", "work-precision.png",
                             "convergence.svg", "convergence.png", "energy.svg", "digits.svg", "digits.png"})
        CHECK_MESSAGE(std::filesystem::file_size(where + "/" + file) > 100, file);
    const auto json = results(where);
    CHECK(json["schema"] == "plab-study 2");
    REQUIRE(json["points"].size() == 4);
    const auto& best = json["points"][3];
    CHECK(best["settings"]["solver"] == "RungeKutta4");
    CHECK(best["errors"]["box.orientation"]["series"] < 1e-6);
    CHECK(best["outcome"] == "completed");
    CHECK(best["allocations"] == 0);
    CHECK(best["evaluations"] == 4 * 200);
    CHECK(best["hash"].get<std::string>().size() == 16);
    CHECK(best["cpu"]["min"] > 0);
    CHECK(best["cpu"]["median"] >= best["cpu"]["min"]);
    CHECK(best["angular_momentum_change"] == 0);
    const auto order = std::log2(json["points"][2]["error"].get<double>() / best["error"].get<double>());
    CHECK(order == doctest::Approx(4).epsilon(0.1));
}

TEST_CASE("two runs of the same study give the same errors and hashes")
{
    std::string first;
    for (const char* name : {"once", "again"})
    {
        const std::string where = folder(name);
        const Outcome done = study({scene_file("fan_and_balloons.xml"), "--vary", "gears=Graph,Impulse", "--vary", "dt=1/60,1/120",
                                    "--until", "2", "--quantity", "red.position", "--repeat", "1", "--quiet", "-o", where});
        REQUIRE_MESSAGE(done.code == 0, done.errors);
        CHECK(done.errors.empty());
        std::string figures;
        for (const auto& p : results(where)["points"]) figures += p["hash"].dump() + p["error"].dump() + " ";
        if (first.empty()) first = figures;
        CHECK(figures == first);
    }
}

TEST_CASE("a run that fails is a result; one that cannot be made is named")
{
    const std::string where = folder("failures");
    const Outcome done =
        study({scene_file("studies/bounce.xml"), "--vary", "contact.response=Impulse,None", "--vary", "contact.response.restitution=0.5",
               "--vary", "dt=1/60", "--floor", "-1", "--until", "2", "--reference", "none", "--quiet", "--repeat", "1", "-o", where});
    REQUIRE_MESSAGE(done.code == 0, done.errors);
    const auto points = results(where)["points"];
    CHECK(points[0]["outcome"] == "completed");
    CHECK(points[1]["outcome"] == "refused");
    CHECK(has(points[1]["why"], "restitution"));
    const std::string through = folder("through");
    REQUIRE(study({scene_file("studies/bounce.xml"), "--vary", "contact.response=Impulse,None", "--floor", "-1", "--until", "2",
                   "--reference", "none", "--quiet", "--repeat", "1", "-o", through})
                .code == 0);
    CHECK(results(through)["points"][1]["outcome"] == "fell through");
    CHECK(has(read(through + "/report.html"), "ball was below z = -1 m"));
}

TEST_CASE("a swap inside the runs, and plabd's trace as reference")
{
    const std::string where = folder("swap"), trace = kFolder + "/trace.csv";
    std::filesystem::create_directories(kFolder);
    REQUIRE(run({program("plabd"), scene_file("studies/projectile.xml"), "--until", "2", "--trace", trace, "--no-bus"}).code == 0);
    const Outcome done =
        study({scene_file("studies/projectile.xml"), "--vary", "dt=1/60,1/120", "--swap", "0.5s:solver=SemiImplicitEuler", "--reference",
               trace, "--quantity", "ball.position", "--until", "2", "--quiet", "--repeat", "1", "-o", where});
    REQUIRE_MESSAGE(done.code == 0, done.errors);
    const auto json = results(where);
    const auto& swap = json["points"][0]["swaps"][0];
    CHECK(swap["step"] == 30);
    // The keys of plabctl's reply.
    CHECK(swap["outcome"] == "done");
    CHECK(swap["reasons"].empty());
    CHECK(swap["swaps"][0].contains("component"));
    CHECK(swap["swaps"][0]["fields"].is_object());
    CHECK(swap["swaps"][0]["with_new"]["energy"].is_number());
    CHECK_FALSE(swap.contains("run"));
    CHECK(swap["swaps"][0]["to"] == "Solver/SemiImplicitEuler");
    // From t = 0.5 on late by g dt/2 a second.
    CHECK(json["points"][0]["errors"]["ball.position"]["final_absolute"] == doctest::Approx(1.5 * 9.81 / 120).epsilon(1e-6));
    CHECK(json["points"][1]["swaps"][0]["step"] == 60);
    CHECK(json["points"][1]["errors"]["ball.position"]["final_absolute"] == doctest::Approx(1.5 * 9.81 / 240).epsilon(1e-6));
    CHECK(json["reference"]["kind"] == "file");
}

TEST_CASE("a suite makes all of its studies and a report over them")
{
    const std::string where = folder("suite"), file = kFolder + "/suite.json";
    std::filesystem::create_directories(kFolder);
    nlohmann::json suite;
    suite["studies"] = {{{"name", "throw"},
                         {"scene", scene_file("studies/projectile.xml")},
                         {"until", 1},
                         {"reference", "exact:parabola"},
                         {"quantities", {"ball.position"}},
                         {"vary", {"solver=SemiImplicitEuler,RungeKutta4", "dt=1/60,1/120"}}},
                        {{"name", "missing"}, {"scene", scene_file("studies/nothing.xml")}, {"until", 1}}};
    std::ofstream(file) << suite;
    const Outcome listed = study({"--suite", file, "--list", "--repeat", "1"});
    CHECK(listed.code == 0);
    CHECK_MESSAGE(has(listed.output, "study    combinations"), listed.output);
    CHECK_MESSAGE(has(listed.output, "2 studies, 4 combinations, each run 1 + 1 times: about "), listed.output);
    CHECK_MESSAGE(has(listed.output, "cannot be studied: "), listed.output);
    CHECK(!std::filesystem::exists(where));
    const Outcome done = study({"--suite", file, "--quiet", "--repeat", "1", "-o", where});
    REQUIRE_MESSAGE(done.code == 0, done.errors);
    CHECK(has(done.output, "throw: RungeKutta4 is the cheapest"));
    CHECK(has(done.output, "missing: could not be studied"));
    const auto json = nlohmann::json::parse(read(where + "/suite.json"));
    CHECK(json["studies"][0]["digits"]["RungeKutta4"] > 12);
    CHECK(std::filesystem::exists(where + "/throw/report.html"));
    CHECK(std::filesystem::exists(where + "/digits-1.png"));
    CHECK(has(read(where + "/report.html"), "throw/report.html"));
}

TEST_CASE("plabd and plab-study end in the same state with the same figures")
{
    std::filesystem::create_directories(kFolder);
    for (const auto& [scene, until] : {std::pair<std::string, std::string>{"fan_and_balloons.xml", "4"},
                                       {"studies/swinging_rod.xml", "1"},
                                       {"studies/slope.xml", "1"},
                                       {"studies/robertson.xml", "2"}})
    {
        CAPTURE(scene);
        const std::string where = folder("agree"), out = kFolder + "/agree.json";
        REQUIRE(run({program("plabd"), scene_file(scene), "--until", until, "--out", out, "--no-bus"}).code == 0);
        REQUIRE(study({scene_file(scene), "--reference", "none", "--until", until, "--repeat", "1", "--quiet", "-o", where}).code == 0);
        const auto live = nlohmann::json::parse(read(out));
        const auto point = results(where)["points"][0];
        CHECK(point["hash"] == live["hash"]);
        CHECK(point["steps"] == live["step"]);
        CHECK(point["energy"]["energy"].back() == live["energy"]);
        for (const auto& part : point["components"])
        {
            const std::string id = part["id"];
            if (part["requested"].get<std::string>().starts_with("Solver/") || !live["interactions"].contains(id)) continue;
            const auto& other = live["interactions"][id];
            CHECK(part["requested"] == other["type"]);
            CHECK(part["error"] >= other["error"]);
            for (const auto& [name, value] : part["outputs"].items()) CHECK_MESSAGE(value == other.at(name), id, ".", name);
        }
    }
}

TEST_CASE("the levels of a scene and of its recording are checked with the same result, interval by interval")
{
    std::filesystem::create_directories(kFolder);
    const std::string scene = kFolder + "/levels.xml", recording = kFolder + "/levels.mcap";
    std::ofstream(scene) << R"(<plab version="1"><scene dt="1/100"/>
        <component id="ball" type="Shape/Sphere" radius="0.1"/>
        <component id="post" type="State/Static"/>
        <component id="bob" type="State/RigidBody" mass="1" shape="ball" position="1.5 0 0" linear_velocity="0 2 0"
                   solver="Solver/SemiImplicitEuler"/>
        <component id="spring" type="Constraint/SpringDamper" a="post" b="bob" length="1" stiffness="40"/>
        <component id="lod" type="Governor/Error" watches="*.solver" bound="1e-3" every="0.1"
                   levels="Solver/SemiImplicitEuler; Solver/RungeKutta4; Solver/DormandPrince54"/></plab>)";
    REQUIRE(run({program("plabd"), scene, "--no-bus", "--until", "2", "--record", recording, "--overwrite"}).code == 0);
    const std::string live = folder("levels_live"), recorded = folder("levels_recorded");
    const Outcome first = study({scene, "--verify-levels", "--until", "2", "-o", live});
    REQUIRE_MESSAGE(first.code == 0, first.errors);
    CHECK(has(first.output, "lod (Governor/Error): 100 % of 8 intervals of 0.25 s"));
    CHECK(has(first.output, "of bob.solver with Solver/RungeKutta4"));
    const Outcome second = study({recording, "--verify-levels", "-o", recorded});
    REQUIRE_MESSAGE(second.code == 0, second.errors);
    const std::string table = read(live + "/levels.csv");
    CHECK(has(table, "lod,Governor/Error,m,0.001,0,0.25,1,1,"));
    CHECK(table == read(recorded + "/levels.csv"));
    const std::string estimates = read(live + "/estimates.csv");
    CHECK(has(estimates, "governor,level,component,interval_begin,unit,estimate,true_error\n"));
    // The first and the fifth interval, both levels below the most exact one.
    for (const char* level : {"Solver/SemiImplicitEuler", "Solver/RungeKutta4"})
        for (const char* begin : {"0", "1"}) CHECK(has(estimates, "lod," + std::string(level) + ",bob.solver," + begin + ",m,"));
    CHECK(std::count(estimates.begin(), estimates.end(), '\n') == 5);
    CHECK(estimates == read(recorded + "/estimates.csv"));
    CHECK(study({scene, "--verify-levels", "-o", live}).code == 2);  // how long?
    CHECK(study({scene, "--verify-levels", "--govern", "--until", "1", "-o", live}).code == 2);
    CHECK(has(study({scene, "--verify-levels", "--list"}).output, "lod (Governor/Error): 1 components, at most 0.001 m within 0.25 s"));
    const Outcome nothing = study({scene_file("studies/bounce.xml"), "--verify-levels", "--until", "0.1", "-o", live});
    CHECK(nothing.code == 1);
    CHECK(has(nothing.errors, "no governor of the scene states a bound"));
}

TEST_CASE("part of the repository's catalogue: every ladder has its heat-map, and failures solve nothing")
{
    const std::string where = folder("catalogue");
    auto suite = nlohmann::json::parse(read(scene_file("studies/suite.json")));
    nlohmann::json part = nlohmann::json::array();
    for (auto entry : suite["studies"])
        for (const char* name : {"projectile", "spring-stand", "swinging-rod", "gear-train", "bounce", "slide", "slope", "contact-spring"})
            if (entry["name"] == name)
            {
                entry["scene"] = scene_file("studies/" + entry["scene"].get<std::string>());
                entry["until"] = std::min(entry["until"].get<double>(), 1.0);
                for (auto& text : entry["vary"])
                    if (text.get<std::string>().starts_with("dt="))
                        text = name == std::string("spring-stand") ? "dt=1/60,1/960" : "dt=1/60,1/120";
                part.push_back(entry);
            }
    REQUIRE(part.size() == 8);
    suite["studies"] = part;
    const std::string copy = kFolder + "/part.json";
    std::ofstream(copy) << suite;
    const Outcome done = study({"--suite", copy, "--repeat", "1", "-o", where});
    REQUIRE_MESSAGE(done.code == 0, done.errors);
    CHECK(has(done.errors, "plab-study: 8 studies"));
    const auto json = nlohmann::json::parse(read(where + "/suite.json"));
    REQUIRE(json["studies"].size() == 8);
    for (const auto& s : json["studies"]) CHECK_MESSAGE(!s.contains("trouble"), s.dump());
    for (const auto& s : json["studies"])
    {
        if (s["name"] == "spring-stand")
        {
            CHECK(s["digits"]["Exponential"] > 9);
            CHECK(s["cpu_per_simulated_second"]["RungeKutta4"].is_null());
        }
        if (s["name"] == "bounce")
        {
            CHECK(s["digits"]["LocalRoot + Impulse"] > 12);
            CHECK(s["digits"]["LocalRoot + Rows"] > 12);
            CHECK(s["digits"]["None + Impulse"] < 3);
        }
        if (s["name"] == "gear-train") CHECK(s["digits"]["Graph"] > 12);
        if (s["name"] == "swinging-rod") CHECK(s["digits"]["RungeKutta4 + Hinge"] > s["digits"]["SemiImplicitEuler + Hinge"]);
    }
    for (const char* picture : {"digits-1.png", "profile-5.png", "digits-6.svg", "report.html"})
        CHECK_MESSAGE(std::filesystem::exists(where + "/" + picture), std::string(picture));
}

TEST_CASE("the catalogue of the repository can be read, and each of its plans holds")
{
    const auto json = nlohmann::json::parse(read(scene_file("studies/suite.json")));
    CHECK(json["studies"].size() >= 8);
    for (const auto& entry : json["studies"])
    {
        std::vector<std::string> arguments{scene_file("studies/" + entry["scene"].get<std::string>()), "--list"};
        for (const char* key : {"vary", "algorithms"})
            if (entry.contains(key))
                for (const auto& text : entry[key])
                    arguments.insert(arguments.end(), {key == std::string("vary") ? "--vary" : "--algorithm", text});
        const Outcome done = study(arguments);
        CHECK_MESSAGE(done.code == 0, entry["name"]);
        CHECK_MESSAGE(has(done.output, ", 0 refused"), entry["name"], ": ", done.output);
    }
}

TEST_CASE("wrong use ends with code 2, nothing to study with code 1, and both say what would be right")
{
    const std::string scene = scene_file("studies/projectile.xml");
    for (const auto& [arguments, code, word] : std::vector<std::tuple<std::vector<std::string>, int, std::string>>{
             {{}, 2, "needs a scene"},
             {{scene, "-o", "x"}, 2, "needs --until"},
             {{scene, "--until", "1"}, 2, "needs -o DIR"},
             {{scene, "--until", "nan", "-o", "x"}, 2, "positive number"},
             {{scene, "--until", "1", "-o", "x", "--vary", "dt"}, 2, "--vary needs"},
             {{scene, "--until", "1", "-o", "x", "--swap", "solver=x"}, 2, "STEP:ID=TYPE"},
             {{scene, "--until", "1", "-o", "x", "--swap", "0:solver=Nope"}, 2, "unknown type 'Solver/Nope'"},
             {{scene, "--until", "1", "-o", "x", "--swap", "0:slover=Exact"}, 2, "did you mean 'solver'"},
             {{scene, "--until", "1", "-o", "x", "--swap", "120:solver=Exact"}, 2, "the runs end at 1 s, before step 120"},
             {{scene, "--until", "1", "-o", "x", "--swap", "30:solver=Exact", "--vary", "dt=1/60,1/120"}, 2, "give a time"},
             {{scene, "--until", "1", "-o", "x", "--swap", "0.51s:solver=Exact", "--vary", "dt=1/60,1/120"}, 2, "no step of dt = "},
             {{scene, "--until", "1", "-o", "x", "--vary", "dt=1/60", "--vary", "dt=1/120"}, 2, "--vary dt is given twice"},
             {{scene, "--until", "1", "-o", "x", "--vary", "dt=1/60,1/60"}, 2, "the same value, given twice"},
             {{scene, "--until", "1", "-o", "x", "--scale", "nosuch.position=1"}, 1, "no quantity of that name is compared"},
             {{scene, "--until", "1", "-o", "x", "--reference", "none", "--reference-algorithm", "dt=1/60"},
              2,
              "requires --reference auto"},
             {{scene, "--until", "1", "-o", "x", "--suite", "y"}, 2, "leave SCENE out"},
             {{"nowhere.xml", "--until", "1", "-o", "x"}, 1, "nowhere.xml"},
             {{scene, "--until", "1", "-o", "x", "--reference", "exact:bounce"}, 1, "does not describe this scene"},
             {{scene, "--until", "1", "-o", "x", "--quantity", "bell.position"}, 1, "did you mean 'ball'"},
             {{scene, "--until", "1", "-o", "/dev/null/x", "--reference", "none", "--repeat", "1"}, 1, "/dev/null/x"}})
    {
        const Outcome done = study(arguments);
        CHECK_MESSAGE(done.code == code, done.errors);
        CHECK_MESSAGE(has(done.errors, word), done.errors);
    }
    CHECK(study({"--help"}).code == 0);
    CHECK(has(study({"--list-exact"}).output, "exact:kepler"));
    CHECK(has(study({scene, "--vary", "dt=1/30,1/60", "--vary", "solver=Nothing,RungeKutta4", "--list"}).output,
              "4 combinations, 2 refused"));
}

TEST_CASE("--suite without a file is the catalogue of this tree, also from elsewhere")
{
    const std::string here = std::filesystem::current_path().string();
    std::filesystem::create_directories(kFolder);
    std::filesystem::current_path(kFolder);
    const Outcome listed = study({"--suite", "--list", "--repeat", "1"});
    std::filesystem::current_path(here);
    CHECK_MESSAGE(listed.code == 0, listed.errors);
    CHECK_MESSAGE(has(listed.output, "22 studies, 583 combinations"), listed.output);
    CHECK_MESSAGE(!has(listed.output, "cannot be studied"), listed.output);
    CHECK(study({"--suite"}).code == 2);  // into no folder
}

TEST_CASE("a study that is interrupted writes nothing, says where it was, and ends with 130 or 143")
{
    for (const int signal : {2, 15})
    {
        const std::string where = folder("interrupted");
        Process process({program("plab-study"), scene_file("studies/stack.xml"), "--vary", "manager=SequentialImpulse,SoftStep,Direct",
                         "--vary", "dt=1/240,1/960", "--reference", "exact:rest", "--until", "1000", "-o", where});
        std::this_thread::sleep_for(Milliseconds(1500));
        process.signal(signal);
        CHECK(process.wait(Milliseconds(5000)) == 128 + signal);
        CHECK_MESSAGE(has(process.errors(), "interrupted while recording run 1 of 6; no result of this study is written"),
                      process.errors());
        CHECK(!std::filesystem::exists(where));
    }
}
