// A step in progress is abandoned: the world returns to its state before the step, bit for bit, and continues as if nothing had
// happened.
#include <chrono>
#include <cstdio>
#include <thread>

#include "simulation/snapshot/compare.h"
#include "support/scene.h"

using namespace plab;
using namespace plab::simulation;
using plab::test::Scene;

namespace
{

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

std::string ball(int i, double x, double y, double z)
{
    char text[256];
    std::snprintf(text, sizeof text, R"(<component id="b%03d" type="State/RigidBody" mass="1" shape="r" position="%.17g %.17g %.17g"/>)", i,
                  x, y, z);
    return text;
}

/// Balls that fall on one another and on a floor, with a script that keeps state and parameters moving.
std::string pile(const std::string& resolution, const std::string& response)
{
    std::string out = R"(<component id="f" type="Shape/Plane"/><component id="ground" type="State/Static" shape="f"/>
      <component id="r" type="Shape/Sphere" radius="0.1"/><component id="g" type="Field/Gravity" between="*"/>)";
    for (int i = 0; i < 60; ++i) out += ball(i, 0.17 * (i % 4) + 0.003 * i, 0.17 * (i / 4 % 4), 0.15 + 0.22 * (i / 16));
    out += R"(<component id="axle" type="State/Shaft" inertia="1"/><component id="count" type="Script/Lua" driven="axle">
      <param name="code">state = {n = 0} function drive(step) state.n = state.n + 1 end function force(t, state) driven:add_torque(0.1 * state.n) end</param></component>)";
    return out + "<component id=\"c\" type=\"CDetection/ODE\" between=\"*\" resolution=\"" + resolution + "\" response=\"" + response +
           "\"/>";
}

/// A step in which a spring oscillates some millions of times: minutes of work.
Scene long_step(const std::string& solver = "Solver/DormandPrince54")
{
    return Scene(R"(<component id="r" type="Shape/Sphere" radius="0.1"/>
      <component id="a" type="State/RigidBody" mass="1" shape="r" position="1 0 0"/><component id="b" type="State/RigidBody" mass="1" shape="r"/>
      <component id="spring" type="Constraint/SpringDamper" a="a" b="b" length="0.5" stiffness="1e8"/>
      <component id="s" type=")" +
                     solver + R"(" max_substeps="10000000"/>)",
                 "dt=\"2000\" solver=\"s\"");
}

std::string differences_of(const Snapshot& a, const Snapshot& b)
{
    Comparison how;
    how.outputs = true, how.ledger = true, how.most = 5;
    std::string out;
    for (const Difference& d : differences(*a, *b, how)) out += d.text() + "\n";
    return out;
}

}  // namespace

TEST_CASE("a step that is abandoned at any time leaves no trace: the same bits before and after")
{
    for (const auto& [resolution, response] : {std::pair{"Resolution/LocalBisection", "Response/Impulse"},
                                               {"Resolution/None", "Response/Rows"},
                                               {"Resolution/None", "Response/Penalty"}})
    {
        INFO(std::string(resolution), " ", std::string(response));
        const std::string text = pile(resolution, response);
        Scene alone(text), disturbed(text);
        REQUIRE_MESSAGE(alone.loaded(), alone.error());
        alone.warnings_expected = disturbed.warnings_expected = true;
        alone.step(40), disturbed.step(40);
        int given_up = 0;
        for (int i = 0; i < 60; ++i)
        {
            const Snapshot before = disturbed.simulation().capture();
            Interruption interruption;
            disturbed.simulation().set_interruption(&interruption);
            // At a random time within the step, which depends on the machine: it must leave no trace.
            interruption.ask(std::chrono::microseconds(17 * i));
            const bool stepped = disturbed.simulation().step();
            CHECK(stepped != disturbed.simulation().gave_up());
            disturbed.simulation().set_interruption(nullptr);
            if (!stepped)
            {
                ++given_up;
                CHECK(disturbed.hash() == before->state_hash);
                const std::string different = differences_of(before, disturbed.simulation().capture());
                CHECK_MESSAGE(different.empty(), different);
                disturbed.step();
            }
            alone.step();
            REQUIRE_MESSAGE(disturbed.hash() == alone.hash(),
                            differences_of(alone.simulation().capture(), disturbed.simulation().capture()));
        }
        CHECK(given_up > 0);
        const std::string different = differences_of(alone.simulation().capture(), disturbed.simulation().capture());
        CHECK_MESSAGE(different.empty(), different);
    }
}

TEST_CASE("two equal scenes side by side move alike: no bit depends on where their memory lies")
{
    // In this scene a cached group system is dropped, and the next one gets its address; it has to look up its own forces all the same.
    const std::string text = pile("Resolution/LocalBisection", "Response/Impulse");
    Scene one(text), other(text);
    REQUIRE_MESSAGE(one.loaded(), one.error());
    one.warnings_expected = other.warnings_expected = true;
    for (int i = 0; i < 110; ++i)
    {
        one.step(), other.step();
        CAPTURE(i);
        REQUIRE_MESSAGE(one.hash() == other.hash(), differences_of(one.simulation().capture(), other.simulation().capture()));
    }
}

TEST_CASE("a step that takes minutes ends at once, and the world has its state before it")
{
    for (const char* solver : {"Solver/DormandPrince54", "Solver/Radau5"})
    {
        CAPTURE(solver);
        Scene s = long_step(solver);
        REQUIRE_MESSAGE(s.loaded(), s.error());
        const std::uint64_t before = s.hash();
        Interruption interruption;
        s.simulation().set_interruption(&interruption);
        interruption.ask(std::chrono::milliseconds(100));
        const Clock::time_point begin = Clock::now();
        CHECK(!s.simulation().step());
        CHECK(seconds_since(begin) < 1);
        CHECK(s.simulation().gave_up());
        CHECK(s.simulation().tick() == 0);
        CHECK(s.hash() == before);
        CHECK(s.simulation().events().empty());
    }
}

TEST_CASE("the progress of a long step can be read from another thread")
{
    Scene s = long_step();
    REQUIRE_MESSAGE(s.loaded(), s.error());
    CHECK(s.simulation().progress().read().activity == Activity::Nothing);
    Interruption interruption;
    s.simulation().set_interruption(&interruption);
    Progress::Reading seen;
    std::thread watcher(
        [&]
        {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            seen = s.simulation().progress().read();
            interruption.ask();
        });
    CHECK(!s.simulation().step());
    watcher.join();
    CHECK(seen.activity == Activity::Step);
    CHECK(seen.step == 0);
    CHECK(seen.work > 100);
    CHECK(seen.since_ns > 0);
    CHECK(s.simulation().progress().read().activity == Activity::Nothing);
}

TEST_CASE("a pile that continues from a snapshot of any step moves as without it: no bit depends on earlier steps")
{
    for (const char* manager : {"Direct", "SequentialImpulse", "SoftStep"})
    {
        CAPTURE(manager);
        std::string text = pile("Resolution/None", "Response/Rows");
        text = text.substr(0, text.rfind("/>")) + " response.manager=\"Manager/" + manager + "\"/>";
        Scene alone(text);
        REQUIRE_MESSAGE(alone.loaded(), alone.error());
        alone.warnings_expected = true;
        for (int i = 0; i < 110; ++i)
        {
            const Snapshot before = alone.simulation().capture();
            alone.step();
            if (i < 30) continue;  // nothing touches yet
            CAPTURE(i);
            Scene again(text);
            again.warnings_expected = true;
            REQUIRE(again.simulation().restore(before).ok());
            again.step();
            REQUIRE_MESSAGE(again.hash() == alone.hash(), differences_of(alone.simulation().capture(), again.simulation().capture()));
        }
    }
}
