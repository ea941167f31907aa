// Streams, help and the command line itself.
#include "plabctl.h"

using namespace plab::test;

TEST_CASE("the command watch prints one JSON object on each line and ends by count")
{
    FakeServer server(test_domain(), "lab");
    const Outcome events = lab("watch events -n 3 --json");
    CHECK(events.code == 0);
    REQUIRE(events.lines().size() == 3);
    const Json first = Json::parse(events.lines()[0]), second = Json::parse(events.lines()[1]);
    CHECK(first["kind"] == "script.print");
    CHECK(second["sequence_number"] == first["sequence_number"].get<std::uint64_t>() + 1);
    const Outcome collisions = lab("watch collisions -n 1 --json");
    CHECK(collisions.json()["impulse"] == Json({0.0, 0.0, 0.002}));
    const Outcome states = lab("watch states -n 2 --json");
    REQUIRE(states.lines().size() == 2);
    CHECK(Json::parse(states.lines()[0])["bodies"]["red"]["position"][0] == 1.5);
    CHECK(Json::parse(states.lines()[0])["shafts"]["a_fan_with_a_very_long_name"]["speed"] == 40);
    const Outcome metrics = lab("watch metrics -n 1 --json");
    CHECK(metrics.json()["energy"]["kinetic"] == 5);
    CHECK(metrics.json()["interactions"]["contact"]["cost_ns"] == 1234);
}

TEST_CASE("watch in readable form, thinned out and filtered")
{
    FakeServer server(test_domain(), "lab");
    CHECK(has(lab("watch events -n 1").out, "warning  script.print  wind: it blows"));
    CHECK(has(lab("watch collisions -n 1").out, "red - green"));
    CHECK(has(lab("watch metrics -n 1").out, "8.6 us a step"));
    const Outcome clutch = lab("watch events -n 3 --only clutch --json");
    for (const std::string& line : clutch.lines()) CHECK(Json::parse(line)["component"] == "clutch");
    CHECK(clutch.lines().size() == 3);
    const Outcome states = lab("watch states -n 3 --every 0.5 --only red --json");
    REQUIRE(states.lines().size() == 3);
    const double a = Json::parse(states.lines()[0])["time"], b = Json::parse(states.lines()[1])["time"];
    CHECK(b - a > 0.4);
    CHECK(Json::parse(states.lines()[0])["shafts"].empty());
}

TEST_CASE("watch contacts prints a line for each point, or one JSON object for each sample; --only chooses pairs")
{
    FakeServer server(test_domain(), "lab");
    const std::string text = lab("watch contacts -n 1").out;
    CHECK_MESSAGE(has(text, "2 pairs  7 points with 2.5 N are not sent"), text);
    CHECK_MESSAGE(has(text, "impact"), text);
    CHECK_MESSAGE(has(text, "asleep"), text);
    const Json all = lab("watch contacts -n 1 --json").json();
    CHECK(all["left_out"] == 7);
    REQUIRE(all["entries"].size() == 2);
    CHECK(all["entries"][0]["points"][0]["normal_force"] == 3.5);
    CHECK(all["entries"][0]["points"][0]["friction_force"] == Json({0.25, 0.0, 0.0}));
    CHECK(all["entries"][0]["points"][1]["is_impact"] == true);
    const Json some = lab("watch contacts --only floor -n 1 --json").json();
    REQUIRE(some["entries"].size() == 1);
    CHECK(some["entries"][0]["a"] == "floor");
    const Outcome thin = lab("watch contacts --every 0.5 -n 2 --json");
    REQUIRE(thin.lines().size() == 2);
    CHECK(Json::parse(thin.lines()[1])["time"].get<double>() - Json::parse(thin.lines()[0])["time"].get<double>() > 0.4);
}

TEST_CASE("watch --only with an unknown name: refused if it can never match, noted if the component may be added later")
{
    FakeServer server(test_domain(), "lab");
    const Outcome states = lab("watch states --only rde -n 1");
    CHECK(states.code == 1);
    CHECK_MESSAGE(has(states.err, "no object 'rde', did you mean 'red'?; there are: a_fan_with_a_very_long_name, red"), states.err);
    CHECK(states.out.empty());
    // An interaction has no state, and a body no cost.
    CHECK(has(lab("watch states --only red --only contact -n 1").err, "no object 'contact'"));
    CHECK(has(lab("watch metrics --only red -n 1").err, "no interaction 'red'"));
    CHECK(lab("watch metrics --only contact -n 1").code == 0);
    const Outcome later = lab("watch collisions --only nobody -d 0.5");
    CHECK(later.code == 0);
    CHECK_MESSAGE(has(later.err, "no component 'nobody'; it will be shown if it is added later"), later.err);
    CHECK(lab("watch collisions --only red -n 1").err.empty());
}

TEST_CASE("watch ends by duration with 0, by Ctrl-C with 130, and when the server ends with 3")
{
    auto server = std::make_unique<FakeServer>(test_domain(), "lab");
    CHECK(lab("watch events -d 0.3 --json").code == 0);
    CHECK(lab("watch events", "timeout --preserve-status -s INT 1").code == 130);
    CHECK(lab("watch events", "timeout --preserve-status -s TERM 1").code == 143);
    std::thread ends(
        [&]
        {
            std::this_thread::sleep_for(std::chrono::milliseconds(900));
            server.reset();
        });
    const Outcome gone = lab("watch events");
    ends.join();
    CHECK(gone.code == 3);
    CHECK(has(gone.err, "server 'lab' has gone"));
}

TEST_CASE("missed numbers are reported")
{
    FakeServer server(test_domain(), "lab");
    std::thread skips(
        [&]
        {
            std::this_thread::sleep_for(std::chrono::milliseconds(1000));
            server.skip_numbers(5);
        });
    const Outcome events = lab("watch events -d 1.5 --json");
    skips.join();
    CHECK(events.code == 0);
    CHECK(has(events.err, "missed 5 events before number"));
}

TEST_CASE("wrong use ends with 2, and the message says what would be right")
{
    CHECK(plabctl("").code == 2);
    const Outcome command = plabctl("objcts");
    CHECK(command.code == 2);
    CHECK(has(command.err, "no command 'objcts', did you mean 'objects'?"));
    const Outcome option = plabctl("objects --jsn");
    CHECK(option.code == 2);
    CHECK(has(option.err, "did you mean '--json'?"));
    const Outcome stream = plabctl("watch event");
    CHECK(stream.code == 2);
    CHECK(has(stream.err, "did you mean 'events'?"));
    CHECK(plabctl("swap contact").code == 2);
    CHECK(plabctl("swap contact --to T --param x").code == 2);
    CHECK(plabctl("push red").code == 2);
    CHECK(plabctl("step 0").code == 2);
    CHECK(plabctl("objects --timeout -1").code == 2);
    CHECK(plabctl("objects --server 'a b'").code == 2);
    CHECK(plabctl("objects --color red").code == 2);
    CHECK(shell("PLAB_DOMAIN=many", "objects").code == 2);
}

TEST_CASE("help shows examples before options")
{
    const Outcome help = plabctl("--help");
    CHECK(help.code == 0);
    CHECK(help.out.find("plabctl swap contact.response") < help.out.find("--timeout"));
    CHECK(has(help.out, "Exit codes: 0 done"));
    for (const char* command :
         {"servers", "objects", "interactions", "types", "show",  "watch", "add", "remove", "swap",     "set",   "push",
          "pause",   "resume",  "step",         "rate",  "reset", "load",  "dt",  "wait",   "shutdown", "topics"})
    {
        CAPTURE(command);
        CHECK(has(help.out, std::string("\n  ") + command + " "));
        const Outcome own = plabctl(std::string(command) + " --help");
        CHECK(own.code == 0);
        CHECK(has(own.out, std::string("plabctl ") + command));
    }
    CHECK(has(plabctl("--version").out, "plabctl "));
}
