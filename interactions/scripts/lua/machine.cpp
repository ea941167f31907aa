#include "lua/machine.h"

#include <algorithm>
#include <utility>

#include "lua/freeze.h"
#include "lua/native.h"

namespace plab::scripts
{
namespace
{

/// Notes the line being executed, so that an out-of-memory error can name it: Lua's own does not.
void note_line(Session& session)
{
    lua_Debug at;
    session.refused_at = -1;
    if (!session.lua) return;
    for (int level = 0; lua_getstack(session.lua, level, &at); ++level)
    {
        lua_getinfo(session.lua, "l", &at);
        session.refused_at = at.currentline;
        if (at.currentline > 0) return;
    }
}

void end_soon(Session& session)
{
    if (session.lua) lua_sethook(session.lua, count_hook, LUA_MASKCOUNT, 1);
}

/// Lua's allocator. On a refusal Lua collects all garbage and asks once more; the meter bounds how often that happens in a call.
void* reallocate(void* user, void* piece, std::size_t old_size, std::size_t size)
{
    auto& session = *static_cast<Session*>(user);
    if (size == 0) return session.arena.release(piece, old_size), nullptr;
    // For a new object, Lua passes its type as the old size.
    constexpr std::size_t kTextHeader = 64;
    const bool long_text = !piece && old_size == LUA_TSTRING && size > kLongestText + kTextHeader;
    void* result = nullptr;
    if (!long_text) result = piece ? session.arena.resize(piece, old_size, size) : session.arena.allocate(size);
    const std::size_t moved = result ? (piece && size < old_size ? 0 : size) : session.arena.used();
    if (!session.meter.move(moved)) end_soon(session);
    if (!result)
    {
        session.text_refused = long_text;
        note_line(session);
    }
    return result;
}

/// A proxy with __index = G that can be written to only while loading; the script sees it as `_ENV`.
int assign_global(lua_State* lua)
{
    if (session_of(lua).call->entry == EntryPoint::Load)
    {
        lua_rawset(lua, lua_upvalueindex(1));
        return 0;
    }
    const char* name = lua_type(lua, 2) == LUA_TSTRING ? lua_tostring(lua, 2) : type_name(lua, 2);
    return luaL_error(lua, "global '%s' cannot be assigned: values that live across steps belong in `state`", name);
}

void push_environment(lua_State* lua, int globals)
{
    lua_newtable(lua);
    lua_createtable(lua, 0, 2);
    lua_pushvalue(lua, globals);
    lua_setfield(lua, -2, "__index");
    lua_pushvalue(lua, globals);
    lua_pushcclosure(lua, assign_global, 1);
    lua_setfield(lua, -2, "__newindex");
    lua_setmetatable(lua, -2);
}

void push_entry_point(lua_State* lua, int globals, const char* name)
{
    lua_pushstring(lua, name);
    const int type = lua_rawget(lua, globals);
    if (type != LUA_TFUNCTION && type != LUA_TNIL) luaL_error(lua, "%s must be a function, not a %s", name, type_name(lua, -1));
}

/// Creates the environment of the script, runs its code, and leaves the values listed in StackSlot on the stack.
int build(lua_State* lua)
{
    Session& session = session_of(lua);
    lua_newtable(lua);
    const int globals = lua_gettop(lua);
    lua_pushvalue(lua, globals);
    lua_rawseti(lua, LUA_REGISTRYINDEX, kGlobals);
    open_base(lua);
    open_effects(lua);
    open_math(lua);
    open_string(lua);
    open_table(lua);
    open_vectors(lua);
    open_records(lua);
    open_participants(lua);
    bind_participants(lua, *session.call);

    if (luaL_loadbufferx(lua, session.code.data(), session.code.size(), kChunkName, "t") != LUA_OK) return lua_error(lua);
    push_environment(lua, globals);
    lua_setupvalue(lua, -2, 1);
    lua_call(lua, 0, 0);

    const int functions = globals + 1;
    const int count = freeze_reachable(lua, globals);
    luaL_checkstack(lua, count + 16, "too many functions share locals");
    push_entry_point(lua, globals, "drive");
    push_entry_point(lua, globals, "force");
    if (lua_isnil(lua, -1) && lua_isnil(lua, -2)) return luaL_error(lua, "neither drive(step) nor force(t, state) is defined");
    lua_pushliteral(lua, "state");
    lua_rawget(lua, globals);
    lua_rawgeti(lua, LUA_REGISTRYINDEX, kStep);
    for (int i = 1; i <= count; ++i) lua_rawgeti(lua, functions, i);
    return kFirstWatchedSlot - 1 + count;
}

int bind_again(lua_State* lua)
{
    bind_participants(lua, *session_of(lua).call);
    return 0;
}

/// Turns "code:3: ..." of Lua into "line 3: ...".
std::string as_load_error(const std::string& message)
{
    const std::string prefix = std::string(kChunkName + 1) + ":";
    return message.starts_with(prefix) ? "line " + message.substr(prefix.size()) : message;
}

/// Makes the present call known to the native functions through `session`, for the lifetime of this object.
class Running
{
public:
    Running(Session& session, const Call& call, std::int64_t budget) : session_(session)
    {
        session.call = &call;
        session.actions.clear();
        session.text_refused = false;
        session.refused_at = -1;
        session.meter.start(budget);
        lua_sethook(session.lua, count_hook, LUA_MASKCOUNT, session.meter.stride());
    }
    ~Running() { session_.call = nullptr; }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

private:
    Session& session_;
};

struct Report
{
    std::string kind, message;
};

/// The reason for which a call ended with `status` and the error on top of the stack.
Report explain(Session& session, int status)
{
    lua_State* lua = session.lua;
    const auto at = [&]
    { return session.refused_at > 0 ? std::string(kChunkName + 1) + ":" + std::to_string(session.refused_at) + ": " : std::string(); };
    const std::string said = lua_type(lua, -1) == LUA_TSTRING ? std::string(lua_tostring(lua, -1), lua_rawlen(lua, -1))
                                                              : "the error is a " + std::string(type_name(lua, -1)) + ", not a text";
    using Doom = Meter::Doom;
    if (status == LUA_ERRMEM) session.meter.doom(session.text_refused ? Doom::Text : Doom::Memory);
    switch (session.meter.why())
    {
        case Doom::Instructions:
        case Doom::Traffic:
        case Doom::Interrupted:
            return {"script.over_budget", said};
        case Doom::Memory:
            return {"script.out_of_memory", at() + "more than memory_limit = " + std::to_string(session.arena.capacity()) + " bytes"};
        case Doom::Text:
            return {"script.out_of_memory", at() + "a text of more than " + std::to_string(kLongestText) + " bytes"};
        case Doom::None:
            break;
    }
    return {"script.error", is_utf8(said) ? said : "the error's text is not UTF-8"};
}

}  // namespace

Machine::Machine(const Limits& limits) : session_(std::make_unique<Session>(limits)) {}
/// Without finalizers there is nothing to close: the arena is freed as a whole.
Machine::~Machine() = default;

Result<void> Machine::load(const std::string& code, const Call& call)
{
    Session& s = *session_;
    s.lua = nullptr;
    s.arena.clear();
    s.watches.clear();
    s.meter.start(s.limits.instructions);
    failure_.reset();
    lua_State* lua = lua_newstate(reallocate, &s);
    if (!lua) return reason("memory_limit = " + std::to_string(s.arena.capacity()) + " bytes is too little for any script");
    s.lua = lua;
    *static_cast<Session**>(lua_getextraspace(lua)) = &s;

    const Running running(s, call, s.limits.instructions * kLoadFactor);
    s.code = code;
    lua_pushcfunction(lua, build);
    const int status = lua_pcall(lua, 0, LUA_MULTRET, 0);
    s.code = {};
    if (status == LUA_OK) return {};
    const Report why = explain(s, status);
    fail(call, why.kind, why.message);
    return reason(as_load_error(why.message));
}

bool Machine::has_drive() const { return !failure_ && !lua_isnil(session_->lua, kDriveSlot); }
bool Machine::has_force() const { return !failure_ && !lua_isnil(session_->lua, kForceSlot); }

bool Machine::drive(const Call& call)
{
    Session& s = *session_;
    const std::size_t changes = call.context->changes ? call.context->changes->size() : 0;
    const std::int64_t random_state = *call.random_state;
    state_before_ = *call.state;
    const Running running(s, call, s.limits.instructions);
    bool done = bind(call);
    if (done)
    {
        lua_pushvalue(s.lua, kDriveSlot);
        lua_pushvalue(s.lua, kStepSlot);
        done = run(kDriveSlot, 1, call);
    }
    if (!done) undo(call, changes, random_state);
    return done;
}

bool Machine::force(const Call& call)
{
    Session& s = *session_;
    const Running running(s, call, s.limits.instructions);
    if (!bind(call)) return false;
    lua_pushvalue(s.lua, kForceSlot);
    lua_pushnumber(s.lua, call.context->time);
    lua_pushvalue(s.lua, kStateSlot);
    return run(kForceSlot, 2, call);
}

std::span<const Action> Machine::actions() const { return session_->actions; }

/// The function and its arguments must be on the stack.
bool Machine::run(int function, int arguments, const Call& call)
{
    Session& s = *session_;
    const int status = lua_pcall(s.lua, arguments, 0, 0);
    most_instructions_ = std::max(most_instructions_, s.meter.used());
    if (status != LUA_OK)
    {
        const Report why = explain(s, status);
        lua_pop(s.lua, 1);
        fail(call, why.kind, why.message);
        return false;
    }
    const char* changed = find_changed_local(s.lua, s);
    if (!changed) return true;
    const char* name = function == kDriveSlot ? "drive" : "force";
    fail(call, "script.error",
         std::string("code: local '") + changed + "' was changed by " + name + ": values that live across steps belong in `state`");
    return false;
}

bool Machine::bind(const Call& call)
{
    Session& s = *session_;
    if (s.driver == call.driver && s.driven == call.driven && s.between == *call.between) return true;
    lua_pushcfunction(s.lua, bind_again);
    const int status = lua_pcall(s.lua, 0, 0, 0);
    if (status == LUA_OK) return true;
    const Report why = explain(s, status);
    lua_pop(s.lua, 1);
    fail(call, why.kind, why.message);
    return false;
}

void Machine::undo(const Call& call, std::size_t changes, std::int64_t random_state)
{
    *call.writable_state = state_before_;
    *call.random_state = random_state;
    if (call.context->changes)
        call.context->changes->erase(call.context->changes->begin() + static_cast<std::ptrdiff_t>(changes), call.context->changes->end());
}

void Machine::fail(const Call& call, std::string kind, std::string message)
{
    session_->actions.clear();
    Failure& failure = failure_.emplace();
    failure.kind = std::move(kind), failure.message = std::move(message);
    failure.tick = call.context->tick, failure.time = call.context->time;
    // An interrupted step is discarded, so this does not count as a failure; but the machine may have stopped anywhere and is
    // built again.
    failure.reported = failure.booked = session_->meter.why() == Meter::Doom::Interrupted;
}

std::int64_t Machine::take_instructions() { return std::exchange(most_instructions_, 0); }
std::size_t Machine::memory_used() const { return session_->arena.used(); }

}  // namespace plab::scripts
