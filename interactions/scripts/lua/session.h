/// What the functions that a script can call see of their machine. For the files of this folder that know Lua.
#pragma once

#include <string_view>
#include <vector>

#include <lua.hpp>

#include "lua/arena.h"
#include "lua/call.h"
#include "lua/limits.h"
#include "lua/meter.h"

namespace plab::scripts
{

/// The longest text that a script can make. Lua compares, hashes and converts texts in single instructions, so their
/// length must be bounded for an instruction to have a bounded cost.
inline constexpr std::size_t kLongestText = 4096;
/// Loading may take so many budgets: it may build tables for the calls to come.
inline constexpr std::int64_t kLoadFactor = 10;
/// What Lua calls the code in its messages: "code:3: ...".
inline constexpr const char* kChunkName = "=code";

/// A value of a local that functions share, as it was after loading.
struct Watch
{
    int function = 0;  ///< stack index of a function that holds the local
    int upvalue = 0;
    int type = LUA_TNIL;
    bool integer = false;
    std::uint64_t bits = 0;
};

/// Where things stand on the machine's stack between calls.
enum StackSlot : int
{
    kDriveSlot = 1,
    kForceSlot,
    kStateSlot,
    kStepSlot,
    kFirstWatchedSlot,
};

/// Where things stand in Lua's registry.
enum RegistrySlot : int
{
    kVectorMeta = LUA_RIDX_LAST + 1,
    kRotationMeta,
    kParticipantMeta,
    kEntriesMeta,
    kStepMeta,
    kStep,
    kGlobals,  ///< what the script sees as globals, behind a proxy
    kDriver,
    kDriven,
    kBetween,  ///< the list behind `between`
    kPinned,   ///< watched values: kept, so that no other can take their address
    kStringLibrary,
};

struct Session
{
    explicit Session(const Limits& l) : limits(l), arena(l.memory) {}

    Limits limits;
    Arena arena;
    Meter meter;
    lua_State* lua = nullptr;
    const Call* call = nullptr;  ///< null between calls
    int refused_at = -1;         ///< line at which memory was refused last
    bool text_refused = false;   ///< ... because one text was too long
    std::vector<Action> actions;
    std::vector<Watch> watches;
    Ref driver, driven;  ///< participants as the script's objects know them
    RefList between;
    std::string_view code;  ///< while loading
};

inline Session& session_of(lua_State* lua) { return **static_cast<Session**>(lua_getextraspace(lua)); }

/// The count hook: ends a call that is over its budget, again and again until it is left.
void count_hook(lua_State* lua, lua_Debug* at);

/// Books work that Lua's own counting does not see. Raises an error when the call is doomed.
void charge(lua_State* lua, std::int64_t instructions);

/// Lets no pcall keep a doomed call alive. `status` and the error on top of the stack come from lua_pcall.
void rethrow_if_doomed(lua_State* lua, int status);

/// The call that runs; raises an error when `what` cannot be used while loading.
const Call& running_call(lua_State* lua, const char* what);

}  // namespace plab::scripts
