// The basic functions: Lua's own where they are safe; otherwise versions with bounded cost, fixed order and no addresses in the
// output.
#include "lua/freeze.h"
#include "lua/native.h"

namespace plab::scripts
{
namespace
{

/// Unwinding to a pcall costs about as much as this many instructions.
constexpr lua_Integer kCatchCost = 100;

int protected_call(lua_State* lua)
{
    luaL_checkany(lua, 1);
    charge(lua, 1);
    lua_pushboolean(lua, 1);
    lua_insert(lua, 1);
    const int status = lua_pcall(lua, lua_gettop(lua) - 2, LUA_MULTRET, 0);
    if (status == LUA_OK) return lua_gettop(lua);
    rethrow_if_doomed(lua, status);
    charge(lua, kCatchCost);
    lua_pushboolean(lua, 0);
    lua_insert(lua, -2);
    return 2;
}

/// The handler runs after unwinding, not inside the error. Without the debug library there is no stack to inspect, and this way
/// it cannot keep running in a call that is over its budget.
int protected_call_with_handler(lua_State* lua)
{
    luaL_checktype(lua, 2, LUA_TFUNCTION);
    charge(lua, 1);
    lua_pushboolean(lua, 1);
    lua_pushvalue(lua, 1);
    lua_rotate(lua, 3, 2);
    const int status = lua_pcall(lua, lua_gettop(lua) - 4, LUA_MULTRET, 0);
    if (status == LUA_OK) return lua_gettop(lua) - 2;
    rethrow_if_doomed(lua, status);
    charge(lua, kCatchCost);
    lua_pushvalue(lua, 2);
    lua_insert(lua, -2);
    lua_call(lua, 1, 1);
    lua_pushboolean(lua, 0);
    lua_insert(lua, -2);
    return 2;
}

int raise(lua_State* lua)
{
    const auto level = static_cast<int>(luaL_optinteger(lua, 2, 1));
    lua_settop(lua, 1);
    if (lua_type(lua, 1) == LUA_TSTRING && level > 0)
    {
        luaL_where(lua, level);
        lua_insert(lua, 1);
        lua_concat(lua, 2);
    }
    return lua_error(lua);
}

int assert_true(lua_State* lua)
{
    luaL_checkany(lua, 1);
    if (lua_toboolean(lua, 1)) return lua_gettop(lua);
    if (lua_isnoneornil(lua, 2)) return luaL_error(lua, "assertion failed");
    lua_settop(lua, 2);
    return lua_error(lua);
}

int select_from(lua_State* lua)
{
    const int count = lua_gettop(lua) - 1;
    charge(lua, 1 + count / 8);
    if (lua_type(lua, 1) == LUA_TSTRING && std::string_view(lua_tostring(lua, 1)) == "#") return lua_pushinteger(lua, count), 1;
    const lua_Integer n = luaL_checkinteger(lua, 1);
    luaL_argcheck(lua, n != 0 && n >= -count, 1, "index out of range");
    if (n < 0) return static_cast<int>(-n);
    return n > count ? 0 : count - static_cast<int>(n) + 1;
}

int type_of_value(lua_State* lua)
{
    luaL_checkany(lua, 1);
    lua_pushstring(lua, lua_type(lua, 1) == LUA_TUSERDATA ? type_name(lua, 1) : luaL_typename(lua, 1));
    return 1;
}

int to_text(lua_State* lua)
{
    luaL_checkany(lua, 1);
    Text shown;
    append_shown(lua, 1, shown);
    push_text(lua, shown);
    return 1;
}

int to_number(lua_State* lua)
{
    luaL_checkany(lua, 1);
    if (lua_gettop(lua) > 1) return luaL_error(lua, "tonumber takes one value; other bases are not supported");
    if (lua_type(lua, 1) == LUA_TNUMBER) return lua_settop(lua, 1), 1;
    if (lua_type(lua, 1) == LUA_TSTRING)
    {
        const std::string_view text = check_text(lua, 1);
        if (lua_stringtonumber(lua, text.data()) == text.size() + 1) return 1;
    }
    lua_pushnil(lua);
    return 1;
}

int next_of_list(lua_State* lua)
{
    const lua_Integer i = luaL_checkinteger(lua, 2) + 1;
    lua_pushinteger(lua, i);
    return lua_geti(lua, 1, i) == LUA_TNIL ? 1 : 2;
}

int pairs_of_list(lua_State* lua)
{
    luaL_checktype(lua, 1, LUA_TTABLE);
    lua_pushcfunction(lua, next_of_list);
    lua_pushvalue(lua, 1);
    lua_pushinteger(lua, 0);
    return 3;
}

/// Upvalues: content, ordered keys, number of keys, position.
int next_in_order(lua_State* lua)
{
    const auto count = static_cast<int>(lua_tointeger(lua, lua_upvalueindex(3)));
    for (auto at = static_cast<int>(lua_tointeger(lua, lua_upvalueindex(4))) + 1; at <= count; ++at)
    {
        lua_settop(lua, 0);
        lua_rawgeti(lua, lua_upvalueindex(2), at);
        lua_pushvalue(lua, -1);
        if (lua_rawget(lua, lua_upvalueindex(1)) == LUA_TNIL) continue;  // removed in the meantime
        lua_pushinteger(lua, at);
        lua_replace(lua, lua_upvalueindex(4));
        return 2;
    }
    lua_pushnil(lua);
    return 1;
}

/// Lua's own order depends on the clock and on addresses; this one depends on the keys alone.
int pairs_in_order(lua_State* lua)
{
    push_content(lua, 1);
    bool others = false;
    const int count = push_ordered_keys(lua, -1, others);
    if (others) return luaL_error(lua, "pairs has an order for keys that are numbers or texts only");
    lua_pushinteger(lua, count);
    lua_pushinteger(lua, 0);
    lua_pushcclosure(lua, next_in_order, 4);
    return 1;
}

constexpr NativeFunction kBaseFunctions[] = {
    {"assert", assert_true, "(value, message)", "the error `message` unless `value` holds"},
    {"error", raise, "(message)", "ends the call: event script.error"},
    {"ipairs", pairs_of_list, "(list)", "for i = 1, 2, ... until nil"},
    {"pairs", pairs_in_order, "(table)", "number keys ascending, then texts by bytes"},
    {"pcall", protected_call, "(f, ...)", "true and the results, or false and the error; not past a budget"},
    {"xpcall", protected_call_with_handler, "(f, handler, ...)", "the same, with a handler of errors"},
    {"select", select_from, "(n, ...)", "the arguments from the nth on; '#': how many"},
    {"tonumber", to_number, "(value, base)", "the number, or nil"},
    {"tostring", to_text, "(value)", "as text; no addresses"},
    {"type", type_of_value, "(value)", "nil, boolean, number, string, table, function or userdata"}};

}  // namespace

NativeGroup base_group() { return {"", kBaseFunctions}; }

void open_base(lua_State* lua) { add_functions(lua, kBaseFunctions); }

}  // namespace plab::scripts
