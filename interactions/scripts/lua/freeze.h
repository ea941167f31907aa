/// Ordered traversal of tables, and freezing of everything that was created while loading.
///
/// What a function of the script can see again in a later call is: globals, the locals outside it that it uses (Lua's upvalues), and
/// whatever these refer to. Starting from the globals, freeze_reachable() walks this graph once, after loading. Each table on the way
/// becomes an empty table with a metatable, whose __index is a copy of the content, and whose __newindex refuses. The table itself stays
/// where it is, so that all references to it remain valid. Upvalues cannot be made constant in Lua; they are compared with their value at
/// load after each call, bit by bit, by the address of what they refer to. Those values are pinned in the registry, as otherwise a new
/// value could take the address of one that was collected. The copies are filled in the order of their keys, because the layout of a Lua
/// table, and with it the length of one with holes, depends on the order of insertion, and that of strings on a seed that differs from run
/// to run.
#pragma once

#include "lua/session.h"

namespace plab::scripts
{

/// Pushes a list of the keys of the (unfrozen) table at `index`: numbers ascending, then strings by bytes. Keys of other types
/// are left out; `others` reports whether there were any. Returns the length of the list.
int push_ordered_keys(lua_State* lua, int index, bool& others);

bool is_frozen(lua_State* lua, int index);
/// Pushes the table itself, or the content behind a frozen one. The argument must be a table.
void push_content(lua_State* lua, int argument);
/// The table at `argument` if it can be changed; raises an error otherwise.
void check_changeable(lua_State* lua, int argument);

/// Moves the content of the table at `index` behind a read-only proxy; the table keeps its identity.
void freeze_table(lua_State* lua, int index);

/// Freezes all tables that the functions in the globals table at `index` can reach, and watches all locals that these functions
/// share. Pushes a list of the functions to be pinned to the stack from kFirstWatchedSlot on; returns their number.
int freeze_reachable(lua_State* lua, int globals);

/// The name of a watched local that has changed, or null. The functions must be on the stack as described for freeze_reachable.
const char* find_changed_local(lua_State* lua, const Session& session);

}  // namespace plab::scripts
