// Scripts as forces: what a solver makes of Lua at every stage.
#include "support/scene.h"

using namespace plab;
using plab::test::distance;
using plab::test::Scene;

TEST_CASE("A6: Kepler with a script as the force, fourth order, e = 0.9")
{
    const auto error = [](int per_second)
    {
        Scene s(
            R"(<component id="planet" type="State/RigidBody" mass="1" inertia="1 1 1" position="0.1 0 0" linear_velocity="0 4.358898943540674 0"/>
                   <component id="sun" type="Script/Lua" driven="planet"><param name="code">
                   function force(t, state)
                       local r = driven.position
                       local d = r:length()
                       driven:add_force(r * (-1 / (d * d * d)))
                   end</param></component>)",
            "dt=\"1/" + std::to_string(per_second) + "\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(10);
        return distance(s.vec("planet", "position"), {-1.8538537094055792, -0.130885404839925551, 0});
    };
    const double coarse = error(4000), fine = error(8000);
    CHECK(fine < 1e-8);
    CHECK(std::log2(coarse / fine) == doctest::Approx(4).epsilon(0.1));
}

TEST_CASE("B3: quadratic drag in a script")
{
    Scene s(R"(<component id="ball" type="State/RigidBody" mass="1" inertia="1 1 1"/>
               <component id="g" type="Field/Gravity" between="ball"/>
               <component id="drag" type="Script/Lua" driven="ball"><param name="code">
               function force(t, state)
                   local v = driven.velocity
                   driven:add_force(v * (-0.01 * v:length()))
               end</param></component>)",
            "dt=\"1/240\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(5);
    CHECK(std::fabs(s.vec("ball", "linear_velocity").z + 28.7023194557054083) < 1e-10 * 29);
    CHECK(std::fabs(s.vec("ball", "position").z + 91.5600402510837169) < 1e-10 * 92);
    s.run(60);
    CHECK(std::fabs(s.vec("ball", "linear_velocity").z / -31.3209195267316505 - 1) < 1e-12);
}

TEST_CASE("a script that fails is quarantined by name and the rest of the scene continues")
{
    Scene s(R"(<component id="a" type="State/Shaft" inertia="1"/><component id="b" type="State/Shaft" inertia="1"/>
               <component id="good" type="Script/Lua" driven="a"><param name="code">function force(t, state) driven:add_torque(1) end</param></component>
               <component id="bad" type="Script/Lua" driven="b"><param name="code">
               function force(t, state) if t &gt; 0.5 then error("no more") end driven:add_torque(1) end</param></component>)",
            "dt=\"1/100\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = s.keep_events = true;
    s.run(1);
    CHECK(s.spin("a") == doctest::Approx(1).epsilon(1e-12));
    CHECK(s.spin("b") == doctest::Approx(0.5).epsilon(0.03));
    REQUIRE(s.count("script.error") == 1);
    for (const Event& e : s.events)
        if (e.kind == "script.error")
        {
            CHECK(s.simulation().world().id_of(e.component) == "bad");
            CHECK(e.message.find("no more") != std::string::npos);
            CHECK(e.message.find(":2:") != std::string::npos);
        }
}

TEST_CASE("drive changes declared state, sets parameters and emits events")
{
    Scene s(R"(<component id="a" type="State/Shaft" inertia="1"/>
               <component id="motor" type="Script/Lua" driven="a"><param name="state"><entry name="count">0</entry></param>
               <param name="parameters"><entry name="torque">2</entry></param>
               <param name="code">
               function drive(step)
                   state.count = state.count + 1
                   if step.tick == 50 then emit("half", "way", 1, 2) end
               end
               function force(t, state) driven:add_torque(parameters.torque) end</param></component>
               <component id="brake" type="Script/Lua"><param name="code">
               function drive(step) if step.tick == 50 then set("a", "inertia", 2) end end</param></component>)",
            "dt=\"1/100\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    s.run(1);
    CHECK(s.real("motor", "state.count") == 100);
    CHECK(s.count("half") == 1);
    CHECK(s.spin("a") == doctest::Approx(2 * 0.5 + 1 * 0.5).epsilon(1e-12));
}
