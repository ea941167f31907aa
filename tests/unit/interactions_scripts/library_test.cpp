// The libraries agree with Lua's manual where they have the same names.
#include <doctest/doctest.h>

#include "lab.h"

using scripts_lab = plab::scripts::test::Lab;

namespace
{

/// The error in the body of a drive, or nothing.
std::string complaint(const std::string& body)
{
    scripts_lab lab("function drive() " + body + " end");
    const std::string refused = lab.prepare();
    if (!refused.empty()) return refused;
    lab.drive();
    return lab.events.all.empty() ? "" : lab.events.all.back().message;
}

}  // namespace

TEST_CASE("math")
{
    CHECK(complaint(R"lua(
        assert(math.abs(-3) == 3 and math.type(math.abs(-3)) == "integer" and math.abs(-2.5) == 2.5)
        assert(math.sqrt(16) == 4 and math.sin(0) == 0 and math.cos(0) == 1 and math.exp(0) == 1 and math.log(1) == 0)
        assert(math.atan(1, 0) == math.pi / 2 and math.atan(1) == math.pi / 4 and math.atan(0, -1) == math.pi)
        assert(math.abs(math.log(8, 2) - 3) < 1e-15 and math.acos(1) == 0 and math.asin(0) == 0 and math.tan(0) == 0)
        assert(math.floor(-2.5) == -3 and math.ceil(-2.5) == -2 and math.type(math.floor(2.5)) == "integer")
        assert(math.floor(1e300) == 1e300 and math.type(math.floor(1e300)) == "float")
        assert(math.min(3, 1, 2) == 1 and math.max(3, 1, 2) == 3 and math.fmod(-7, 3) == -1)
        assert(math.tointeger(3.0) == 3 and math.tointeger(3.5) == nil and math.huge == 1 / 0)
        assert(math.type(1) == "integer" and math.type(1.0) == "float" and math.type("1") == nil)
        assert(2 ^ 0.5 == math.sqrt(2) and 7 // 2 == 3 and 7 % 3 == 1))lua") == "");
    CHECK(complaint("math.sin('x')") == "code:1: bad argument #1 to 'sin' (number expected, got string)");
    CHECK(complaint("math.random(0)") == "code:1: bad argument #1 to 'random' (the interval is empty)");
}

TEST_CASE("string")
{
    CHECK(complaint(R"lua(
        assert(("hello"):sub(2, 3) == "el" and ("hello"):sub(-3) == "llo" and ("hello"):sub(4, 2) == "")
        assert(("hello"):sub(0) == "hello" and ("hello"):sub(-100, 100) == "hello" and ("hello"):sub(2, -2) == "ell")
        assert(#"abc" == 3 and ("abc"):len() == 3 and ("aBc"):upper() == "ABC" and ("AbC"):lower() == "abc")
        assert(("ab"):rep(3) == "ababab" and ("ab"):rep(3, "-") == "ab-ab-ab" and ("x"):rep(0) == "" and ("x"):rep(-1) == "")
        assert(#("x"):rep(4096) == 4096 and #("x"):rep(1366, "yy") == 4096 and not pcall(string.rep, "x", 4097))
        assert(not pcall(string.rep, "x", 1367, "yy") and #("x"):rep(1, ("y"):rep(4096)) == 1)
        assert(("A"):byte() == 65 and select("#", ("abc"):byte(1, -1)) == 3 and string.char(72, 105) == "Hi")
        assert(string.format("%5.2f|%-5d|%05d|%x|%s|%%|%5s|%-5s|%.2s", 3.14159, 42, 42, 255, true, "ab", "ab", "abc")
               == " 3.14|42   |00042|ff|true|%|   ab|ab   |ab")
        assert(string.format("%g %+d %e", 0.1, 5, 12345.678) == "0.1 +5 1.234568e+04")
        assert(string.format("%s %s %s", nil, {}, print) == "nil table function")
        assert(#string.format("%.99f", 1e308) == 409)
        assert(tostring({}) == "table" and tostring(print) == "function" and tostring(state) == "state")
        assert(tostring(1) == "1" and tostring(1.0) == "1.0" and tostring(nil) == "nil" and "a" .. 1 == "a1")
        assert(tonumber("0x10") == 16 and tonumber(" 1e2 ") == 100 and tonumber("1x") == nil and tonumber({}) == nil))lua") == "");
    CHECK(complaint("string.char(256)") == "code:1: bad argument #1 to 'char' (must be a byte, 0 to 255)");
    CHECK(complaint("return '10' + 1") == "code:1: attempt to perform arithmetic on a string value (constant '10')");
}

TEST_CASE("table")
{
    CHECK(complaint(R"lua(
        local t = {1, 2, 3}
        table.insert(t, 4) table.insert(t, 1, 0)
        assert(table.concat(t, ",") == "0,1,2,3,4" and table.concat(t, "", 2, 3) == "12" and table.concat({}) == "")
        assert(table.remove(t) == 4 and table.remove(t, 1) == 0 and #t == 3 and table.remove({}) == nil)
        local a, b, c = table.unpack(t) assert(a == 1 and b == 2 and c == 3)
        assert(select("#", table.unpack({}, 1, 3)) == 3 and select(-1, 1, 2, 3) == 3 and select(2, 1, 2) == 2))lua") == "");
    CHECK(complaint("table.insert({}, 3, 1)") == "code:1: bad argument #2 to 'insert' (position out of the list)");
    CHECK(complaint("table.concat({{}})") == "code:1: table.concat joins texts and numbers; element 1 is a table");
}

TEST_CASE("errors")
{
    CHECK(complaint(R"lua(
        local ok, e = pcall(error, "x", 0) assert(not ok and e == "x")
        ok, e = pcall(function() error("x") end) assert(e == "code:3: x")
        ok, e = pcall(error, {1}) assert(e[1] == 1)
        local function twice(...) return ... end
        assert(select("#", pcall(twice, 1, nil, 3)) == 4)
        ok, e = xpcall(error, function(m) return m .. "!" end, "a") assert(not ok and e == "a!")
        ok, e = xpcall(twice, error, 5) assert(ok and e == 5)
        ok, e = pcall(assert, false, "m") assert(e == "m")
        ok, e = pcall(assert, nil) assert(e == "assertion failed")
        assert(type(1) == "number" and type("") == "string" and type(vec(0, 0, 0)) == "vec" and type(nil) == "nil"))lua") == "");
    CHECK(complaint("error('a', 0)") == "a");
    CHECK(complaint("local x = nil; x.y = 1") == "code:1: attempt to index a nil value (local 'x')");
}
