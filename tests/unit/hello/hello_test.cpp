#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "played_server.h"
#include "support/process.h"
#include "support/text.h"

using namespace plab::test;
using namespace std::chrono_literals;

namespace
{

/// The commands between ```sh and ``` of a README, block by block.
std::vector<std::string> shell_blocks(const std::string& file)
{
    std::vector<std::string> blocks;
    std::ifstream in(file);
    bool is_inside = false;
    for (std::string line; std::getline(in, line);)
    {
        if (line == "```sh") blocks.emplace_back();
        if (is_inside && line != "```") blocks.back() += line + "\n";
        is_inside = line == "```sh" || (is_inside && line != "```");
    }
    return blocks;
}

}  // namespace

TEST_CASE("plab-hello prints positions of the first body and ends")
{
    PlayedServer server(test_domain(), unique_name("hello"), 1);
    const std::vector<std::string> where{"PLAB_DOMAIN=" + std::to_string(test_domain()), "PLAB_SERVER=" + server.name()};
    Process hello({program("plab-hello"), "-n", "3"}, where);
    for (int i = 0; i < 500 && hello.running(); ++i) server.frame(1.5), std::this_thread::sleep_for(20ms);
    CHECK(hello.wait(5s) == 0);
    const std::string text = hello.output();
    CHECK(has(text, " s  body 4     0.000    0.000    1.500 m\n"));
    CHECK(std::count(text.begin(), text.end(), '\n') == 3);
    // The server runs, but sends no frames.
    const Outcome paused = run({program("plab-hello")}, 15s, where);
    CHECK(paused.code == 3);
    CHECK(has(paused.errors, "paused"));
}

TEST_CASE("plab-hello reports errors")
{
    const std::string domain = "PLAB_DOMAIN=" + std::to_string(test_domain());
    const Outcome none = run({program("plab-hello")}, 20s, {domain, "PLAB_SERVER=nobody"});
    CHECK(none.code == 3);
    CHECK(has(none.errors, "no server 'nobody'"));
    CHECK(run({program("plab-hello"), "-n", "0"}, 10s).code == 2);
    CHECK(run({program("plab-hello"), "--count"}, 10s).code == 2);
    CHECK(run({program("plab-hello")}, 10s, {"PLAB_DOMAIN=none"}).code == 2);
}

TEST_CASE("the README's lines build a program in C against the idl alone, and it receives")
{
    const auto blocks = shell_blocks(std::string(PLAB_SOURCE_DIR) + "/clients/hello/README.md");
    REQUIRE(blocks.size() == 2);
    const std::string out = scratch_file("hello_c");
    std::filesystem::create_directories(out);
    const Outcome built = run({"bash", "-ec", "OUT='" + out + "'; cd '" + PLAB_SOURCE_DIR + "'\n" + blocks[0]}, 60s);
    REQUIRE_MESSAGE(built.code == 0, built.errors);

    // As in the README, except for the name and the domain, which is this test's own.
    PlayedServer server(test_domain(), unique_name("hello"), 1);
    std::string script = blocks[1];
    const auto replace = [&](const std::string& from, const std::string& to)
    {
        const std::size_t at = script.find(from);
        REQUIRE(at != std::string::npos);
        script.replace(at, from.size(), to);
    };
    replace("<Domain>", "<Domain Id=\"" + std::to_string(test_domain()) + "\">");
    replace("hello plab", "hello " + server.name());
    Process hello({"bash", "-ec", "OUT='" + out + "'\n" + script}, {"CYCLONEDDS_URI"});
    for (int i = 0; i < 500 && hello.running(); ++i) server.frame(0.25), std::this_thread::sleep_for(20ms);
    CHECK_MESSAGE(hello.wait(5s) == 0, hello.errors());
    CHECK(has(hello.output(), " s  z = 0.250 m\n"));
}
