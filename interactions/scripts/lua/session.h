/// The part of a machine that the functions callable by a script can see. Only for the files of this folder that use Lua.
#pragma once

#include <string_view>
#include <vector>

#include <lua.hpp>

#include "lua/arena.h"
#include "lua/call.h"
#include "lua/meter.h"

namespace plab::scripts
{

/// The longest string that a script can create. Lua compares, hashes and converts strings in single instructions, so their
/// length must be bounded for instructions to have a bounded cost.
inline constexpr std::size_t kLongestText = 4096;
/// Loading may use this many budgets, as it may build tables for later calls.
inline constexpr std::int64_t kLoadFactor = 10;
/// The name of the code in Lua's messages: "code:3: ...".
inline constexpr const char* kChunkName = "=code";

/// The value of a shared local after loading.
struct Watch
{
    int function = 0;  ///< stack index of a function that holds the local
    int upvalue = 0;
    int type = LUA_TNIL;
    bool integer = false;
    std::uint64_t bits = 0;
};

/// The layout of the machine's stack between calls.
enum StackSlot : int
{
    kDriveSlot = 1,
    kForceSlot,
    kStateSlot,
    kStepSlot,
    kFirstWatchedSlot,
};

/// The layout of Lua's registry.
enum RegistrySlot : int
{
    kVectorMeta = LUA_RIDX_LAST + 1,
    kRotationMeta,
    kParticipantMeta,
    kEntriesMeta,
    kStepMeta,
    kStep,
    kGlobals,  ///< the script's globals, behind a proxy
    kDriver,
    kDriven,
    kBetween,  ///< the list behind `between`
    kPinned,   ///< watched values: kept alive, so that no other value can take their address
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
    int refused_at = -1;         ///< line at which memory was last refused
    bool text_refused = false;   ///< whether that was because a string was too long
    std::vector<Action> actions;
    std::vector<Watch> watches;
    Ref driver, driven;  ///< participants, as the objects of the script refer to them
    RefList between;
    std::string_view code;  ///< while loading
};

inline Session& session_of(lua_State* lua) { return **static_cast<Session**>(lua_getextraspace(lua)); }

/// The count hook: ends a call that is over its budget, repeatedly until the call returns.
void count_hook(lua_State* lua, lua_Debug* at);

/// Charges work that Lua's own counting does not see. Raises an error if the call exceeds its budget.
void charge(lua_State* lua, std::int64_t instructions);

/// Rethrows errors that no pcall may catch. `status` and the error on top of the stack come from lua_pcall.
void rethrow_if_doomed(lua_State* lua, int status);

/// The present call; raises an error if `what` cannot be used while loading.
const Call& running_call(lua_State* lua, const char* what);

}  // namespace plab::scripts
