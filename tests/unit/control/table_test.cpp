// Tables on terminals of any width.
#include "plabctl.h"

using namespace plab::test;

namespace
{

std::vector<std::string> on_terminal(int columns, const std::string& arguments)
{
    const std::string file = temporary("pty");
    const std::string command = "stty cols " + std::to_string(columns) + " rows 20; NO_COLOR=1 timeout 30 " +
                                quoted(std::string(PLAB_BINARY_DIR) + "/bin/plabctl") + " --domain " + std::to_string(test_domain()) +
                                " -s lab " + arguments;
    REQUIRE(std::system(("script -qec " + quoted(command) + " /dev/null >" + quoted(file) + " </dev/null").c_str()) == 0);
    std::vector<std::string> lines = Outcome{0, take_text(file), ""}.lines();
    for (std::string& line : lines) line.erase(line.find_last_not_of('\r') + 1);
    return lines;
}

}  // namespace

TEST_CASE("no line is wider than the terminal, however narrow, and none is lost")
{
    FakeServer server(test_domain(), "lab");
    for (const int columns : {200, 100, 80, 60})
    {
        CAPTURE(columns);
        const std::vector<std::string> lines = on_terminal(columns, "interactions");
        CHECK(lines.size() == 3);
        for (const std::string& line : lines) CHECK_MESSAGE(line.size() <= static_cast<std::size_t>(columns), line);
    }
    CHECK(has(on_terminal(200, "interactions")[0], "participants"));
    CHECK(has(on_terminal(200, "interactions")[1], "between red a_fan_with_a_very_long_name"));
    // Prose is dropped before ids become unreadable.
    CHECK_FALSE(has(on_terminal(70, "interactions")[0], "participants"));
    CHECK(has(on_terminal(70, "interactions")[2], "contact.response"));
}

TEST_CASE("every list fits 40, 60 and 80 columns; the least important columns are dropped first")
{
    FakeServer server(test_domain(), "lab");
    for (const int columns : {40, 60, 80})
        for (const char* list : {"objects", "servers", "interactions", "types", "topics"})
        {
            CAPTURE(columns);
            CAPTURE(list);
            const std::vector<std::string> lines = on_terminal(columns, list);
            CHECK(lines.size() >= 2);
            for (const std::string& line : lines) CHECK_MESSAGE(line.size() <= static_cast<std::size_t>(columns), line);
        }
    const std::vector<std::string> narrow = on_terminal(40, "objects");
    CHECK(has(narrow[0], " z"));
    CHECK(has(narrow[2], "red "));
    CHECK(has(narrow[2], "1.500  0.250  1.000"));
    CHECK_FALSE(has(narrow[0], "motion"));
    CHECK(has(on_terminal(40, "servers")[1], "running"));
    CHECK_FALSE(has(on_terminal(40, "servers")[0], "version"));
    CHECK(has(on_terminal(200, "objects")[0], "motion"));
    CHECK(has(on_terminal(200, "servers")[0], "version"));
    CHECK(on_terminal(10, "objects")[0].size() <= 10);
}

TEST_CASE("note and participants are below their titles")
{
    FakeServer server(test_domain(), "lab");
    const std::vector<std::string> lines = on_terminal(200, "interactions");
    CHECK(lines[0].find("participants") == lines[1].find("between red"));
    CHECK(lines[0].find("note") == lines[2].find("quarantined"));
}

TEST_CASE("show wraps its prose instead of cutting it")
{
    FakeServer server(test_domain(), "lab");
    const std::vector<std::string> lines = on_terminal(60, "show contact.response");
    std::string text;
    for (const std::string& line : lines)
    {
        CHECK_MESSAGE(line.size() <= 60, line);
        text += line + "\n";
    }
    CHECK_FALSE(has(text, ".."));
    CHECK(has(text, "must be from"));
    CHECK(has(text, "bounces"));
}
