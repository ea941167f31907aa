// state, parameters and step: views of data that the host owns. Nothing is copied, so a restored memento takes effect
// immediately.
#include <algorithm>
#include <cmath>
#include <new>

#include "lua/native.h"

namespace plab::scripts
{
namespace
{

const Entries& entries_of(lua_State* lua, const Object& window)
{
    const Call& call = *session_of(lua).call;
    return window.tag == Tag::State ? *running_call(lua, "state").state : *call.parameters;
}

const char* name_of(const Object& window) { return window.tag == Tag::State ? "state" : "parameters"; }

int refuse_name(lua_State* lua, const Object& window, const Entries& entries)
{
    std::string known = "declared are: ";
    for (const Entry& e : entries) known += (&e == &entries.front() ? "" : ", ") + e.name;
    if (entries.empty()) known = "declare it with its first value, " + std::string(name_of(window)) + "=\"NAME=0\"";
    lua_pushlstring(lua, known.data(), std::min<std::size_t>(known.size(), 500));
    const char* key = lua_type(lua, 2) == LUA_TSTRING ? lua_tostring(lua, 2) : type_name(lua, 2);
    return luaL_error(lua, "%s has no '%s'; %s", name_of(window), key, lua_tostring(lua, -1));
}

const Entry* find_entry(lua_State* lua, const Entries& entries)
{
    if (lua_type(lua, 2) != LUA_TSTRING) return nullptr;
    std::size_t n = 0;
    const char* s = lua_tolstring(lua, 2, &n);
    for (const Entry& e : entries)
        if (e.name == std::string_view(s, n)) return &e;
    return nullptr;
}

int entry_get(lua_State* lua)
{
    const auto& window = *static_cast<Object*>(lua_touserdata(lua, 1));
    const Entries& entries = entries_of(lua, window);
    const Entry* e = find_entry(lua, entries);
    if (!e) return refuse_name(lua, window, entries);
    if (const auto* number = std::get_if<double>(&e->value))
        lua_pushnumber(lua, *number);
    else if (const auto* truth = std::get_if<bool>(&e->value))
        lua_pushboolean(lua, *truth);
    else
        push_text(lua, std::get<std::string>(e->value));
    return 1;
}

int refuse_type(lua_State* lua, const Entry& e)
{
    constexpr const char* kTypes[] = {"truth value", "number", "text"};
    return luaL_error(lua, "state.%s is a %s, and stays one: it cannot be a %s", e.name.c_str(), kTypes[e.value.index()],
                      type_name(lua, 3));
}

int entry_set(lua_State* lua)
{
    const auto& window = *static_cast<Object*>(lua_touserdata(lua, 1));
    if (window.tag == Tag::Parameters) return luaL_error(lua, "parameters are read-only in the script: a request sets them");
    const Call& call = running_call(lua, "state");
    if (!call.writable_state) return luaL_error(lua, "state is read-only in force(t, state): change it in drive(step)");
    const auto* found = find_entry(lua, *call.writable_state);
    if (!found) return refuse_name(lua, window, *call.writable_state);
    Entry& e = (*call.writable_state)[static_cast<std::size_t>(found - call.writable_state->data())];
    constexpr int kLuaType[] = {LUA_TBOOLEAN, LUA_TNUMBER, LUA_TSTRING};
    if (lua_type(lua, 3) != kLuaType[e.value.index()]) return refuse_type(lua, e);
    if (auto* truth = std::get_if<bool>(&e.value))
        *truth = lua_toboolean(lua, 3) != 0;
    else if (auto* number = std::get_if<double>(&e.value))
    {
        if (!std::isfinite(lua_tonumber(lua, 3))) return luaL_error(lua, "state.%s is not finite", e.name.c_str());
        *number = lua_tonumber(lua, 3);
    }
    else
    {
        const std::string_view text = check_text(lua, 3);
        if (!is_utf8(text)) return luaL_error(lua, "state.%s must be UTF-8 text", e.name.c_str());
        std::get<std::string>(e.value) = text;
    }
    return 0;
}

constexpr NativeValue kStepValues[] = {{"time", "s", "where the step begins"}, {"dt", "s", "its length"}, {"tick", "", "its number"}};

int step_get(lua_State* lua)
{
    const Call& call = running_call(lua, "step");
    const std::string_view name = lua_type(lua, 2) == LUA_TSTRING ? lua_tostring(lua, 2) : "";
    if (name == kStepValues[0].name)
        lua_pushnumber(lua, call.context->time);
    else if (name == kStepValues[1].name)
        lua_pushnumber(lua, call.context->dt);
    else if (name == kStepValues[2].name)
        lua_pushinteger(lua, call.context->tick);
    else
        return luaL_error(lua, "step has only time, dt and tick");
    return 1;
}

int step_set(lua_State* lua) { return luaL_error(lua, "step is read-only"); }

void make_metatable(lua_State* lua, int slot, const char* name, lua_CFunction get, lua_CFunction set)
{
    lua_newtable(lua);
    lua_pushcfunction(lua, get);
    lua_setfield(lua, -2, "__index");
    lua_pushcfunction(lua, set);
    lua_setfield(lua, -2, "__newindex");
    lua_pushstring(lua, name);
    lua_setfield(lua, -2, "__name");
    lua_rawseti(lua, LUA_REGISTRYINDEX, slot);
}

void push_window(lua_State* lua, Tag tag, int meta)
{
    push_object<Object>(lua, tag);
    lua_rawgeti(lua, LUA_REGISTRYINDEX, meta);
    lua_setmetatable(lua, -2);
}

}  // namespace

NativeGroup step_group() { return {"step", {}, {std::begin(kStepValues), std::end(kStepValues)}}; }

void open_records(lua_State* lua)
{
    make_metatable(lua, kEntriesMeta, "record", entry_get, entry_set);
    make_metatable(lua, kStepMeta, "step", step_get, step_set);
    push_window(lua, Tag::State, kEntriesMeta);
    lua_setfield(lua, -2, "state");
    push_window(lua, Tag::Parameters, kEntriesMeta);
    lua_setfield(lua, -2, "parameters");
    push_window(lua, Tag::Step, kStepMeta);
    lua_rawseti(lua, LUA_REGISTRYINDEX, kStep);
}

}  // namespace plab::scripts
