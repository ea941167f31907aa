// The library `string`, with bounded cost: no patterns, as the budget could not bound the time for matching them.
#include <algorithm>
#include <cstdio>

#include "lua/freeze.h"
#include "lua/native.h"

namespace plab::scripts
{
namespace
{

constexpr lua_Integer kMostBytes = 200;  // results of string.byte, arguments of string.char

/// A position as in Lua: counted from 1, or from the end if negative.
lua_Integer start_of(lua_Integer position, lua_Integer length)
{
    if (position > 0) return position;
    return position == 0 || position < -length ? 1 : length + position + 1;
}
lua_Integer end_of(lua_Integer position, lua_Integer length)
{
    if (position > length) return length;
    return position >= 0 ? position : (position < -length ? 0 : length + position + 1);
}

int part(lua_State* lua)
{
    const std::string_view s = check_text(lua, 1);
    const auto n = static_cast<lua_Integer>(s.size());
    const lua_Integer from = start_of(luaL_checkinteger(lua, 2), n), to = end_of(luaL_optinteger(lua, 3, -1), n);
    push_text(lua, from > to ? std::string_view() : s.substr(static_cast<std::size_t>(from - 1), static_cast<std::size_t>(to - from + 1)));
    return 1;
}

int length_of(lua_State* lua)
{
    std::size_t n = 0;
    luaL_checklstring(lua, 1, &n);
    lua_pushinteger(lua, static_cast<lua_Integer>(n));
    return 1;
}

/// ASCII only, so that results do not depend on a locale.
int change_case(lua_State* lua, char first, char last, int shift)
{
    Text out;
    for (const char c : check_text(lua, 1)) out.append(c >= first && c <= last ? static_cast<char>(c + shift) : c);
    push_text(lua, out);
    return 1;
}
int upper(lua_State* lua) { return change_case(lua, 'a', 'z', 'A' - 'a'); }
int lower(lua_State* lua) { return change_case(lua, 'A', 'Z', 'a' - 'A'); }

int repeat(lua_State* lua)
{
    const std::string_view s = check_text(lua, 1);
    const lua_Integer times = luaL_checkinteger(lua, 2);
    const std::string_view between = lua_isnoneornil(lua, 3) ? std::string_view() : check_text(lua, 3);
    Text out;
    if (s.empty() && between.empty()) return push_text(lua, out), 1;
    // The last piece has no separator after it, hence the addition; `out` detects a string that is still too long.
    const auto most = static_cast<lua_Integer>(kLongestText / (s.size() + between.size())) + 1;
    for (lua_Integer i = 0; i < times && times <= most; ++i)
    {
        if (i > 0) out.append(between);
        out.append(s);
    }
    if (!out.fits() || times > most)
        return luaL_error(lua, "string.rep makes a text of more than %I bytes", static_cast<lua_Integer>(kLongestText));
    push_text(lua, out);
    return 1;
}

int bytes_of(lua_State* lua)
{
    const std::string_view s = check_text(lua, 1);
    const auto n = static_cast<lua_Integer>(s.size());
    const lua_Integer first = luaL_optinteger(lua, 2, 1);
    const lua_Integer from = start_of(first, n), to = end_of(luaL_optinteger(lua, 3, from), n);
    if (from > to) return 0;
    luaL_argcheck(lua, to - from < kMostBytes, 3, "at most 200 bytes at a time");
    luaL_checkstack(lua, static_cast<int>(to - from + 1), "string.byte");
    for (lua_Integer i = from; i <= to; ++i) lua_pushinteger(lua, static_cast<unsigned char>(s[static_cast<std::size_t>(i - 1)]));
    return static_cast<int>(to - from + 1);
}

int text_of_bytes(lua_State* lua)
{
    const int count = lua_gettop(lua);
    luaL_argcheck(lua, count <= kMostBytes, static_cast<int>(kMostBytes), "at most 200 bytes at a time");
    Text out;
    for (int i = 1; i <= count; ++i)
    {
        const lua_Integer c = luaL_checkinteger(lua, i);
        luaL_argcheck(lua, c >= 0 && c < 256, i, "must be a byte, 0 to 255");
        out.append(static_cast<char>(c));
    }
    push_text(lua, out);
    return 1;
}

/// Conversions like "%-5.3f"; width and precision have at most two digits, so no conversion is long.
struct Conversion
{
    char spec[16];
    std::size_t length = 0;
    char letter = 0;

    bool add(char c)
    {
        if (length + 4 >= sizeof spec) return false;
        spec[length++] = c;
        return true;
    }
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Reads up to two digits; false if there are more.
bool read_digits(std::string_view form, std::size_t& at, Conversion& out)
{
    for (int n = 0; at < form.size() && is_digit(form[at]); ++at, ++n)
        if (n == 2 || !out.add(form[at])) return false;
    return true;
}

/// `at` points behind the %.
bool read_conversion(std::string_view form, std::size_t& at, Conversion& out)
{
    out.add('%');
    while (at < form.size() && std::string_view("-+ #0").find(form[at]) != std::string_view::npos)
        if (!out.add(form[at++])) return false;
    if (!read_digits(form, at, out)) return false;
    if (at < form.size() && form[at] == '.')
    {
        out.add(form[at++]);
        if (!read_digits(form, at, out)) return false;
    }
    if (at >= form.size()) return false;
    out.letter = form[at++];
    return true;
}

void append_number(lua_State* lua, Conversion& c, int argument, Text& out)
{
    char buffer[512];  // enough for 309 digits and 99 decimals of the largest number
    int n = 0;
    if (std::string_view("dixXo").find(c.letter) != std::string_view::npos)
    {
        const long long value = luaL_checkinteger(lua, argument);
        c.add('l'), c.add('l'), c.add(c.letter), c.spec[c.length] = 0;
        n = std::snprintf(buffer, sizeof buffer, c.spec, value);
    }
    else
    {
        const double value = luaL_checknumber(lua, argument);
        c.add(c.letter), c.spec[c.length] = 0;
        n = std::snprintf(buffer, sizeof buffer, c.spec, value);
    }
    out.append({buffer, static_cast<std::size_t>(std::clamp(n, 0, static_cast<int>(sizeof buffer) - 1))});
}

/// %s, with a precision that truncates and a width that pads.
void append_padded(lua_State* lua, const Conversion& c, int argument, Text& out)
{
    luaL_checkany(lua, argument);
    Text shown;
    append_shown(lua, argument, shown);
    const std::string_view spec(c.spec + 1, c.length - 1);
    std::size_t width = 0, precision = kLongestText, at = 0;
    const bool left = spec.starts_with('-');
    at = left ? 1 : 0;
    for (; at < spec.size() && is_digit(spec[at]); ++at) width = width * 10 + static_cast<std::size_t>(spec[at] - '0');
    if (at < spec.size() && spec[at] == '.')
        for (precision = 0, ++at; at < spec.size() && is_digit(spec[at]); ++at)
            precision = precision * 10 + static_cast<std::size_t>(spec[at] - '0');
    if (at != spec.size()) luaL_error(lua, "string.format: %%s takes '-', a width and a precision only");
    const std::string_view text = shown.view().substr(0, precision);
    const std::size_t fill = width > text.size() ? width - text.size() : 0;
    for (std::size_t i = 0; !left && i < fill; ++i) out.append(' ');
    out.append(text);
    for (std::size_t i = 0; left && i < fill; ++i) out.append(' ');
}

int format(lua_State* lua)
{
    const std::string_view form = check_text(lua, 1);
    Text out;
    int argument = 1;
    for (std::size_t at = 0; at < form.size() && out.fits();)
    {
        const char c = form[at++];
        if (c != '%' || (at < form.size() && form[at] == '%'))
        {
            out.append(c);
            at += c == '%' ? 1 : 0;
            continue;
        }
        Conversion conversion;
        const bool good = read_conversion(form, at, conversion);
        if (good && conversion.letter == 's')
            append_padded(lua, conversion, ++argument, out);
        else if (good && std::string_view("dixXoeEfFgGaA").find(conversion.letter) != std::string_view::npos)
            append_number(lua, conversion, ++argument, out);
        else
            return luaL_error(lua,
                              "string.format knows %%d i x X o e E f F g G a A s with two digits of width and "
                              "precision");
    }
    push_text(lua, out);
    return 1;
}

constexpr NativeFunction kStringFunctions[] = {{"byte", bytes_of, "(text, from, to)", "codes of the bytes"},
                                               {"char", text_of_bytes, "(code, ...)", "the text of these bytes"},
                                               {"format", format, "(form, ...)", "as printf does; no patterns"},
                                               {"len", length_of, "(text)", "bytes"},
                                               {"lower", lower, "(text)", "in small letters"},
                                               {"rep", repeat, "(text, n, between)", "n times"},
                                               {"sub", part, "(text, from, to)", "the substring; negative positions count from the end"},
                                               {"upper", upper, "(text)", "in capitals"}};

}  // namespace

NativeGroup string_group() { return {"string.", kStringFunctions}; }

/// Strings find their methods in the same read-only library; scripts cannot reach their metatable.
void open_string(lua_State* lua)
{
    lua_newtable(lua);
    add_functions(lua, kStringFunctions);
    freeze_table(lua, -1);
    lua_pushliteral(lua, "");
    lua_createtable(lua, 0, 1);
    lua_pushvalue(lua, -3);
    lua_setfield(lua, -2, "__index");
    lua_setmetatable(lua, -2);
    lua_pop(lua, 1);
    lua_setfield(lua, -2, "string");
}

}  // namespace plab::scripts
