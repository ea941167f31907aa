#include "control/recording/player/control.h"

#include <doctest/doctest.h>

using namespace plab::player;
using Kind = ControlCommand::Kind;

TEST_CASE("lines become commands, also when they arrive in pieces")
{
    ControlLines lines;
    CHECK(lines.take("pau").empty());
    const auto commands = lines.take("se\nseek 2.5\nrate 0.25\nresume\nend\nse");
    REQUIRE(commands.size() == 5);
    for (const auto& command : commands) REQUIRE(command.ok());
    CHECK(commands[0].value().kind == Kind::Pause);
    CHECK(commands[1].value().kind == Kind::Seek);
    CHECK(commands[1].value().value == 2.5);
    CHECK(commands[2].value().kind == Kind::Rate);
    CHECK(commands[2].value().value == 0.25);
    CHECK(commands[3].value().kind == Kind::Resume);
    CHECK(commands[4].value().kind == Kind::End);
    REQUIRE(lines.take("ek 1\n").size() == 1);
}

TEST_CASE("what is no command is refused with its text, and what comes behind it is read")
{
    for (const char* line :
         {"", "stop", "pause now", "seek", "seek -1", "seek x", "seek nan", "seek 1e300", "rate 0", "rate -1", "rate 1e4"})
    {
        INFO(line);
        const auto command = parse_control(line);
        REQUIRE_FALSE(command.ok());
        CHECK(command.error().reason.starts_with("'" + std::string(line) + "' is no command"));
    }
    ControlLines lines;
    const auto commands = lines.take(std::string(100'000, 'x') + "\npause\n");
    REQUIRE(commands.size() == 2);
    CHECK(commands[0].error().reason == "a line of more than 256 bytes is no command");
    CHECK(commands[1].ok());
}
