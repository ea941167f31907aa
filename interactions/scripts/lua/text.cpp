// Bounded strings, and readable representations of values.
#include <cstdio>

#include "lua/native.h"

namespace plab::scripts
{

void add_functions(lua_State* lua, std::span<const NativeFunction> functions)
{
    for (const NativeFunction& f : functions)
    {
        lua_pushcfunction(lua, f.call);
        lua_setfield(lua, -2, f.name);
    }
}

const char* type_name(lua_State* lua, int index)
{
    switch (lua_type(lua, index))
    {
        case LUA_TUSERDATA:
            break;
        case LUA_TSTRING:
            return "text";
        case LUA_TBOOLEAN:
            return "truth value";
        default:
            return luaL_typename(lua, index);
    }
    switch (static_cast<const Object*>(lua_touserdata(lua, index))->tag)
    {
        case Tag::Vector:
            return "vec";
        case Tag::Rotation:
            return "rotation";
        case Tag::Participant:
            return "participant";
        case Tag::State:
            return "state";
        case Tag::Parameters:
            return "parameters";
        case Tag::Step:
            return "step";
    }
    return "object";
}

namespace
{

int refuse_length(lua_State* lua, std::size_t bytes)
{
    return luaL_error(lua, "a text of %I bytes; at most %I are allowed", static_cast<lua_Integer>(bytes),
                      static_cast<lua_Integer>(kLongestText));
}

}  // namespace

void push_text(lua_State* lua, std::string_view text)
{
    if (text.size() > kLongestText) refuse_length(lua, text.size());
    lua_pushlstring(lua, text.data(), text.size());
}

void push_text(lua_State* lua, const Text& text)
{
    if (!text.fits()) refuse_length(lua, text.wanted());
    charge(lua, static_cast<lua_Integer>(text.wanted() / 32));
    lua_pushlstring(lua, text.view().data(), text.view().size());
}

std::string_view check_text(lua_State* lua, int argument)
{
    std::size_t n = 0;
    const char* s = luaL_checklstring(lua, argument, &n);
    charge(lua, static_cast<lua_Integer>(n / 32));
    return {s, n};
}

void append_shown(lua_State* lua, int index, Text& out)
{
    char buffer[96];
    switch (lua_type(lua, index))
    {
        case LUA_TNIL:
            return out.append("nil");
        case LUA_TBOOLEAN:
            return out.append(lua_toboolean(lua, index) ? "true" : "false");
        case LUA_TSTRING:
            return out.append({lua_tostring(lua, index), lua_rawlen(lua, index)});
        case LUA_TNUMBER:
            lua_pushvalue(lua, index);
            out.append(lua_tostring(lua, -1));
            return lua_pop(lua, 1);
        default:
            break;
    }
    if (const Vec3* v = to_vector(lua, index))
    {
        std::snprintf(buffer, sizeof buffer, "vec(%.14g, %.14g, %.14g)", v->x, v->y, v->z);
        return out.append(buffer);
    }
    out.append(lua_type(lua, index) == LUA_TUSERDATA ? type_name(lua, index) : luaL_typename(lua, index));
}

namespace
{

/// The number of bytes that follow a lead byte, and the smallest code point that may be encoded this way; -1: not a lead byte.
int follow_bytes(unsigned char lead, std::uint32_t& smallest)
{
    if (lead < 0x80) return smallest = 0, 0;
    if (lead >= 0xc2 && lead < 0xe0) return smallest = 0x80, 1;
    if (lead >= 0xe0 && lead < 0xf0) return smallest = 0x800, 2;
    if (lead >= 0xf0 && lead < 0xf5) return smallest = 0x10000, 3;
    return -1;
}

}  // namespace

bool is_utf8(std::string_view text)
{
    for (std::size_t i = 0; i < text.size();)
    {
        const auto lead = static_cast<unsigned char>(text[i++]);
        std::uint32_t smallest = 0;
        const int follow = follow_bytes(lead, smallest);
        if (follow < 0 || text.size() - i < static_cast<std::size_t>(follow)) return false;
        std::uint32_t code = follow == 0 ? lead : lead & (0x3fu >> follow);
        for (int k = 0; k < follow; ++k, ++i)
        {
            if ((static_cast<unsigned char>(text[i]) & 0xc0) != 0x80) return false;
            code = code << 6 | (static_cast<unsigned char>(text[i]) & 0x3f);
        }
        if (code < smallest || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return false;
    }
    return true;
}

}  // namespace plab::scripts
