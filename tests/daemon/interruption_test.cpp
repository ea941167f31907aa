// plabd in the middle of a step that takes minutes: signals end it within a second, with a word and a code, and in good order.
#include <doctest/doctest.h>

#include <csignal>
#include <fstream>

#include "support/process.h"
#include "support/text.h"

using namespace plab;
using namespace plab::test;

namespace
{

using Clock = std::chrono::steady_clock;

/// The first step takes minutes.
std::string long_scene()
{
    const std::string file = scratch_file("long_step.xml");
    std::ofstream(file) << R"(<plab version="1"><scene dt="2000" solver="s"/><component id="r" type="Shape/Sphere" radius="0.1"/>
      <component id="a" type="State/RigidBody" mass="1" shape="r" position="1 0 0"/><component id="b" type="State/RigidBody" mass="1" shape="r"/>
      <component id="spring" type="Constraint/SpringDamper" a="a" b="b" length="0.5" stiffness="1e8"/>
      <component id="s" type="Solver/DormandPrince54" max_substeps="10000000"/></plab>)";
    return file;
}

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
        Process plabd({program("plabd"), long_scene(), "--no-bus", "--until", "10000", "--table", "--out", out, "--record", recording,
                       "--overwrite"});
        // The table says what it is doing while it lasts.
        REQUIRE_MESSAGE(plabd.wait_for("in progress: step 0: advance", Milliseconds(10000)), plabd.output(), plabd.errors());
        const Clock::time_point begin = Clock::now();
        plabd.signal(signal);
        CHECK(plabd.wait(Milliseconds(5000)) == 128 + signal);
        CHECK(std::chrono::duration<double>(Clock::now() - begin).count() < 1);
        CHECK(has(plabd.errors(), "abandoned"));
        CHECK(has(plabd.errors(), "step 0"));
        CHECK(has(read(out), "\"step\": 0"));
        // The recording is whole.
        const Outcome info = run({program("plabd"), "--replay", recording});
        CHECK_MESSAGE(info.code == 0, info.output, info.errors);
        CHECK(!has(info.errors, "not closed"));
    }
}

TEST_CASE("a signal while a scene is loaded ends the program, and in a step that is short it waits for its end")
{
    Process plabd({program("plabd"), scene_file("fan_and_balloons.xml"), "--no-bus", "--rate", "real", "--table"});
    REQUIRE(plabd.wait_for("energy", Milliseconds(10000)));
    plabd.signal(SIGTERM);
    CHECK(plabd.wait(Milliseconds(2000)) == 0);
}
