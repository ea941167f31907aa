// plab-log in a process of its own.
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "played_server.h"
#include "support/process.h"
#include "support/text.h"

using namespace plab;
using namespace plab::test;
using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

namespace
{

Process start(const PlayedServer& server, std::vector<std::string> arguments)
{
    std::vector<std::string> all{program("plab-log"), "--domain", std::to_string(test_domain()), "--server", server.name()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    Process process(std::move(all));
    REQUIRE_MESSAGE(server.wait_for_logger(), process.errors());
    return process;
}

std::vector<Json> lines(const std::string& text)
{
    std::vector<Json> out;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) out.push_back(Json::parse(line));
    return out;
}

std::size_t lines_with(const std::string& text, const std::string& part)
{
    std::size_t count = 0;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) count += has(line, part) ? 1 : 0;
    return count;
}

}  // namespace

TEST_CASE("events and collisions are lines, in the order in which they happened")
{
    PlayedServer server(test_domain(), unique_name("log"), 1);
    Process log = start(server, {"-n", "6"});
    // A reader may miss the first sample of a writer that it has just discovered, and get it later. From here on none is lost.
    server.event("test.first", "here"), server.collisions("first", 1);
    REQUIRE(log.wait_for("test.first", 10s));
    REQUIRE(log.wait_for("collision.first", 10s));
    server.event("script.print", "spinning\x1b[31m");
    server.collisions("impact", 2);
    server.event("script.limit", "too long", "failure");
    REQUIRE(log.wait(10s) == 0);
    const std::string text = log.output();
    CHECK(
        text.starts_with("-- server '" + server.name() + "': process " + std::to_string(getpid()) + " on here, run 1, scene played.xml\n"));
    CHECK(has(text, "    0.0125 s  script.print          gears: spinning\\x1b[31m [0.5]\n"));
    CHECK(has(text, "    0.0167 s  collision.impact      red blue  at (1 2 3) m, impulse 0.5 N s\n"));
    CHECK(has(text, "failure: gears: too long [0.5]\n"));
    CHECK(text.find("script.print") < text.find("collision.impact"));
    CHECK(text.find("collision.impact") < text.find("script.limit"));
    CHECK(lines_with(text, "collision.impact") == 2);
}

TEST_CASE("lines of JSON have the fields of the wire format or of plabctl, and numbers without a gap")
{
    PlayedServer server(test_domain(), unique_name("log"), 1);
    Process log = start(server, {"--json", "--metrics", "--status", "-n", "5"});
    server.event("script.print", "a \"quote\"", "info", std::numeric_limits<double>::quiet_NaN());
    server.collisions("impact", 2);
    server.metrics(2.5);
    REQUIRE(log.wait(10s) == 0);
    Json event, metrics, status;
    std::vector<std::uint64_t> numbers;
    for (const Json& line : lines(log.output()))
    {
        if (line["type"] == "event") event = line;
        if (line["type"] == "metrics") metrics = line;
        if (line["type"] == "status") status = line;
        if (line["type"] == "collision") numbers.push_back(line["sequence_number"].get<std::uint64_t>());
    }
    CHECK(event["message"] == "a \"quote\"");
    CHECK(event["severity"] == "info");
    CHECK(event["values"] == Json::array({nullptr}));
    CHECK(event["sequence_number"] == 1);
    CHECK(event["step"] == 1);
    CHECK(numbers == std::vector<std::uint64_t>{1, 2});
    CHECK(metrics["energy"]["kinetic"] == 2.5);
    CHECK(metrics["interactions"]["gears"]["resolved"] == "B");
    CHECK(status["name"] == server.name());
    CHECK(status.contains("requests_done"));
}

TEST_CASE("missed entries have a line of their own, and so does a new run")
{
    PlayedServer server(test_domain(), unique_name("log"), 1);
    server.skip_events(100);  // before there was a reader: not missed
    Process log = start(server, {}), json = start(server, {"--json"});
    REQUIRE(log.wait_for("-- server", 10s));
    REQUIRE(json.wait_for("\"server\"", 10s));
    server.event("one", "first");
    server.skip_events(12);
    server.event("two", "second");
    server.begin_run(2);
    server.event("three", "third");
    REQUIRE(log.wait_for("third", 10s));
    REQUIRE(json.wait_for("third", 10s));
    log.signal(SIGINT), json.signal(SIGTERM);
    CHECK(log.wait(5s) == 130);
    CHECK(json.wait(5s) == 143);
    const std::string text = log.output();
    CHECK(has(text, "first [0.5]\n-- missed 12 events (numbers 102 to 113)\n"));
    CHECK(lines_with(text, "missed") == 1);
    CHECK(has(text, "second [0.5]\n-- run 2 begins: the scene was loaded or reset\n"));
    const auto all = lines(json.output());
    REQUIRE(all.size() == 6);
    CHECK(all[2].dump() == R"({"type":"gap","topic":"plab/events","missed":12,"first":102,"last":113})");
    CHECK(all[4].dump() == R"({"type":"run","run":2})");
}

TEST_CASE("kinds and severities select what is written; filtered entries do not count as missed")
{
    PlayedServer server(test_domain(), unique_name("log"), 1);
    Process impacts = start(server, {"--kind", "collision.impact"}), trouble = start(server, {"--severity", "warning"});
    REQUIRE(impacts.wait_for("-- server", 10s));
    REQUIRE(trouble.wait_for("-- server", 10s));
    server.event("script.print", "talk");
    server.event("rate.slip", "slow", "warning");
    server.collisions("begin", 1);
    server.collisions("impact", 1);
    server.event("script.limit", "dead", "failure");
    REQUIRE(impacts.wait_for("collision.impact", 10s));
    REQUIRE(trouble.wait_for("dead", 10s));
    CHECK(lines_with(impacts.output(), "") == 2);
    CHECK(lines_with(trouble.output(), "") == 3);
    CHECK(has(trouble.output(), "warning: gears: slow"));
}

TEST_CASE("a server may end and restart, or be replaced by another one of its name")
{
    const std::string name = unique_name("log");
    std::optional<PlayedServer> server(std::in_place, test_domain(), name, 1);
    Process log = start(*server, {"--json"});
    REQUIRE(log.wait_for("\"found\"", 10s));
    server->event("one", "of the first");
    server->event("one", "once more");
    REQUIRE(log.wait_for("once more", 10s));
    server->say_goodbye();
    server.reset();
    REQUIRE(log.wait_for("\"gone\"", 15s));
    server.emplace(test_domain(), name, 2);
    REQUIRE(log.wait_for("\"back\"", 10s));
    REQUIRE(server->wait_for_logger());
    server->event("one", "of the second");
    REQUIRE(log.wait_for("of the second", 10s));
    log.signal(SIGTERM);
    CHECK(log.wait(5s) == 143);
    // Its numbers start again: nothing was missed, no run was started.
    CHECK(!has(log.output(), "\"gap\""));
    CHECK(!has(log.output(), "\"run\",\"run\""));
}

TEST_CASE("--out appends, and -d ends it")
{
    PlayedServer server(test_domain(), unique_name("log"), 1);
    const std::string file = scratch_file("log.txt");
    std::ofstream(file) << "what was there\n";
    Process log = start(server, {"--out", file, "-d", "1.5"});
    server.event("one", "new");
    CHECK(log.wait(10s) == 0);
    std::stringstream text;
    text << std::ifstream(file).rdbuf();
    CHECK(text.str().starts_with("what was there\n-- server"));
    CHECK(has(text.str(), "gears: new"));
    CHECK(log.output().empty());
}

TEST_CASE("a closed pipe ends it quietly; a file that cannot be written is 1; no server is 3; wrong use is 2")
{
    PlayedServer server(test_domain(), unique_name("log"), 1);
    const std::string base = quoted(program("plab-log")) + " --domain " + std::to_string(test_domain()) + " --server " + server.name();
    Process pipe({"bash", "-c", base + " | head -n 1; exit ${PIPESTATUS[0]}"});
    REQUIRE(server.wait_for_logger());
    for (int i = 0; i < 50 && pipe.running(); ++i) server.event("one", "two"), std::this_thread::sleep_for(100ms);
    CHECK(pipe.wait(5s) == 0);
    CHECK(pipe.errors().empty());

    CHECK(run({program("plab-log"), "--out", "/no/such/folder/file"}, 10s).code == 1);
    const Outcome full = run({"bash", "-c", base + " -d 5 >/dev/full"}, 15s);
    CHECK(full.code == 1);
    CHECK(has(full.errors, "cannot write standard output"));
    const Outcome none =
        run({program("plab-log"), "--domain", std::to_string(test_domain()), "--server", "nobody", "--timeout", "0.3"}, 15s);
    CHECK(none.code == 3);
    CHECK(has(none.errors, "no server 'nobody'"));
    CHECK(run({program("plab-log"), "--severity", "loud"}, 10s).code == 2);
    CHECK(run({program("plab-log"), "-n", "0"}, 10s).code == 2);
    CHECK(has(run({program("plab-log"), "--help"}, 10s).output, "Examples:"));
}

TEST_CASE("plabctl log without a file writes the same lines, and both filter by kind and object")
{
    PlayedServer server(test_domain(), unique_name("log"), 1);
    const std::vector<std::string> choice{"--domain", std::to_string(test_domain()),
                                          "--server", server.name(),
                                          "--kind",   "script.",
                                          "--kind",   "collision.",
                                          "--object", "gears",
                                          "-n",       "1"};
    for (const std::vector<std::string>& command : {std::vector<std::string>{program("plab-log")}, {program("plabctl"), "log"}})
    {
        std::vector<std::string> all = command;
        all.insert(all.end(), choice.begin(), choice.end());
        Process log(std::move(all));
        REQUIRE_MESSAGE(server.wait_for_logger(), log.errors());
        // One of another kind; one of the right kind, but between other objects; then the wanted one.
        server.event("test.first", "here"), server.collisions("impact", 1);
        for (int i = 0; i < 50 && log.running(); ++i) server.event("script.print", "spinning"), std::this_thread::sleep_for(100ms);
        REQUIRE(log.wait(5s) == 0);
        CHECK(lines_with(log.output(), "script.print          gears: spinning [0.5]") == 1);
        CHECK(!has(log.output(), "test.first"));
        CHECK(!has(log.output(), "collision.impact"));
    }
}

TEST_CASE("a signal also ends the wait for a server")
{
    Process log({program("plab-log"), "--domain", std::to_string(test_domain()), "--server", "nobody", "--timeout", "0"});
    std::this_thread::sleep_for(500ms);
    CHECK(log.running());
    log.signal(SIGTERM);
    CHECK(log.wait(5s) == 143);
}
