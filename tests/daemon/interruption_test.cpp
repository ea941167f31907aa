// plabd in the middle of a step that takes minutes: signals end it within a second, with a word and a code, and in good order.
#include <doctest/doctest.h>

#include <csignal>
#include <fstream>

#include "support/process.h"

using namespace plab;
using namespace plab::test;

namespace
{

using Clock = std::chrono::steady_clock;

/// From step 5 on each step takes minutes.
std::string long_scene()
{
    const std::string file = scratch_file("long_step.xml");
    std::ofstream(file) << R"(<plab version="1"><component id="axle" type="State/Shaft" inertia="1" angular_velocity="1"/>
      <component id="long" type="Script/Lua" driven="axle" instruction_budget="1000000000000"><param name="code">
      state = {n = 0} function drive(step) state.n = state.n + 1 if step.tick >= 5 then while true do end end end</param></component></plab>)";
    return file;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string read(const std::string& file)
{
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("SIGTERM and SIGINT end a step that takes minutes within a second; what is written is the state before it")
{
    for (const int signal : {SIGTERM, SIGINT})
    {
        const std::string out = scratch_file("long_step.json"), recording = scratch_file("long_step.mcap");
        Process plabd({program("plabd"), long_scene(), "--no-bus", "--until", "1", "--table", "--out", out, "--record", recording, "--overwrite"});
        // The table says what it is at while it lasts.
        REQUIRE_MESSAGE(plabd.wait_for("in work: step 5: drive", Milliseconds(10000)), plabd.output() + plabd.errors());
        const Clock::time_point begin = Clock::now();
        plabd.signal(signal);
        CHECK(plabd.wait(Milliseconds(5000)) == 128 + signal);
        CHECK(std::chrono::duration<double>(Clock::now() - begin).count() < 1);
        CHECK(has(plabd.errors(), "given up"));
        CHECK(has(plabd.errors(), "step 5"));
        CHECK(has(read(out), "\"step\": 5"));
        // The recording is whole, and ends there.
        const Outcome replay = run({program("plabd"), "--replay", recording, "--verify"});
        CHECK_MESSAGE(replay.code == 0, replay.output + replay.errors);
        CHECK(has(replay.output, "verified:"));
    }
}

TEST_CASE("a signal while a scene is loaded ends the program, and in a step that is short it waits for its end")
{
    Process plabd({program("plabd"), scene_file("fan_and_balloons.xml"), "--no-bus", "--rate", "real", "--table"});
    REQUIRE(plabd.wait_for("energy", Milliseconds(10000)));
    plabd.signal(SIGTERM);
    CHECK(plabd.wait(Milliseconds(2000)) == 0);
}
