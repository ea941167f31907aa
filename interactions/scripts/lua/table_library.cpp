// The library `table`: lists, with bounds on the cost of a call, and a stable sort.
#include <algorithm>
#include <bit>

#include "lua/freeze.h"
#include "lua/native.h"

namespace plab::scripts
{
namespace
{

constexpr lua_Integer kMostUnpacked = 200;
constexpr lua_Integer kLongestSort = 10000;

/// Length of the list at argument 1; charges for moving `share` of it.
lua_Integer changeable_length(lua_State* lua)
{
    check_changeable(lua, 1);
    return static_cast<lua_Integer>(lua_rawlen(lua, 1));
}

int insert(lua_State* lua)
{
    const lua_Integer n = changeable_length(lua);
    const int arguments = lua_gettop(lua);
    if (arguments != 2 && arguments != 3) return luaL_error(lua, "table.insert takes (list, value) or (list, position, value)");
    const lua_Integer at = arguments == 2 ? n + 1 : luaL_checkinteger(lua, 2);
    luaL_argcheck(lua, at >= 1 && at <= n + 1, 2, "position out of the list");
    charge(lua, 1 + (n - at + 1) / 4);
    for (lua_Integer i = n; i >= at; --i)
    {
        lua_rawgeti(lua, 1, i);
        lua_rawseti(lua, 1, i + 1);
    }
    lua_pushvalue(lua, arguments);
    lua_rawseti(lua, 1, at);
    return 0;
}

int remove(lua_State* lua)
{
    const lua_Integer n = changeable_length(lua);
    const lua_Integer at = luaL_optinteger(lua, 2, n);
    if (n == 0 && (at == 0 || at == 1)) return lua_pushnil(lua), 1;
    luaL_argcheck(lua, at >= 1 && at <= n, 2, "position out of the list");
    charge(lua, 1 + (n - at) / 4);
    lua_rawgeti(lua, 1, at);
    for (lua_Integer i = at; i < n; ++i)
    {
        lua_rawgeti(lua, 1, i + 1);
        lua_rawseti(lua, 1, i);
    }
    lua_pushnil(lua);
    lua_rawseti(lua, 1, n);
    return 1;
}

int concatenate(lua_State* lua)
{
    push_content(lua, 1);
    lua_replace(lua, 1);
    const std::string_view between = lua_isnoneornil(lua, 2) ? std::string_view() : check_text(lua, 2);
    const lua_Integer from = luaL_optinteger(lua, 3, 1);
    const lua_Integer to = luaL_optinteger(lua, 4, static_cast<lua_Integer>(lua_rawlen(lua, 1)));
    luaL_argcheck(lua, from >= 1 && to < (1 << 30), 3, "position out of the list");
    Text out;
    for (lua_Integer i = from; i <= to && out.fits(); ++i)
    {
        charge(lua, 1);
        const int type = lua_rawgeti(lua, 1, i);
        if (type != LUA_TSTRING && type != LUA_TNUMBER)
            return luaL_error(lua, "table.concat joins texts and numbers; element %I is a %s", i, type_name(lua, -1));
        append_shown(lua, -1, out);
        lua_pop(lua, 1);
        if (i < to) out.append(between);
    }
    push_text(lua, out);
    return 1;
}

int unpack(lua_State* lua)
{
    push_content(lua, 1);
    lua_replace(lua, 1);
    const lua_Integer from = luaL_optinteger(lua, 2, 1);
    const lua_Integer to = luaL_optinteger(lua, 3, static_cast<lua_Integer>(lua_rawlen(lua, 1)));
    if (from > to) return 0;
    const auto count = static_cast<lua_Unsigned>(to) - static_cast<lua_Unsigned>(from);
    luaL_argcheck(lua, count < static_cast<lua_Unsigned>(kMostUnpacked), 3, "at most 200 values at a time");
    luaL_checkstack(lua, static_cast<int>(kMostUnpacked), "table.unpack");
    charge(lua, static_cast<lua_Integer>(count) / 4);
    for (lua_Unsigned i = 0; i <= count; ++i) lua_rawgeti(lua, 1, static_cast<lua_Integer>(static_cast<lua_Unsigned>(from) + i));
    return static_cast<int>(count + 1);
}

/// Strings by bytes, so that no locale changes an order.
bool less_by_default(lua_State* lua, int a, int b)
{
    const int type = lua_type(lua, a);
    if (type != lua_type(lua, b) || (type != LUA_TNUMBER && type != LUA_TSTRING))
        luaL_error(lua, "table.sort orders numbers or texts; give it a function to compare a %s with a %s", type_name(lua, a),
                   type_name(lua, b));
    if (type == LUA_TNUMBER) return lua_compare(lua, a, b, LUA_OPLT) != 0;
    return std::string_view(lua_tostring(lua, a), lua_rawlen(lua, a)) < std::string_view(lua_tostring(lua, b), lua_rawlen(lua, b));
}

/// Whether list[i] is ordered before list[j].
bool comes_before(lua_State* lua, int list, lua_Integer i, lua_Integer j)
{
    charge(lua, 2);
    const bool own = !lua_isnoneornil(lua, 2);
    if (own) lua_pushvalue(lua, 2);
    lua_rawgeti(lua, list, i);
    lua_rawgeti(lua, list, j);
    bool less = false;
    if (own)
    {
        lua_call(lua, 2, 1);
        less = lua_toboolean(lua, -1) != 0;
        lua_pop(lua, 1);
        return less;
    }
    less = less_by_default(lua, -2, -1);
    lua_pop(lua, 2);
    return less;
}

void copy_element(lua_State* lua, int from, lua_Integer i, int to, lua_Integer j)
{
    lua_rawgeti(lua, from, i);
    lua_rawseti(lua, to, j);
}

/// Merges from[low, middle) and from[middle, high) into to[low, high). Of equal elements, the left one comes first.
void merge(lua_State* lua, int from, int to, lua_Integer low, lua_Integer middle, lua_Integer high)
{
    lua_Integer left = low, right = middle;
    for (lua_Integer at = low; at < high; ++at)
    {
        const bool take_right = right < high && (left >= middle || comes_before(lua, from, right, left));
        copy_element(lua, from, take_right ? right++ : left++, to, at);
    }
}

/// Bottom-up merge sort between two copies; the list itself changes only after the order is known.
int sort(lua_State* lua)
{
    const lua_Integer n = changeable_length(lua);
    luaL_argcheck(lua, n <= kLongestSort, 1, "at most 10000 elements can be sorted");
    if (!lua_isnoneornil(lua, 2)) luaL_checktype(lua, 2, LUA_TFUNCTION);
    lua_settop(lua, 2);
    charge(lua, 2 * n);
    lua_createtable(lua, static_cast<int>(n), 0);
    lua_createtable(lua, static_cast<int>(n), 0);
    int from = 3, to = 4;
    for (lua_Integer i = 1; i <= n; ++i) copy_element(lua, 1, i, from, i);
    for (lua_Integer run = 1; run < n; run *= 2)
    {
        for (lua_Integer low = 1; low <= n; low += 2 * run)
            merge(lua, from, to, low, std::min(low + run, n + 1), std::min(low + 2 * run, n + 1));
        std::swap(from, to);
    }
    for (lua_Integer i = 1; i <= n; ++i) copy_element(lua, from, i, 1, i);
    return 0;
}

constexpr NativeFunction kTableFunctions[] = {{"concat", concatenate, "(list, between, from, to)", "the elements as one text"},
                                              {"insert", insert, "(list, place, value)", "at the end without a place"},
                                              {"remove", remove, "(list, place)", "the last one without a place"},
                                              {"sort", sort, "(list, less)", "stable: equal elements keep their order"},
                                              {"unpack", unpack, "(list, from, to)", "the elements as several values"}};

}  // namespace

NativeGroup table_group() { return {"table.", kTableFunctions}; }

void open_table(lua_State* lua)
{
    lua_newtable(lua);
    add_functions(lua, kTableFunctions);
    freeze_table(lua, -1);
    lua_setfield(lua, -2, "table");
}

}  // namespace plab::scripts
