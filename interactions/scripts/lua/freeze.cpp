#include "lua/freeze.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace plab::scripts
{
namespace
{

struct Key
{
    bool text = false;
    bool integer = false;
    lua_Integer whole = 0;
    double number = 0;
    std::string_view bytes;
    int place = 0;  // index in the list of unsorted keys
};

/// The keys of one table differ, so this is a total order.
bool precedes(const Key& a, const Key& b)
{
    if (a.text != b.text) return b.text;
    if (a.text) return a.bytes < b.bytes;
    if (a.integer && b.integer) return a.whole < b.whole;
    if (a.number != b.number) return a.number < b.number;
    return a.integer && !b.integer;  // an integer beyond 2^53 and the float that it rounds to
}

Key key_at(lua_State* lua, int index, int place)
{
    Key key;
    key.place = place;
    key.text = lua_type(lua, index) == LUA_TSTRING;
    if (key.text)
    {
        std::size_t n = 0;
        const char* s = lua_tolstring(lua, index, &n);
        key.bytes = {s, n};
        return key;
    }
    key.integer = lua_isinteger(lua, index) != 0;
    key.whole = lua_tointeger(lua, index);
    key.number = lua_tonumber(lua, index);
    return key;
}

/// Pushes the sortable keys of the table in their present order, and the same number of Keys in a userdata above them.
int push_keys(lua_State* lua, int table, bool& others)
{
    int count = 0;
    others = false;
    for (lua_pushnil(lua); lua_next(lua, table) != 0; lua_pop(lua, 1)) ++count;
    lua_createtable(lua, count, 0);
    const int list = lua_gettop(lua);
    auto* keys = static_cast<Key*>(lua_newuserdatauv(lua, sizeof(Key) * static_cast<std::size_t>(count) + 1, 0));
    count = 0;
    for (lua_pushnil(lua); lua_next(lua, table) != 0; lua_pop(lua, 1))
    {
        const int type = lua_type(lua, -2);
        if (type != LUA_TNUMBER && type != LUA_TSTRING)
        {
            others = true;
            continue;
        }
        new (keys + count) Key(key_at(lua, -2, count + 1));
        ++count;
        lua_pushvalue(lua, -2);
        lua_rawseti(lua, list, count);
    }
    return count;
}

int refuse_change(lua_State* lua)
{
    return luaL_error(lua, "a table made while loading is read-only: values that live across steps belong in `state`");
}

int frozen_length(lua_State* lua)
{
    push_content(lua, 1);
    lua_pushinteger(lua, static_cast<lua_Integer>(lua_rawlen(lua, -1)));
    return 1;
}

/// Copies the entries of `table` for the list `keys`, in that order: the internal layout of a table, and with it the length of
/// one with holes, depends on the order of insertion.
void copy_ordered(lua_State* lua, int table, int keys, int count, int copy)
{
    for (int i = 1; i <= count; ++i)
    {
        lua_rawgeti(lua, keys, i);
        lua_pushvalue(lua, -1);
        lua_rawget(lua, table);
        lua_rawset(lua, copy);
    }
}

void copy_others(lua_State* lua, int table, int copy)
{
    for (lua_pushnil(lua); lua_next(lua, table) != 0; lua_pop(lua, 1))
    {
        const int type = lua_type(lua, -2);
        if (type == LUA_TNUMBER || type == LUA_TSTRING) continue;
        lua_pushvalue(lua, -2);
        lua_pushvalue(lua, -2);
        lua_rawset(lua, copy);
    }
}

void clear_table(lua_State* lua, int table)
{
    for (lua_pushnil(lua); lua_next(lua, table) != 0; lua_pop(lua, 1))
    {
        lua_pushvalue(lua, -2);
        lua_pushnil(lua);
        lua_rawset(lua, table);
    }
}

}  // namespace

int push_ordered_keys(lua_State* lua, int index, bool& others)
{
    luaL_checkstack(lua, 8, "keys of a table");
    const int table = lua_absindex(lua, index);
    const int count = push_keys(lua, table, others);
    const int unsorted = lua_gettop(lua) - 1;
    auto* keys = static_cast<Key*>(lua_touserdata(lua, -1));
    charge(lua, count * (1 + static_cast<int>(std::bit_width(static_cast<unsigned>(count)))));
    std::sort(keys, keys + count, precedes);
    lua_createtable(lua, count, 0);
    for (int i = 0; i < count; ++i)
    {
        lua_rawgeti(lua, unsorted, keys[i].place);
        lua_rawseti(lua, -2, i + 1);
    }
    lua_replace(lua, unsorted);
    lua_settop(lua, unsorted);
    return count;
}

bool is_frozen(lua_State* lua, int index)
{
    if (lua_type(lua, index) != LUA_TTABLE || !lua_getmetatable(lua, index)) return false;
    lua_pop(lua, 1);
    return true;
}

void push_content(lua_State* lua, int argument)
{
    luaL_checktype(lua, argument, LUA_TTABLE);
    if (!lua_getmetatable(lua, argument))
    {
        lua_pushvalue(lua, argument);
        return;
    }
    lua_pushliteral(lua, "__index");
    lua_rawget(lua, -2);
    lua_remove(lua, -2);
}

void check_changeable(lua_State* lua, int argument)
{
    luaL_checktype(lua, argument, LUA_TTABLE);
    if (is_frozen(lua, argument)) refuse_change(lua);
}

void freeze_table(lua_State* lua, int index)
{
    const int table = lua_absindex(lua, index);
    bool others = false;
    const int count = push_ordered_keys(lua, table, others);
    const int keys = lua_gettop(lua);
    lua_createtable(lua, static_cast<int>(lua_rawlen(lua, table)), 0);
    const int copy = lua_gettop(lua);
    copy_ordered(lua, table, keys, count, copy);
    if (others) copy_others(lua, table, copy);
    clear_table(lua, table);

    lua_createtable(lua, 0, 3);
    lua_pushvalue(lua, copy);
    lua_setfield(lua, -2, "__index");
    lua_pushcfunction(lua, refuse_change);
    lua_setfield(lua, -2, "__newindex");
    lua_pushcfunction(lua, frozen_length);
    lua_setfield(lua, -2, "__len");
    lua_setmetatable(lua, table);
    lua_settop(lua, keys - 1);
}

namespace
{

/// Traverses what functions can reach. `queue` lists what is still to be visited, `seen` everything that has ever been in it.
struct Walk
{
    lua_State* lua;
    int seen, queue, functions, pinned;
    lua_Integer length = 0;
    int function_count = 0;
    int pinned_count = 0;
    std::vector<const void*> cells{};  // locals that are watched already, by identity
};

/// Queues the value at `index` if it can contain other values.
void reach(Walk& walk, int index)
{
    lua_State* lua = walk.lua;
    const int type = lua_type(lua, index);
    if (lua_iscfunction(lua, index) && lua_getupvalue(lua, index, 1))
        luaL_error(lua, "the result of pairs cannot be stored: call pairs in the loop itself");  // the iterator counts
    const bool table = type == LUA_TTABLE && !is_frozen(lua, index);
    const bool function = type == LUA_TFUNCTION && !lua_iscfunction(lua, index);
    if (!table && !function) return;
    const int value = lua_absindex(lua, index);
    lua_pushvalue(lua, value);
    const bool known = lua_rawget(lua, walk.seen) != LUA_TNIL;
    lua_pop(lua, 1);
    if (known) return;
    lua_pushvalue(lua, value);
    lua_pushboolean(lua, 1);
    lua_rawset(lua, walk.seen);
    lua_pushvalue(lua, value);
    lua_rawseti(lua, walk.queue, ++walk.length);
}

void reach_content(Walk& walk, int table)
{
    for (lua_pushnil(walk.lua); lua_next(walk.lua, table) != 0; lua_pop(walk.lua, 1))
    {
        reach(walk, -2);
        reach(walk, -1);
    }
}

/// The identity of a value: two of these are equal if the values are the same.
Watch describe(lua_State* lua, int index)
{
    Watch w;
    w.type = lua_type(lua, index);
    if (w.type == LUA_TBOOLEAN)
        w.bits = static_cast<std::uint64_t>(lua_toboolean(lua, index));
    else if (w.type == LUA_TNUMBER && lua_isinteger(lua, index))
        w.integer = true, w.bits = static_cast<std::uint64_t>(lua_tointeger(lua, index));
    else if (w.type == LUA_TNUMBER)
        w.bits = std::bit_cast<std::uint64_t>(static_cast<double>(lua_tonumber(lua, index)));
    else if (w.type != LUA_TNIL)
        w.bits = reinterpret_cast<std::uintptr_t>(lua_topointer(lua, index));
    return w;
}

/// Watches the locals that the function on top of the stack shares, and follows their values.
void reach_locals(Walk& walk)
{
    lua_State* lua = walk.lua;
    const int function = lua_gettop(lua);
    bool holds_any = false;
    for (int i = 1; lua_getupvalue(lua, function, i); ++i, lua_pop(lua, 1))
    {
        const void* cell = lua_upvalueid(lua, function, i);
        if (std::find(walk.cells.begin(), walk.cells.end(), cell) != walk.cells.end()) continue;
        walk.cells.push_back(cell);
        reach(walk, -1);
        Watch w = describe(lua, -1);
        w.function = kFirstWatchedSlot + walk.function_count, w.upvalue = i;
        session_of(lua).watches.push_back(w);
        lua_pushvalue(lua, -1);
        if (lua_isnil(lua, -1))
            lua_pop(lua, 1);
        else
            lua_rawseti(lua, walk.pinned, ++walk.pinned_count);
        holds_any = true;
    }
    if (!holds_any) return;
    lua_pushvalue(lua, function);
    lua_rawseti(lua, walk.functions, ++walk.function_count);
}

}  // namespace

int freeze_reachable(lua_State* lua, int globals)
{
    luaL_checkstack(lua, 16, "freezing");
    const int table = lua_absindex(lua, globals);
    lua_newtable(lua);
    lua_newtable(lua);
    lua_newtable(lua);
    lua_newtable(lua);
    const int top = lua_gettop(lua);
    Walk walk{lua, top - 3, top - 2, top - 1, top};
    lua_pushvalue(lua, walk.pinned);
    lua_rawseti(lua, LUA_REGISTRYINDEX, kPinned);
    reach_content(walk, table);
    for (lua_Integer i = 1; i <= walk.length; ++i)
    {
        if (lua_rawgeti(lua, walk.queue, i) == LUA_TFUNCTION)
            reach_locals(walk);
        else
        {
            reach_content(walk, lua_gettop(lua));
            freeze_table(lua, -1);
        }
        lua_pop(lua, 1);
    }
    lua_pushvalue(lua, walk.functions);
    lua_replace(lua, walk.seen);
    lua_settop(lua, walk.seen);
    return walk.function_count;
}

const char* find_changed_local(lua_State* lua, const Session& session)
{
    for (const Watch& before : session.watches)
    {
        const char* name = lua_getupvalue(lua, before.function, before.upvalue);
        const Watch now = describe(lua, -1);
        lua_pop(lua, 1);
        if (now.type != before.type || now.integer != before.integer || now.bits != before.bits) return name;
    }
    return nullptr;
}

}  // namespace plab::scripts
