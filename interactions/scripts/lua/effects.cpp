// The effects of a script other than forces: parameters and events.
#include <cmath>

#include "lua/native.h"

namespace plab::scripts
{
namespace
{

constexpr lua_Integer kEffectCost = 50;
constexpr int kMostFigures = 16;

/// The present call, if it may have effects; otherwise an error that `what` cannot be used.
const Call& effective_call(lua_State* lua, const char* what)
{
    charge(lua, kEffectCost);
    const Call& call = running_call(lua, what);
    if (call.entry != EntryPoint::Drive) luaL_error(lua, "%s is for drive(step): force(t, state) must be pure", what);
    return call;
}

std::string checked_string(lua_State* lua, int argument)
{
    const std::string_view text = check_text(lua, argument);
    luaL_argcheck(lua, is_utf8(text), argument, "must be UTF-8 text");
    return std::string(text);
}

Value checked_value(lua_State* lua, int argument)
{
    switch (lua_type(lua, argument))
    {
        case LUA_TBOOLEAN:
            return lua_toboolean(lua, argument) != 0;
        case LUA_TNUMBER:
            luaL_argcheck(lua, std::isfinite(lua_tonumber(lua, argument)), argument, "must be finite");
            return lua_tonumber(lua, argument);
        case LUA_TSTRING:
            return checked_string(lua, argument);
        default:
            break;
    }
    const Vec3* v = to_vector(lua, argument);
    if (!v) luaL_typeerror(lua, argument, "number, truth value, text or vec");
    luaL_argcheck(lua, is_finite(*v), argument, "must be finite");
    return *v;
}

int set_parameter(lua_State* lua)
{
    const Call& call = effective_call(lua, "set");
    ParameterChange change{checked_string(lua, 1), checked_string(lua, 2), checked_value(lua, 3)};
    if (!call.context->changes) return luaL_error(lua, "set cannot be used: the host accepts no changes in this call");
    call.context->changes->push_back(std::move(change));
    return 0;
}

bool is_event_kind(std::string_view kind)
{
    if (kind.empty() || kind.size() > 64) return false;
    for (const char c : kind)
        if (!((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.' || c == '_')) return false;
    return true;
}

int emit_event(lua_State* lua)
{
    const Call& call = effective_call(lua, "emit");
    std::string kind = checked_string(lua, 1);
    luaL_argcheck(lua, is_event_kind(kind), 1, "must be a word of a-z, 0-9, '.' and '_'");
    std::string message = lua_isnoneornil(lua, 2) ? std::string() : checked_string(lua, 2);
    const int figures = lua_gettop(lua) - 2;
    luaL_argcheck(lua, figures <= kMostFigures, 2 + kMostFigures, "too many numbers");
    std::vector<double> values;
    for (int i = 0; i < figures; ++i)
    {
        values.push_back(luaL_checknumber(lua, 3 + i));
        luaL_argcheck(lua, std::isfinite(values.back()), 3 + i, "must be finite");
    }
    call.context->emit(call.row, std::move(kind), Severity::Info, std::move(message), std::move(values));
    return 0;
}

int print(lua_State* lua)
{
    charge(lua, kEffectCost);
    const Call& call = *session_of(lua).call;
    if (call.entry == EntryPoint::Force) return luaL_error(lua, "print is for drive(step): force(t, state) must be pure");
    Text line;
    for (int i = 1; i <= lua_gettop(lua) && line.fits(); ++i)
    {
        if (i > 1) line.append('\t');
        append_shown(lua, i, line);
    }
    if (!line.fits() || !is_utf8(line.view()))
        return luaL_error(lua, "print: must be UTF-8 text of at most %I bytes", static_cast<lua_Integer>(kLongestText));
    call.context->emit(call.row, "script.print", Severity::Info, std::string(line.view()));
    return 0;
}

constexpr NativeFunction kEffectFunctions[] = {
    {"set", set_parameter, "(id, name, value)", "in drive: asks for a parameter of any component to be set when the drive phase is over"},
    {"emit", emit_event, "(kind, message, numbers...)", "in drive: an event of that kind, with values"},
    {"print", print, "(...)", "in drive: the event script.print"}};

}  // namespace

NativeGroup effects_group() { return {"", kEffectFunctions}; }

void open_effects(lua_State* lua) { add_functions(lua, kEffectFunctions); }

}  // namespace plab::scripts
