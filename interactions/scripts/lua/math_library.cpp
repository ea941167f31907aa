// The library `math`. Functions are those of the host's libm; random numbers come from the declared state of the script.
#include <cmath>
#include <limits>
#include <numbers>

#include "lua/freeze.h"
#include "lua/native.h"
#include "plab/random.h"

namespace plab::scripts
{
namespace
{

template <double (*F)(double)>
int apply(lua_State* lua)
{
    lua_pushnumber(lua, F(luaL_checknumber(lua, 1)));
    return 1;
}

int absolute(lua_State* lua)
{
    if (lua_isinteger(lua, 1))
    {
        const lua_Integer n = lua_tointeger(lua, 1);
        lua_pushinteger(lua, n < 0 ? static_cast<lua_Integer>(0u - static_cast<lua_Unsigned>(n)) : n);
    }
    else
        lua_pushnumber(lua, std::fabs(luaL_checknumber(lua, 1)));
    return 1;
}

/// Pushes an integer if the value fits, as in Lua.
int push_whole(lua_State* lua, double whole)
{
    lua_Integer n = 0;
    if (lua_numbertointeger(whole, &n))
        lua_pushinteger(lua, n);
    else
        lua_pushnumber(lua, whole);
    return 1;
}

int round_down(lua_State* lua)
{
    return lua_isinteger(lua, 1) ? (lua_settop(lua, 1), 1) : push_whole(lua, std::floor(luaL_checknumber(lua, 1)));
}
int round_up(lua_State* lua)
{
    return lua_isinteger(lua, 1) ? (lua_settop(lua, 1), 1) : push_whole(lua, std::ceil(luaL_checknumber(lua, 1)));
}

/// math.atan(y), math.atan(y, x): the angle of the point (x, y), where x is 1 unless given.
int arc_tangent(lua_State* lua)
{
    const double y = luaL_checknumber(lua, 1);
    lua_pushnumber(lua, lua_isnoneornil(lua, 2) ? std::atan(y) : std::atan2(y, luaL_checknumber(lua, 2)));
    return 1;
}

int logarithm(lua_State* lua)
{
    const double x = std::log(luaL_checknumber(lua, 1));
    lua_pushnumber(lua, lua_isnoneornil(lua, 2) ? x : x / std::log(luaL_checknumber(lua, 2)));
    return 1;
}

int remainder_of_division(lua_State* lua)
{
    const double a = luaL_checknumber(lua, 1), b = luaL_checknumber(lua, 2);
    lua_pushnumber(lua, std::fmod(a, b));
    return 1;
}

int extreme(lua_State* lua, bool largest)
{
    const int count = lua_gettop(lua);
    luaL_checknumber(lua, 1);
    charge(lua, count / 8);
    int best = 1;
    for (int i = 2; i <= count; ++i)
    {
        luaL_checknumber(lua, i);
        if (largest ? lua_compare(lua, best, i, LUA_OPLT) : lua_compare(lua, i, best, LUA_OPLT)) best = i;
    }
    lua_pushvalue(lua, best);
    return 1;
}
int smallest(lua_State* lua) { return extreme(lua, false); }
int largest(lua_State* lua) { return extreme(lua, true); }

int to_integer(lua_State* lua)
{
    int fits = 0;
    const lua_Integer n = lua_tointegerx(lua, 1, &fits);
    if (fits)
        lua_pushinteger(lua, n);
    else
        lua_pushnil(lua);
    return 1;
}

int number_type(lua_State* lua)
{
    luaL_checkany(lua, 1);
    if (lua_type(lua, 1) != LUA_TNUMBER)
        lua_pushnil(lua);
    else
        lua_pushstring(lua, lua_isinteger(lua, 1) ? "integer" : "float");
    return 1;
}

/// The state of the generator; if the scene gave none, it is seeded from the scene's seed and the component.
std::uint64_t random_state(const Call& call)
{
    if (*call.random_state != 0) return static_cast<std::uint64_t>(*call.random_state);
    const auto owners = call.context->component_of_row;
    const std::uint32_t owner = call.row < owners.size() ? owners[call.row] : kNoIndex;
    char name[sizeof owner];
    for (std::size_t i = 0; i < sizeof owner; ++i) name[i] = static_cast<char>(owner >> (8 * i));
    return seed_for(call.context->seed, name, sizeof name) | 1;
}

/// random(): [0, 1); random(n): 1..n; random(m, n): m..n.
int random_number(lua_State* lua)
{
    charge(lua, 1);
    const Call& call = running_call(lua, "math.random");
    if (!call.random_state) return luaL_error(lua, "math.random is for drive(step): force(t, state) must be pure");
    const int arguments = lua_gettop(lua);
    const lua_Integer low = arguments > 1 ? luaL_checkinteger(lua, 1) : 1;
    const lua_Integer high = arguments > 1 ? luaL_checkinteger(lua, 2) : (arguments == 1 ? luaL_checkinteger(lua, 1) : 1);
    luaL_argcheck(lua, low <= high, arguments > 1 ? 2 : 1, "the interval is empty");
    const lua_Unsigned span = static_cast<lua_Unsigned>(high) - static_cast<lua_Unsigned>(low);
    luaL_argcheck(lua, span<(1ull << 53), arguments> 1 ? 2 : 1, "the interval has more than 2^53 numbers");

    std::uint64_t state = random_state(call);
    const double u = next_uniform(state);
    *call.random_state = static_cast<std::int64_t>(state);
    if (arguments == 0)
        lua_pushnumber(lua, u);
    else
        lua_pushinteger(lua, low + static_cast<lua_Integer>(u * (static_cast<double>(span) + 1)));
    return 1;
}

constexpr NativeFunction kMathFunctions[] = {
    {"abs", absolute, "(x)", "|x|"},
    {"acos", apply<std::acos>, "(x)", "rad"},
    {"asin", apply<std::asin>, "(x)", "rad"},
    {"atan", arc_tangent, "(y, x)", "rad, of the point (x, y); x = 1 unless given"},
    {"ceil", round_up, "(x)", "rounded up"},
    {"cos", apply<std::cos>, "(angle)", "of an angle in rad"},
    {"exp", apply<std::exp>, "(x)", "e^x"},
    {"floor", round_down, "(x)", "rounded down"},
    {"fmod", remainder_of_division, "(x, y)", "remainder, with the sign of x"},
    {"log", logarithm, "(x, base)", "natural unless a base is given"},
    {"max", largest, "(x, ...)", "the largest"},
    {"min", smallest, "(x, ...)", "the smallest"},
    {"random", random_number, "(low, high)", "in drive: from [0, 1), or a whole number; out of the declared state random_state"},
    {"sin", apply<std::sin>, "(angle)", "of an angle in rad"},
    {"sqrt", apply<std::sqrt>, "(x)", "square root"},
    {"tan", apply<std::tan>, "(angle)", "of an angle in rad"},
    {"tointeger", to_integer, "(x)", "the whole number, or nil"},
    {"type", number_type, "(x)", "integer, float or nil"}};
constexpr NativeValue kValues[] = {{"pi", "rad", "half a turn"}, {"huge", "", "infinity"}};

}  // namespace

NativeGroup math_group() { return {"math.", kMathFunctions, {std::begin(kValues), std::end(kValues)}}; }

void open_math(lua_State* lua)
{
    lua_newtable(lua);
    add_functions(lua, kMathFunctions);
    lua_pushnumber(lua, std::numbers::pi);
    lua_setfield(lua, -2, "pi");
    lua_pushnumber(lua, std::numeric_limits<double>::infinity());
    lua_setfield(lua, -2, "huge");
    freeze_table(lua, -1);
    lua_setfield(lua, -2, "math");
}

}  // namespace plab::scripts
