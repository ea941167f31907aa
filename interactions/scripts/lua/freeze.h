/// Ordered traversal of tables, and freezing of everything that was created while loading.
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
