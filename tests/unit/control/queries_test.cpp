// What plabctl prints about a server: lists, show, wait.
#include "plabctl.h"

using namespace plab::test;

TEST_CASE("the command servers lists those of the domain, and it is an error if there are none")
{
    const Outcome none = plabctl("servers --json");
    CHECK(none.code == 3);
    CHECK(none.json()["servers"].empty());
    CHECK(has(none.err, "no server was found in domain " + std::to_string(test_domain())));
    FakeServer one(test_domain(), "one"), two(test_domain(), "two");
    const Outcome both = plabctl("servers --json");
    CHECK(both.code == 0);
    REQUIRE(both.json()["servers"].size() == 2);
    CHECK(both.json()["servers"][0]["name"] == "one");
    CHECK(both.json()["servers"][1]["process"] == 42);
    const Outcome table = plabctl("servers");
    CHECK(has(table.out, "scene.xml"));
    CHECK(!has(table.out, "note"));
    CHECK(both.json()["servers"][1]["recording"].is_null());
    two.fill_disk();
    const auto reported = [&]
    { return has(plabctl("servers").out, "recording is stalled: no space left on device; 3 messages not recorded"); };
    bool is_reported = reported();
    for (int i = 0; i < 10 && !is_reported; ++i) is_reported = reported();
    CHECK(is_reported);
    CHECK(plabctl("servers --json").json()["servers"][1]["recording"]["dropped"] == 3);
}

TEST_CASE("a server is found by its name, or because it is the only one")
{
    FakeServer lab(test_domain(), "lab");
    CHECK(plabctl("objects").code == 0);
    CHECK(plabctl("objects", "PLAB_SERVER=lab").code == 0);
    const Outcome wrong = plabctl("objects --server lap --timeout 0.5");
    CHECK(wrong.code == 3);
    CHECK(has(wrong.err, "no server 'lap' was found"));
    CHECK(has(wrong.err, "there are: lab"));
    FakeServer other(test_domain(), "other");
    const Outcome unclear = plabctl("objects");
    CHECK(unclear.code == 3);
    CHECK(has(unclear.err, "there are several servers (lab, other)"));
    CHECK(plabctl("objects -s other").code == 0);
}

TEST_CASE("the command objects shows the present positions")
{
    FakeServer server(test_domain(), "lab");
    const Json json = lab("objects --json").json();
    CHECK(json["server"] == "lab");
    REQUIRE(json["objects"].size() == 2);
    CHECK(json["objects"][1]["id"] == "red");
    CHECK(json["objects"][1]["kind"] == "body");
    CHECK(json["objects"][1]["position"] == Json({1.4, 0.3, 1.0}));
    CHECK(json["objects"][1]["state"]["position"] == Json({1.5, 0.25, 1.0}));
    CHECK(json["objects"][0]["inertia"] == 0.005);
    CHECK(json["objects"][0]["state"]["angle"] == 3.25);
    CHECK(json["objects"][0]["color"].is_null());
    const Outcome table = lab("objects");
    REQUIRE(table.lines().size() == 3);
    CHECK(table.lines()[0].starts_with("object"));
    CHECK(has(table.lines()[1], "a_fan_with_a_very_long_name"));
    CHECK(has(table.lines()[1], "40 rad/s"));
    CHECK(has(table.lines()[2], "0.5 m/s"));
    CHECK(table.err.empty());
}

TEST_CASE("a table fits the terminal; without a terminal nothing is cut")
{
    FakeServer server(test_domain(), "lab");
    const std::string command = quoted(std::string(PLAB_BINARY_DIR) + "/bin/plabctl") + " --domain " + std::to_string(test_domain());
    const std::string file = temporary("pty");
    const auto on_terminal = [&](const std::string& environment, const std::string& arguments)
    {
        const std::string inner = "stty cols 72 rows 20; " + environment + " timeout 30 " + command + " " + arguments;
        REQUIRE(std::system(("script -qec " + quoted(inner) + " /dev/null >" + quoted(file) + " </dev/null").c_str()) == 0);
        return Outcome{0, take_text(file), ""};
    };
    const Outcome plain = on_terminal("NO_COLOR=1 TERM=xterm", "interactions");
    for (const std::string& line : plain.lines()) CHECK_MESSAGE(line.size() <= 73, line);  // and a carriage return
    CHECK_FALSE(has(plain.out, "\x1b"));
    const Outcome objects = on_terminal("TERM=dumb", "objects");
    CHECK_FALSE(has(objects.out, "a_fan_with_a_very_long_name"));
    CHECK(has(objects.out, "a_f"));
    CHECK(has(objects.out, "ame"));
    CHECK_FALSE(has(objects.out, "\x1b"));
    CHECK(has(on_terminal("TERM=xterm", "interactions").out, "\x1b[1m"));
    CHECK(has(lab("interactions", "COLUMNS=20").out, "between red a_fan_with_a_very_long_name"));
    CHECK(has(lab("interactions --color always").out, "\x1b[31m"));
}

TEST_CASE("the command interactions joins the catalogue with the metrics")
{
    FakeServer server(test_domain(), "lab");
    const Json json = lab("interactions --json").json();
    REQUIRE(json["interactions"].size() == 2);
    const Json& response = json["interactions"][1];
    CHECK(response["id"] == "contact.response");
    CHECK(response["metrics"]["cost_ns"] == 250);
    CHECK(response["metrics"]["work"] == -0.5);
    CHECK(response["quarantined"] == true);
    CHECK(json["interactions"][0]["roles"]["between"][0] == "red");
    const Outcome table = lab("interactions");
    CHECK(has(table.out, "1.2 us"));
    CHECK(has(table.out, "quarantined"));
}

TEST_CASE("the command top shows the costliest first, their share of the step, and the past as a curve")
{
    FakeServer server(test_domain(), "lab");
    const Outcome twice = lab("top --every 0.2 -n 3");
    CHECK(twice.code == 0);
    const std::vector<std::string> lines = twice.lines();
    REQUIRE(lines.size() == 3 * 8);  // a head of 3 lines, a blank one, a title, two rows, a blank one
    const std::size_t last = lines.size() - 8;
    CHECK(has(lines[last], "lab  running"));
    CHECK(has(lines[last + 1], "step    8.6 us"));
    CHECK(has(lines[last + 1], "▁▁▁"));
    CHECK(has(lines[last + 2], "unexplained 1e-12 J"));
    CHECK(lines[last + 5].starts_with("contact "));
    CHECK(has(lines[last + 5], "14 %"));  // 1234 of 8600 ns
    CHECK(has(lines[last + 6], "quarantined"));
    CHECK(lab("top --by error -n 1 --json").json()["interactions"][0]["id"] == "contact.response");
    CHECK(lab("top --by work -n 1 --json").json()["interactions"][0]["id"] == "contact.response");
    CHECK(lab("top --by name -n 1 --json").json()["interactions"][0]["id"] == "contact");
    const Outcome wrong = lab("top --by costs");
    CHECK(wrong.code == 2);
    CHECK(has(wrong.err, "did you mean 'cost'"));
}

TEST_CASE("the command top ends after -d, and says so if the server ends")
{
    CHECK(plabctl("top --timeout 0.2").code == 3);
    auto server = std::make_unique<FakeServer>(test_domain(), "lab");
    CHECK(lab("top --every 0.1 -d 0.35").code == 0);
    std::thread ending([&] { std::this_thread::sleep_for(std::chrono::seconds(1)), server.reset(); });
    const Outcome gone = lab("top --every 10");
    ending.join();
    CHECK(gone.code == 3);
    CHECK(has(gone.err, "server 'lab' has gone"));
}

TEST_CASE("the command types selects by part of a name, by family, or by what can replace a component")
{
    FakeServer server(test_domain(), "lab");
    CHECK(lab("types --json").json()["types"].size() == 6);
    CHECK(lab("types response --json").json()["types"].size() == 2);
    CHECK(lab("types --family State --json").json()["types"].size() == 2);
    const Json rivals = lab("types --for contact.response --json").json()["types"];
    REQUIRE(rivals.size() == 2);
    CHECK(rivals[1]["name"] == "Response/None");
    CHECK(rivals[1]["roles"][0]["most"].is_null());
    const Outcome unknown = lab("types --for contact.respond");
    CHECK(unknown.code == 1);
    CHECK(has(unknown.err, "did you mean 'contact.response'?"));
}

TEST_CASE("the command show prints everything known about a component")
{
    FakeServer server(test_domain(), "lab");
    const Outcome red = lab("show red");
    CHECK(has(red.out, "red  body, State/RigidBody"));
    CHECK(has(red.out, "1.5 0.25 1 m"));
    CHECK(has(red.out, "balloon"));
    CHECK(has(lab("show balloon").out, "0.15 m"));
    const Outcome response = lab("show contact.response");
    CHECK(has(response.out, "how much it bounces"));
    CHECK(has(response.out, "must be from 0 to 1"));
    CHECK(has(response.out, "  function f()\n  end\n"));
    CHECK_FALSE(has(response.out, "\x1b"));  // it was part of the name
    CHECK(has(lab("show Response/None").out, "2 or more"));
    const Json json = lab("show contact.response --json").json();
    CHECK(json["kind"] == "interaction");
    CHECK(json["parameters"]["restitution"]["text"] == "0.8");
    CHECK(json["type_info"]["fields"][0]["fallback"] == "0.5");
    const Outcome unknown = lab("show rad");
    CHECK(unknown.code == 1);
    CHECK(has(unknown.err, "no object, shape, interaction or type 'rad', did you mean 'red'?"));
}

TEST_CASE("the command wait waits for readiness or for a step, and not for ever")
{
    CHECK(plabctl("wait --timeout 0.5").code == 3);
    FakeServer server(test_domain(), "lab");
    const Outcome ready = plabctl("wait --json");
    CHECK(ready.code == 0);
    const auto step = ready.json()["step"].get<std::int64_t>();
    const Outcome later = plabctl("wait --json --step " + std::to_string(step + 200));
    CHECK(later.code == 0);
    CHECK(later.json()["step"].get<std::int64_t>() >= step + 200);
    CHECK(plabctl("wait --time 0.5").code == 0);
    CHECK(plabctl("wait --step 1 --timeout 1e8").code == 0);  // 292 years would overflow a count of nanoseconds
    const Outcome never = plabctl("wait --step 1000000000 --timeout 0.7");
    CHECK(never.code == 3);
    CHECK(has(never.err, "did not reach it within the time-out"));
}

TEST_CASE("why a component has its level: with the cost and the error of the levels beside it, as far as they are known")
{
    FakeServer server(test_domain(), "lab");
    const Outcome why = plabctl("why contact");
    CHECK(why.code == 0);
    CHECK(has(why.out, "there is room"));
    CHECK(has(why.out, "2 of 4, counted from the cheapest"));
    CHECK(has(why.out, "CDetection/Coarse: error 0.25 m against the next finer level, 2.0 us for a step of it alone"));
    CHECK(has(why.out, "CDetection/ODE: error 0.003 m against the next finer level"));
    CHECK(has(why.out, "CDetection/Fine: error not known, 50.0 us for a step of it alone"));
    CHECK_FALSE(has(why.out, "CDetection/Finest"));  // two levels away
    const std::string change = "cost 2.0 us -> 8.0 us, error unknown -> 0.003 m";
    CHECK(has(why.out, "CDetection/Coarse; " + change));
    CHECK(has(plabctl("levels contact").out, "there is room; " + change));
    const auto json = plabctl("why contact --json").json();
    REQUIRE(json["tried"].size() == 4);
    CHECK(json["last_change"]["from"] == "CDetection/Coarse");
    CHECK(json["last_change"]["cost_after"] == 8e-6);
    CHECK(json["last_change"]["error_before"].is_null());
    CHECK(json["tried"][0]["cost"] == 2e-6);
    CHECK(json["tried"][1]["cost"].is_null());
    CHECK(json["tried"][1]["error"] == 0.003);
    CHECK(json["tried"][1]["error_unit"] == "m");
    CHECK(plabctl("why red").code != 0);
}
