#include "lua/session.h"

namespace plab::scripts
{
namespace
{

/// Passing on n of them takes the time of n instructions but counts as one.
constexpr int kMostArguments = 250;

/// Raises the error that ends the call, prefixed with the source position of stack level `level`.
int end_call(lua_State* lua, int level)
{
    const Session& session = session_of(lua);
    luaL_where(lua, level);
    if (session.meter.why() == Meter::Doom::Interrupted)
        lua_pushliteral(lua, "the step is given up");
    else if (session.meter.why() == Meter::Doom::Traffic)
        lua_pushliteral(lua, "too much memory is requested in one call");
    else
        lua_pushfstring(lua, "over the budget of %I instructions", static_cast<lua_Integer>(session.meter.budget()));
    lua_concat(lua, 2);
    return lua_error(lua);
}

int refuse_arguments(lua_State* lua)
{
    luaL_where(lua, 0);
    lua_pushfstring(lua, "more than %d variable arguments", kMostArguments);
    lua_concat(lua, 2);
    return lua_error(lua);
}

}  // namespace

void count_hook(lua_State* lua, lua_Debug* at)
{
    if (lua_getlocal(lua, at, -(kMostArguments + 1))) refuse_arguments(lua);
    Meter& meter = session_of(lua).meter;
    if (const Call* call = session_of(lua).call; call->context && call->context->interrupted()) meter.doom(Meter::Doom::Interrupted);
    if (!meter.doomed() && meter.count_stride())
    {
        const int before = meter.stride();
        if (meter.next_stride() != before) lua_sethook(lua, count_hook, LUA_MASKCOUNT, meter.stride());
        return;
    }
    lua_sethook(lua, count_hook, LUA_MASKCOUNT, 1);
    end_call(lua, 0);
}

void charge(lua_State* lua, std::int64_t instructions)
{
    Meter& meter = session_of(lua).meter;
    if (meter.spend(instructions)) return;
    lua_sethook(lua, count_hook, LUA_MASKCOUNT, 1);
    end_call(lua, 1);
}

void rethrow_if_doomed(lua_State* lua, int status)
{
    Session& session = session_of(lua);
    if (status == LUA_ERRMEM) session.meter.doom(session.text_refused ? Meter::Doom::Text : Meter::Doom::Memory);
    if (!session.meter.doomed()) return;
    lua_sethook(lua, count_hook, LUA_MASKCOUNT, 1);
    lua_error(lua);
}

const Call& running_call(lua_State* lua, const char* what)
{
    const Call& call = *session_of(lua).call;
    if (call.entry == EntryPoint::Load) luaL_error(lua, "%s can be used in drive and force, not while the code is loaded", what);
    return call;
}

}  // namespace plab::scripts
