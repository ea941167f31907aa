// The attack corpus: each attack ends soon, with the event that names it, and only its own script is quarantined.
#include <doctest/doctest.h>

#include "lab.h"

using namespace plab;
using scripts::test::Lab;
using scripts::test::seconds_since;

namespace
{

struct Attack
{
    std::string name;
    const char* body;   // of drive
    const char* event;  // the beginning of its text
};

constexpr const char* kBudget = "script.over_budget: code:1: over the budget of 100000 instructions";
constexpr const char* kMemory = "script.out_of_memory: code:1: more than memory_limit = 4194304 bytes";
constexpr const char* kText = "script.out_of_memory: code:1: a text of more than 4096 bytes";

const Attack kAttacks[] = {
    {"endless loop", "while true do end", kBudget},
    {"endless repeat", "repeat until false", kBudget},
    {"endless for", "for i = 1, math.huge do end", kBudget},
    {"goto", "::a:: goto a", kBudget},
    {"in pcall", "pcall(function() while true do end end)", kBudget},
    {"pcall around pcall", "while true do pcall(function() while true do end end) end", kBudget},
    {"pcall of endless errors", "while true do pcall(error) end", kBudget},
    {"in xpcall's handler", "xpcall(error, function() while true do end end)", kBudget},
    {"xpcall whose handler fails", "xpcall(error, function() error('again') end)", "script.error: code:1: again"},
    {"over budget with a handler", "xpcall(function() while true do end end, function() while true do end end)", kBudget},
    {"tail calls", "local function f() return f() end f()", kBudget},
    {"mutual tail calls", "local g local function f() return g() end g = function() return f() end f()", kBudget},
    {"growing arguments", "local function f(...) return f(1, ...) end f()", "script.error: code:1: more than 250 variable arguments"},
    {"deep recursion", "local function f() return 1 + f() end f()", "script."},
    {"deep recursion caught", "local function f() return 1 + f() end while true do pcall(f) end", "script."},
    {"deep pcall", "local function f() pcall(f) end while true do f() end", "script.over_budget"},
    {"rep bomb", "local s = string.rep('x', 1e9)", "script.error: code:1: string.rep makes a text of more than 4096"},
    {"rep of nothing", "while true do local s = string.rep('', 1 << 62) end", kBudget},
    {"rep bombs caught", "while true do pcall(string.rep, 'x', 1e9) end", "script.over_budget"},
    {"doubling", "local s = 'x' while true do s = s .. s end", kText},
    {"doubling caught", "while true do pcall(function() local s = 'x' while true do s = s .. s end end) end", kText},
    {"concat bomb", "local t = {} for i = 1, 1000 do t[i] = ('x'):rep(1000) end table.concat(t)", "script.error: code:1: a text of"},
    {"format width", "string.format('%99999d', 1)", "script.error: code:1: string.format knows"},
    {"format precision", "string.format('%.99999f', 1)", "script.error: code:1: string.format knows"},
    {"format width of text", "string.format('%99999s', 'x')", "script.error: code:1: string.format knows"},
    {"format address", "string.format('%p', {})", "script.error: code:1: string.format knows"},
    {"many texts", "local t = {} for i = 1, 1e7 do t[i] = ('x'):rep(4000, i) end", "script."},
    {"table bomb", "local t = {} for i = 1, 1e9 do t[i] = {i} end", "script."},
    {"nested tables", "local t = {} while true do t = {t, t} end", kBudget},
    {"text bomb", "local t, y = {}, ('y'):rep(4000) for i = 1, 1e9 do t[i] = y .. i end", kMemory},
    {"text bomb caught",
     "while true do pcall(function() local t, y = {}, ('y'):rep(4000) for i = 1, 1e9 do "
     "t[i] = y .. i end end) end",
     kMemory},
    {"thrash at the limit",
     "local t = {} for i = 1, 1800 do t[i] = i .. ('y'):rep(1900) end "
     "while true do local s = ('z'):rep(1900) .. #t end",
     "script."},
    {"rehash",
     "local t = {} for i = 1, 8192 do t['k' .. i] = i end local i = 0 "
     "while true do i = i + 1 t['k' .. i] = nil t['n' .. i] = 1 end",
     "script."},
    {"colliding keys", "local t = {} for i = 1, 20000 do t[i * 65535.5] = i end while true do t[1] = 1 end", "script."},
    {"slow comparison", "local a = ('x'):rep(4096) local b = ('x'):rep(4096) while true do local c = a < b end", kBudget},
    {"slow conversion", "local a = ('0'):rep(4096) while true do local c = tonumber(a) end", kBudget},
    {"sort with an endless order", "table.sort({1, 2}, function() while true do end end)", kBudget},
    {"sort without order",
     "local t = {} for i = 1, 1000 do t[i] = i end table.sort(t, function() return true end) "
     "while true do end",
     kBudget},
    {"sort that is too long", "local t = {} for i = 1, 10001 do t[i] = i end table.sort(t)",
     "script.error: code:1: bad argument #1 to 'sort' (at most 10000"},
    {"insert in front", "local t = {} while true do table.insert(t, 1, 0) end", kBudget},
    {"unpack bomb", "table.unpack({}, 1, 1e8)", "script.error: code:1: bad argument #3 to 'unpack' (at most 200"},
    {"unpack overflow", "table.unpack({}, math.tointeger(-2^63), 2^63 - 1 | 0)", "script.error: code:1:"},
    {"pairs of many", "local t = {} for i = 1, 5000 do t[i] = i end while true do for k in pairs(t) do end end", "script.over_budget"},
    {"event flood", "while true do emit('flood', ('x'):rep(4000)) end", "flood"},
    {"change flood", "while true do set('a', 'b', ('x'):rep(4000)) end", "script.over_budget"},
    {"table as error", "error({})", "script.error: the error is a table, not a text"},
    {"nil as error", "error()", "script.error: the error is a nil, not a text"},
    {"error that is no UTF-8", "error('\\xff', 0)", "script.error: the error's text is not UTF-8"},
    {"emit that is no UTF-8", "emit('a', '\\xff')", "script.error: code:1: bad argument #2 to 'emit' (must be UTF-8"},
    {"closing a value without __close", "local x <close> = {}", "script.error: code:1: variable 'x' got a non-closable"},
    {"a method on a foreign object", "driven.add_torque(vec(1, 2, 3), 1)",
     "script.error: code:1: bad argument #1 to 'add_torque' (participant expected, got vec)"},
    {"a method on a text", "local f = vec(1, 2, 3).dot f('x', 'y')",
     "script.error: code:1: bad argument #1 to 'f' (vec expected, got string)"},
    {"a method on state", "local f = vec(1, 2, 3).dot f(state, step)",
     "script.error: code:1: bad argument #1 to 'f' (vec expected, got record)"},
};

}  // namespace

TEST_CASE("every attack ends soon, in its event")
{
    for (const Attack& attack : kAttacks)
    {
        CAPTURE(attack.name);
        Lab lab(std::string("function drive(step) ") + attack.body + " end");
        lab.rows.driven[0] = Lab::kShaft0;
        REQUIRE(lab.prepare() == "");
        const auto start = std::chrono::steady_clock::now();
        lab.drive();
        const double seconds = seconds_since(start);
        CHECK(seconds < 1.0);  // without a sanitizer and on a quiet machine: far less, see README.md
        if (seconds > 0.02) MESSAGE(attack.name << ": " << seconds * 1e3 << " ms");
        CHECK(lab.rows.quarantined[0]);
        CHECK(lab.changes.empty());
        REQUIRE(!lab.events.all.empty());
        const Event& event = attack.event == std::string("flood") ? lab.events.all.front() : lab.events.all.back();
        CAPTURE(event.message);
        CHECK((event.kind + ": " + event.message).starts_with(attack.event));
    }
}

TEST_CASE("functions that reach the outside, the clock or an address do not exist")
{
    for (const char* name : {"io",
                             "os",
                             "package",
                             "require",
                             "debug",
                             "load",
                             "loadfile",
                             "loadstring",
                             "dofile",
                             "collectgarbage",
                             "coroutine",
                             "rawset",
                             "rawget",
                             "rawequal",
                             "rawlen",
                             "setmetatable",
                             "getmetatable",
                             "next",
                             "_G",
                             "utf8",
                             "warn",
                             "string.dump",
                             "string.find",
                             "string.match",
                             "string.gmatch",
                             "string.gsub",
                             "string.pack",
                             "string.unpack",
                             "string.packsize",
                             "string.reverse",
                             "table.move",
                             "table.pack",
                             "math.randomseed"})
    {
        CAPTURE(std::string(name));
        Lab lab(std::string("assert(") + name + " == nil) function drive() end");
        CHECK(lab.prepare() == "");
    }
}

TEST_CASE("the string metatable and the libraries are out of reach")
{
    for (const char* code : {"string.rep = nil", "math.pi = 3", "table.x = 1", "between[1] = 2", "table.insert(math, 1)",
                             "table.sort(string)", "table.remove(between)"})
    {
        CAPTURE(std::string(code));
        Lab lab(std::string(code) + " function drive() end");
        CHECK(lab.prepare() ==
              "line 1: a table made while loading is read-only: values that live across steps belong in "
              "`state`");
    }
    Lab lab("local ok = pcall(function() local s = 'x' s.len = 1 end) assert(not ok) function drive() end");
    CHECK(lab.prepare() == "");
}

TEST_CASE("deeply nested source ends the parser, not the process")
{
    const auto nested = [](const char* open, const char* middle, const char* close)
    {
        std::string code = "local x = ";
        for (int i = 0; i < 100000; ++i) code += open;
        code += middle;
        for (int i = 0; i < 100000; ++i) code += close;
        return code;
    };
    for (const auto& [open, close] : {std::pair{"(", ")"}, {"{", "}"}, {"- ", ""}, {"f(", ")"}, {"function() return ", " end"}})
    {
        CAPTURE(std::string(open));
        Lab lab(nested(open, "1", close));
        const auto start = std::chrono::steady_clock::now();
        const std::string error = lab.prepare();
        CHECK(seconds_since(start) < 1.0);
        CAPTURE(error);
        const bool limited = error.find("C stack overflow") != std::string::npos || error.find("too many") != std::string::npos ||
                             error.find("overflow") != std::string::npos;
        CHECK(limited);
    }
}

TEST_CASE("attacks in force end like those in drive, and add no force")
{
    const std::pair<const char*, const char*> cases[] = {
        {"while true do end", "script.over_budget: code:1: over the budget of 100000 instructions"},
        {"while true do driven:add_torque(1) end", "script.over_budget: code:1: over the budget"},
        {"local s = 'x' while true do s = s .. s end", "script.out_of_memory: code:1: a text of more than 4096 bytes"},
    };
    for (const auto& [body, event] : cases)
    {
        CAPTURE(std::string(body));
        Lab lab(std::string("function force(t, state) driven:add_torque(1) ") + body + " end");
        lab.rows.driven[0] = Lab::kShaft0;
        REQUIRE(lab.prepare() == "");
        for (int stage = 0; stage < 4; ++stage)
        {
            lab.force();
            CHECK(lab.wrenches.shaft_torque[0] == 0.0);
        }
        CHECK(lab.events.all.empty());
        lab.finish();
        CHECK(lab.only_event().starts_with(event));
        CHECK(lab.rows.quarantined[0]);
    }
}

TEST_CASE("the smallest memory holds a script, and limits are enforced")
{
    Lab lab("function drive(step) local t = {} for i = 1, state.n do t[i] = i end end");
    lab.rows.memory_limit[0] = 64 << 10;
    lab.rows.state[0] = {{"n", 100.0}};
    REQUIRE(lab.prepare() == "");
    for (int i = 0; i < 1000; ++i) lab.step();
    CHECK(lab.events.all.empty());
    CHECK(lab.rows.memory_used[0] > 10000);
    CHECK(lab.rows.memory_used[0] <= 64 << 10);
    lab.rows.state[0][0].value = 5000.0;
    lab.step();
    CHECK(lab.only_event() == "script.out_of_memory: code:1: more than memory_limit = 65536 bytes");
}

TEST_CASE("the budget is counted from the start of each call, to the instruction")
{
    // A turn of the empty loop is one instruction.
    Lab lab("function drive(step) for i = 1, state.n do end end");
    lab.rows.state[0] = {{"n", 900.0}};
    lab.rows.instruction_budget[0] = 1000;
    REQUIRE(lab.prepare() == "");
    for (int i = 0; i < 10; ++i) lab.step();
    CHECK(lab.events.all.empty());
    CHECK(lab.rows.instructions_used[0] >= 448);
    CHECK(lab.rows.instructions_used[0] <= 910);
    lab.rows.state[0][0].value = 1000.0;
    lab.step();
    CHECK(lab.only_event() == "script.over_budget: code:1: over the budget of 1000 instructions");
}
