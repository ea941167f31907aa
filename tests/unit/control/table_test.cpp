// Tables on terminals of any width.
#include "plabctl.h"

using namespace plab::test;

namespace
{

std::vector<std::string> on_terminal(int columns, const std::string& arguments)
{
    const std::string file = temporary("pty");
    const std::string command = "stty cols " + std::to_string(columns) + " rows 20; NO_COLOR=1 timeout 30 " + PLAB_BINARY_DIR +
                                "/bin/plabctl --domain " + std::to_string(test_domain()) + " -s lab " + arguments;
    REQUIRE(std::system(("script -qec '" + command + "' /dev/null >" + file + " </dev/null").c_str()) == 0);
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
    // Prose goes before ids become unreadable.
    CHECK_FALSE(has(on_terminal(70, "interactions")[0], "participants"));
    CHECK(has(on_terminal(70, "interactions")[2], "contact.response"));
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
