// What a script may keep: declared state, and nothing else. Order and random numbers are reproducible.
#include <doctest/doctest.h>

#include <thread>

#include "lab.h"

using namespace plab;
using scripts::test::Lab;

namespace
{

/// The event after two drives of the code, or the state's n if there was none.
std::string drive_twice(const std::string& code)
{
    Lab lab(code);
    lab.rows.state[0] = {{"n", 0.0}};
    const std::string refused = lab.prepare();
    if (!refused.empty()) return refused;
    lab.step();
    lab.step();
    return lab.events.all.empty() ? std::to_string(static_cast<int>(lab.state("n"))) : lab.events.all[0].message;
}

}  // namespace

TEST_CASE("values survive a step in declared state only")
{
    CHECK(drive_twice("function drive() state.n = state.n + 1 end") == "2");
    const std::string kFrozen = "values that live across steps belong in `state`";
    CHECK(drive_twice("local n = 0 function drive() n = n + 1 end") == "code: local 'n' was changed by drive: " + kFrozen);
    CHECK(drive_twice("function drive() m = 1 end") == "code:1: global 'm' cannot be assigned: " + kFrozen);
    CHECK(drive_twice("m = 0 function drive() m = m + 1 end") == "code:1: global 'm' cannot be assigned: " + kFrozen);
    CHECK(drive_twice("function drive() drive = nil end") == "code:1: global 'drive' cannot be assigned: " + kFrozen);
    const std::string kTable = "code:1: a table made while loading is read-only: " + kFrozen;
    CHECK(drive_twice("local t = {n = 0} function drive() t.n = t.n + 1 end") == kTable);
    CHECK(drive_twice("t = {{}} function drive() table.insert(t[1], 1) end") == kTable);
    CHECK(drive_twice("local t = {} t[t] = t local f = {[t] = t} function drive() f[t][1] = 1 end") == kTable);
    CHECK(drive_twice("local function counter() local k = 0 return function() k = k + 1 end end "
                      "local tick = counter() function drive() tick() end") == "code: local 'k' was changed by drive: " + kFrozen);
    CHECK(drive_twice("local n = 0 local t = {f = function() n = n + 1 end} function drive() t.f() end") ==
          "code: local 'n' was changed by drive: " + kFrozen);
    CHECK(drive_twice("local s = 'a' function drive() s = s .. 'a' end") == "code: local 's' was changed by drive: " + kFrozen);
    CHECK(drive_twice("local t function drive() t = {} end") == "code: local 't' was changed by drive: " + kFrozen);
    CHECK(drive_twice("local t = {} function drive() t = {} end") == "code: local 't' was changed by drive: " + kFrozen);
    CHECK(drive_twice("local n = 0 function drive() pcall(function() n = 1 end) end") ==
          "code: local 'n' was changed by drive: " + kFrozen);
    CHECK(drive_twice("function drive() _ENV = {} end") == "code: local '_ENV' was changed by drive: " + kFrozen);
    CHECK(drive_twice("local _ENV = {state = state} function drive() x = 1 end") == "neither drive(step) nor force(t, state) is defined");
    CHECK(drive_twice("local e = _ENV function drive() e.x = 1 end") == "code:1: global 'x' cannot be assigned: " + kFrozen);
    CHECK(drive_twice("local next = pairs({1, 2, 3}) function drive() state.n = next() end") ==
          "the result of pairs cannot be stored: call pairs in the loop itself");
    CHECK(drive_twice("state.n = 1 function drive() end") == "line 1: state can be used in drive and force, not while the code is loaded");
}

TEST_CASE("values that do not outlive a call are allowed: locals, closures and tables made in it")
{
    CHECK(drive_twice("function drive() local n = 0 local function up() n = n + 1 end up() up() state.n = n end") == "2");
    CHECK(drive_twice("local k = 3 local t = {1, 2, {4}} local function f(x) return x * k + t[3][1] + #t end "
                      "function drive() local u = {} u.x = f(1) state.n = u.x end") == "10");
    CHECK(drive_twice("local n = 0 function drive() n = n + 1 n = n - 1 state.n = 5 end") == "5");
    CHECK(drive_twice("local s = {} for i = 1, 5 do s[i] = i end function drive() local n = 0 for _, v in ipairs(s) do "
                      "n = n + v end for k, v in pairs(s) do n = n + v end state.n = n + #s end") == "35");
    CHECK(drive_twice("local t = {'a', 'b'} function drive() assert(table.concat(t, '-') == 'a-b' and "
                      "select('#', table.unpack(t)) == 2) state.n = 1 end") == "1");
}

TEST_CASE("force cannot keep values either")
{
    Lab lab("local calls = 0 function force(t, state) calls = calls + 1 driven:add_torque(calls) end");
    lab.rows.driven[0] = Lab::kShaft0;
    REQUIRE(lab.prepare() == "");
    lab.force();
    CHECK(lab.wrenches.shaft_torque[0] == 0.0);
    lab.finish();
    CHECK(lab.only_event() ==
          "script.error: code: local 'calls' was changed by force: values that live across steps "
          "belong in `state`");
}

TEST_CASE("state keeps its types and names")
{
    const auto error = [](const std::string& body)
    {
        Lab lab("function drive() " + body + " end");
        lab.rows.state[0] = {{"b", true}, {"n", 1.0}, {"s", std::string("x")}};
        REQUIRE(lab.prepare() == "");
        lab.drive();
        return lab.events.all.empty() ? "" : lab.events.all[0].message;
    };
    CHECK(error("state.b = false state.n = 3 state.s = 'y' assert(state.n == 3 and state.s == 'y')") == "");
    CHECK(error("state.n = 'x'") == "code:1: state.n is a number, and stays one: it cannot be a text");
    CHECK(error("state.b = nil") == "code:1: state.b is a truth value, and stays one: it cannot be a nil");
    CHECK(error("state.s = {}") == "code:1: state.s is a text, and stays one: it cannot be a table");
    CHECK(error("state.s = '\\xff'") == "code:1: state.s must be UTF-8 text");
    CHECK(error("state.m = 1") == "code:1: state has no 'm'; declared are: b, n, s");
    CHECK(error("state[1] = 1") == "code:1: state has no 'number'; declared are: b, n, s");
    Lab lab("function drive() state.m = 1 end");
    REQUIRE(lab.prepare() == "");
    lab.drive();
    CHECK(lab.only_event() == "script.error: code:1: state has no 'm'; declare it with its first value, state=\"NAME=0\"");
}

TEST_CASE("a memento consists of the columns: a restored script continues as before")
{
    const char* code = R"lua(
        function drive(step)
            state.x = state.x + math.random() * math.random(10)
            state.s = string.format("%.17g", state.x)
        end)lua";
    Lab lab(code);
    lab.rows.state[0] = {{"x", 0.0}, {"s", std::string()}};
    REQUIRE(lab.prepare() == "");
    for (int i = 0; i < 5; ++i) lab.step();
    ByteWriter saved;
    for (const Field& f : lab.schema.fields())
        if (f.kind == FieldKind::State) f.column->save(0, saved);
    const auto go_on = [&]
    {
        for (int i = 0; i < 5; ++i) lab.step();
        return lab.rows.state[0];
    };
    const auto restore = [&]
    {
        ByteReader in(saved.bytes());
        for (const Field& f : lab.schema.fields())
            if (f.kind == FieldKind::State) f.column->load(0, in);
    };
    const Entries first = go_on();
    restore();
    CHECK(go_on() == first);
    restore();
    REQUIRE(lab.prepare() == "");  // a machine built anew
    CHECK(go_on() == first);
    CHECK(lab.events.all.empty());
}

TEST_CASE("a memento from before a failure restores the script")
{
    Lab lab("local n = 0 function drive(step) if step.tick == 2 then n = 7 end state.n = n end");
    lab.rows.state[0] = {{"n", 0.0}};
    REQUIRE(lab.prepare() == "");
    for (int i = 0; i < 4; ++i) lab.step();
    CHECK(lab.rows.quarantined[0]);
    CHECK(lab.events.all.size() == 1);
    lab.rows.quarantined[0] = false, lab.context.tick = 1;
    lab.step();
    CHECK(lab.state("n") == 0.0);
    CHECK_FALSE(lab.rows.quarantined[0]);
    lab.step();
    CHECK(lab.rows.quarantined[0]);
    CHECK(lab.events.all.size() == 2);
}

TEST_CASE("random numbers are seeded, per component, and uniform")
{
    const char* code = "function drive() state.x = math.random() state.k = math.random(3, 5) end";
    const auto first = [&](std::uint64_t seed, std::uint32_t owner)
    {
        Lab lab(code);
        lab.rows.state[0] = {{"x", 0.0}, {"k", 0.0}};
        lab.context.seed = seed, lab.owners[0] = owner;
        REQUIRE(lab.prepare() == "");
        CHECK(lab.rows.random_state[0] == 0);
        lab.drive();
        CHECK(lab.rows.random_state[0] != 0);
        return lab.state("x");
    };
    CHECK(first(1, 1) == first(1, 1));
    CHECK(first(1, 1) != first(2, 1));
    CHECK(first(1, 1) != first(1, 2));

    Lab lab(code);
    lab.rows.state[0] = {{"x", 0.0}, {"k", 0.0}};
    REQUIRE(lab.prepare() == "");
    double sum = 0;
    int counts[3] = {0, 0, 0};
    for (int i = 0; i < 3000; ++i)
    {
        lab.drive();
        sum += lab.state("x");
        const int k = static_cast<int>(lab.state("k"));
        REQUIRE((k >= 3 && k <= 5));
        ++counts[k - 3];
    }
    CHECK(sum / 3000 == doctest::Approx(0.5).epsilon(0.03));  // 5 sigma = 0.026
    for (const int n : counts) CHECK(n == doctest::Approx(1000).epsilon(0.13));
}

TEST_CASE("pairs has a fixed order: numbers, then texts, sorted")
{
    const char* code = R"lua(
        function drive()
            local t = {}
            for _, k in ipairs({"b", "a", 10, 2.5, "B", -1, "", "10"}) do t[k] = true end
            local out = {}
            for k in pairs(t) do table.insert(out, tostring(k)) end
            state.s = table.concat(out, " ")
            for k in pairs(t) do t[k] = nil t.a = nil end
            for k in pairs(t) do error("left") end
        end)lua";
    Lab lab(code);
    lab.rows.state[0] = {{"s", std::string()}};
    REQUIRE(lab.prepare() == "");
    lab.drive();
    CHECK(lab.events.all.empty());
    CHECK(std::get<std::string>(lab.rows.state[0][0].value) == "-1 2.5 10  10 B a b");
    CHECK(drive_twice("function drive() for k in pairs({[true] = 1}) do end end") ==
          "code:1: pairs has an order for keys that are numbers or texts only");
}

TEST_CASE("sort is stable and leaves the list unchanged when the comparison fails")
{
    CHECK(drive_twice(R"lua(function drive()
        local t = {}
        for i = 1, 100 do t[i] = {key = i * 7 % 5, at = i} end
        table.sort(t, function(a, b) return a.key < b.key end)
        for i = 2, 100 do
            assert(t[i - 1].key < t[i].key or (t[i - 1].key == t[i].key and t[i - 1].at < t[i].at))
        end
        local u = {3, 1, 2}
        assert(not pcall(table.sort, u, function() error() end) and table.concat(u) == "312")
        table.sort(u) assert(table.concat(u) == "123")
        local w = {"b", "B", "a", "aa"} table.sort(w) assert(table.concat(w, " ") == "B a aa b")
        assert(not pcall(table.sort, {1, "a"}))
        state.n = 1 end)lua") == "1");
}

TEST_CASE("rows that run on different threads at the same time give the results of one thread")
{
    const char* code = R"lua(
        function drive(step)
            local t = {}
            for i = 1, 50 do t[i] = {math.random(), "k" .. i} end
            table.sort(t, function(a, b) return a[1] < b[1] end)
            for i, e in ipairs(t) do state.x = state.x + e[1] * i end
            pcall(error, "thrown and caught")
        end)lua";
    const auto run = [&](std::uint32_t owner)
    {
        Lab lab(code);
        lab.rows.state[0] = {{"x", 0.0}}, lab.owners[0] = owner;
        if (!lab.prepare().empty()) return -1.0;
        for (int i = 0; i < 200; ++i) lab.step();
        return lab.state("x");
    };
    double alone[2], together[2];
    for (std::uint32_t i = 0; i < 2; ++i) alone[i] = run(i);
    std::thread other([&] { together[0] = run(0); });
    together[1] = run(1);
    other.join();
    CHECK(alone[0] > 0);
    CHECK(alone[0] != alone[1]);
    CHECK(together[0] == alone[0]);
    CHECK(together[1] == alone[1]);
}
