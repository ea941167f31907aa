// What scripts can read and do: participants, vectors, drive's effects, force's purity, failures.
#include <doctest/doctest.h>

#include <limits>

#include "lab.h"

using namespace plab;
using scripts::test::Lab;

TEST_CASE("a script reads its driver's speed and turns its driven shaft")
{
    Lab lab("function force(t, state) driven:add_torque(parameters.k * (driver.speed - driven.speed)) end");
    lab.rows.parameters[0] = {{"k", 0.5}};
    lab.rows.driver[0] = Lab::kShaft0, lab.rows.driven[0] = Lab::kShaft1;
    REQUIRE(lab.prepare() == "");
    lab.shafts.speed = {10, 4};
    lab.force();
    CHECK(lab.wrenches.shaft_torque[1] == 3.0);
    CHECK(lab.wrenches.shaft_torque[0] == 0.0);
    CHECK(lab.power[7] == 12.0);
    CHECK(lab.events.all.empty());
}

TEST_CASE("a script sees the values of the stage, not those of the last call")
{
    Lab lab("function force(t, state) driven:add_torque(-driven.angle * 100 + t) end");
    lab.rows.driven[0] = Lab::kShaft0;
    REQUIRE(lab.prepare() == "");
    lab.shafts.angle[0] = 0.25;
    lab.force();
    CHECK(lab.wrenches.shaft_torque[0] == -25.0);
    lab.shafts.angle[0] = 0.5, lab.context.time = 1;
    lab.force();
    CHECK(lab.wrenches.shaft_torque[0] == -49.0);
}

TEST_CASE("forces on bodies act at their points")
{
    Lab lab(R"lua(
        function force(t, state)
            between[1]:add_force(vec(1, 2, 3))
            between[2]:add_force_at(vec(0, 0, 2), between[2].position + vec(1, 0, 0))
            between[2]:add_torque(vec(5, 0, 0))
        end)lua");
    lab.rows.between[0] = {Lab::kBody0, Lab::kBody1};
    REQUIRE(lab.prepare() == "");
    lab.bodies.position[1] = {3, 3, 3};
    lab.force();
    CHECK(lab.wrenches.force[0] == Vec3{1, 2, 3});
    CHECK(lab.wrenches.torque[0] == Vec3{0, 0, 0});
    CHECK(lab.wrenches.force[1] == Vec3{0, 0, 2});
    CHECK(lab.wrenches.torque[1] == Vec3{5, -2, 0});  // (1 0 0) x (0 0 2) = (0 -2 0)
}

TEST_CASE("vectors and rotations follow their algebra")
{
    Lab lab(R"lua(
        function drive(step)
            local a, b = vec(1, 2, 3), vec(4, 5, 6)
            assert(a + b == vec(5, 7, 9) and b - a == vec(3, 3, 3) and -a == vec(-1, -2, -3))
            assert(a * 2 == 2 * a and a * 2 == vec(2, 4, 6) and a / 2 == vec(.5, 1, 1.5))
            assert(a:dot(b) == 32 and a:cross(b) == vec(-3, 6, -3))
            assert(vec(3, 4, 12):length() == 13 and vec(0, 0, 2):normalized() == vec(0, 0, 1))
            assert(a.x == 1 and a.y == 2 and a.z == 3 and a ~= b and a ~= 1)
            assert(tostring(vec(1, 2.5, -3)) == "vec(1, 2.5, -3)")
            assert(not pcall(function() return a * b end) and not pcall(function() a.x = 4 end))
            assert(not pcall(function() return a + 1 end) and not pcall(function() return a.w end))
            local q = driven.orientation
            assert(q.w == 0 and q.z == 1 and q:rotate(a) == vec(-1, -2, 3) and q:rotate_back(q:rotate(b)) == b)
            state.done = true
        end)lua");
    lab.rows.driven[0] = Lab::kBody0;
    lab.rows.state[0] = {{"done", false}};
    lab.bodies.orientation[0] = {0, 0, 0, 1};
    REQUIRE(lab.prepare() == "");
    lab.drive();
    CHECK(lab.events.all.empty());
    CHECK(std::get<bool>(lab.rows.state[0][0].value));
}

TEST_CASE("bodies and shafts have their documented fields")
{
    Lab lab(R"lua(
        function drive(step)
            local b, s = between[1], between[2]
            state.sum = b.mass + b.position.x + b.velocity.y + b.angular_velocity.z + s.angle + s.speed + s.inertia
            state.count = #between
            for i, p in ipairs(between) do state.count = state.count + i end
        end)lua");
    lab.rows.between[0] = {Lab::kBody0, Lab::kShaft0};
    lab.rows.state[0] = {{"sum", 0.0}, {"count", 0.0}};
    lab.bodies.mass[0] = 2, lab.bodies.position[0].x = 30, lab.bodies.velocity[0].y = 400;
    lab.bodies.angular_velocity[0].z = 5000;
    lab.shafts.angle[0] = 0.5, lab.shafts.speed[0] = 0.25, lab.shafts.inertia[0] = 0.125;
    REQUIRE(lab.prepare() == "");
    lab.drive();
    CHECK(lab.state("sum") == 5432.875);
    CHECK(lab.state("count") == 5.0);
}

TEST_CASE("participants follow their roles")
{
    Lab lab(
        "function force(t, state) for _, p in ipairs(between) do p:add_torque(1) end "
        "if driven then driven:add_torque(10) end end");
    lab.rows.between[0] = {Lab::kShaft0};
    REQUIRE(lab.prepare() == "");
    lab.force();
    CHECK(lab.wrenches.shaft_torque == std::vector<double>{1, 0});
    lab.rows.between[0] = {Lab::kShaft0, Lab::kShaft1}, lab.rows.driven[0] = Lab::kShaft1;
    lab.force();
    CHECK(lab.wrenches.shaft_torque == std::vector<double>{1, 11});
    lab.rows.between[0] = {Lab::kShaft1}, lab.rows.driven[0] = {};
    lab.force();
    CHECK(lab.wrenches.shaft_torque == std::vector<double>{0, 1});
}

TEST_CASE("a script adds no force if its driven body is not advanced, nor to bodies that are not advanced")
{
    Lab lab("function force(t, state) for _, p in ipairs(between) do p:add_torque(1) end end");
    lab.rows.driver[0] = Lab::kBody0, lab.rows.between[0] = {Lab::kShaft0, Lab::kShaft1};
    REQUIRE(lab.prepare() == "");
    std::vector<std::uint8_t> active{0, 1};
    lab.context.active_shafts = active;
    lab.force();
    CHECK(lab.wrenches.shaft_torque == std::vector<double>{0, 1});
    active = {0, 0};
    lab.force();
    lab.finish();
    CHECK(lab.wrenches.shaft_torque == std::vector<double>{0, 0});
}

TEST_CASE("drive changes parameters, emits events and prints")
{
    Lab lab(R"lua(
        function drive(step)
            set("gear", "velocity_factor", -0.5)
            set("lamp", "on", true)
            set("ball", "velocity", vec(1, 0, 0))
            set("title", "text", "hello")
            emit("motor.hot", "at " .. step.tick, step.time, 80)
            print("t", step.dt, nil, vec(0, 0, 1))
        end)lua");
    REQUIRE(lab.prepare() == "");
    lab.context.tick = 3, lab.context.time = 0.5;
    lab.drive();
    REQUIRE(lab.changes.size() == 4);
    CHECK(lab.changes[0].component == "gear");
    CHECK(lab.changes[0].name == "velocity_factor");
    CHECK(lab.changes[0].value == Value(-0.5));
    CHECK(lab.changes[1].value == Value(true));
    CHECK(lab.changes[2].value == Value(Vec3{1, 0, 0}));
    CHECK(lab.changes[3].value == Value(std::string("hello")));
    REQUIRE(lab.events.all.size() == 2);
    CHECK(lab.events.all[0].kind == "motor.hot");
    CHECK(lab.events.all[0].message == "at 3");
    CHECK(lab.events.all[0].values == std::vector<double>{0.5, 80});
    CHECK(lab.events.all[0].component == 7);
    CHECK(lab.events.all[0].severity == Severity::Info);
    CHECK(lab.events.all[1].message == "t\t0.01\tnil\tvec(0, 0, 1)");
}

TEST_CASE("force is pure: everything else is refused there, with the reason")
{
    const std::pair<const char*, const char*> cases[] = {
        {"state.n = 1", "code:1: state is read-only in force(t, state): change it in drive(step)"},
        {"set('a', 'b', 1)", "code:1: set is for drive(step): force(t, state) must be pure"},
        {"emit('a')", "code:1: emit is for drive(step): force(t, state) must be pure"},
        {"print(1)", "code:1: print is for drive(step): force(t, state) must be pure"},
        {"math.random()", "code:1: math.random is for drive(step): force(t, state) must be pure"},
        {"driver:add_torque(1)", "code:1: driver is only read: forces are added to driven and between"},
        {"driven.speed = 1",
         "code:1: participants are read-only: add forces in force(t, state), or change parameters "
         "by set()"},
        {"driven:add_force(vec(1, 0, 0))", "code:1: driven is a shaft: it takes add_torque(number)"},
        {"x = 1", "code:1: global 'x' cannot be assigned: values that live across steps belong in `state`"},
        {"parameters.k = 1", "code:1: parameters are read-only in the script: a request sets them"},
        {"return state.m", "code:1: state has no 'm'; declared are: n"},
    };
    for (const auto& [line, message] : cases)
    {
        CAPTURE(std::string(line));
        Lab lab(std::string("function force(t, state) driven:add_torque(1) ") + line + " end");
        lab.rows.driver[0] = Lab::kShaft0, lab.rows.driven[0] = Lab::kShaft1;
        lab.rows.state[0] = {{"n", 0.0}};
        REQUIRE(lab.prepare() == "");
        lab.force();
        lab.finish();
        CHECK(lab.only_event() == std::string("script.error: ") + message);
        CHECK(lab.events.all[0].severity == Severity::Failure);
        CHECK(lab.rows.quarantined[0]);
        CHECK(lab.wrenches.shaft_torque[1] == 0.0);  // what it added before the error is removed as well
        CHECK(lab.state("n") == 0.0);
    }
}

TEST_CASE("code that cannot be loaded is refused with its position, and the old code stays")
{
    Lab lab("function force() end");
    REQUIRE(lab.prepare() == "");
    const auto* machine = lab.rows.machine[0].get();
    const std::pair<const char*, const char*> cases[] = {
        {"\n\nlocal x = = 3", "line 3: unexpected symbol near '='"},
        {"x = 1", "neither drive(step) nor force(t, state) is defined"},
        {"drive = 4", "drive must be a function, not a number"},
        {"\n error('no')", "line 2: no"},
        {"local a = state.x", "line 1: state can be used in drive and force, not while the code is loaded"},
        {"local a = driver.angle", "line 1: attempt to index a nil value (global 'driver')"},
        {"set('a', 'b', 1)", "line 1: set can be used in drive and force, not while the code is loaded"},
        {"math.random()", "line 1: math.random can be used in drive and force, not while the code is loaded"},
        {"\x1bLua", "attempt to load a binary chunk (mode is 't')"},
        {"while true do end", "line 1: over the budget of 1000000 instructions"},
    };
    for (const auto& [code, message] : cases)
    {
        lab.rows.code[0] = code;
        CHECK(lab.prepare() == message);
        CHECK(lab.rows.machine[0].get() == machine);
    }
}

TEST_CASE("a failing drive changes nothing")
{
    Lab lab(R"lua(
        function drive(step)
            state.n = state.n + 1
            state.s = "a long text that does not fit into the short buffer"
            set("a", "b", math.random())
            if step.tick == 1 then error("boom") end
        end)lua");
    lab.rows.state[0] = {{"n", 0.0}, {"s", std::string("x")}};
    REQUIRE(lab.prepare() == "");
    lab.step();
    CHECK(lab.state("n") == 1.0);
    CHECK(lab.changes.size() == 1);
    const std::int64_t random = lab.rows.random_state[0];
    lab.rows.state[0][1].value = std::string("y");
    lab.step();
    CHECK(lab.only_event() == "script.error: code:6: boom");
    CHECK(lab.events.all[0].tick == 1);
    CHECK(lab.state("n") == 1.0);
    CHECK(std::get<std::string>(lab.rows.state[0][1].value) == "y");
    CHECK(lab.changes.size() == 1);
    CHECK(lab.rows.random_state[0] == random);
    CHECK(lab.rows.quarantined[0]);
    lab.step();
    CHECK(lab.events.all.size() == 1);
}

TEST_CASE("a failing script is called again after its quarantine is lifted")
{
    Lab lab("function drive(step) state.n = state.n + 1 if parameters.bad then error() end end");
    lab.rows.state[0] = {{"n", 0.0}}, lab.rows.parameters[0] = {{"bad", true}};
    REQUIRE(lab.prepare() == "");
    lab.step();
    lab.rows.parameters[0][0].value = false;
    lab.step();
    CHECK(lab.state("n") == 0.0);
    CHECK(lab.events.all.size() == 1);
    lab.rows.quarantined[0] = false;
    lab.step();
    CHECK(lab.state("n") == 1.0);
    CHECK(lab.events.all.size() == 1);
}

TEST_CASE("a failure of force in a trial that is rewound does not count")
{
    Lab lab("function force(t, state) assert(t < 0.006, 'late') driven:add_torque(1) end");
    lab.rows.driven[0] = Lab::kShaft0;
    REQUIRE(lab.prepare() == "");
    lab.drive();
    lab.context.time = 0.01;
    lab.force();
    CHECK(lab.wrenches.shaft_torque[0] == 0.0);
    lab.force();  // a later stage of the failing trial is not called
    CHECK(lab.wrenches.shaft_torque[0] == 0.0);
    lab.context.time = 0.005;
    lab.force();
    CHECK(lab.wrenches.shaft_torque[0] == 1.0);
    lab.finish();
    CHECK(lab.events.all.empty());
    CHECK_FALSE(lab.rows.quarantined[0]);
    lab.context.time = 0.008;
    lab.force();
    lab.context.time = 0.01;
    lab.finish();
    CHECK(lab.only_event() == "script.error: late");
    CHECK(lab.events.all[0].time == 0.008);
    CHECK(lab.rows.quarantined[0]);
}

TEST_CASE("forces that are not finite are an error and are never added")
{
    for (const char* value : {"0/0", "1/0", "-1/0", "1e308 * 10"})
    {
        CAPTURE(std::string(value));
        Lab lab(std::string("function force(t, state) between[1]:add_force(vec(0, ") + value + ", 0)) end");
        lab.rows.between[0] = {Lab::kBody1};
        REQUIRE(lab.prepare() == "");
        lab.force();
        lab.finish();
        CHECK(lab.wrenches.force[1] == Vec3{});
        CHECK(lab.only_event() == "script.error: code:1: force on between[1] is not finite");
    }
    Lab lab("function drive(step) state.x = 0/0 end");
    lab.rows.state[0] = {{"x", 1.0}};
    REQUIRE(lab.prepare() == "");
    lab.drive();
    CHECK(lab.only_event() == "script.error: code:1: state.x is not finite");
    CHECK(lab.state("x") == 1.0);
}
