/// Tables in order, and what loading made, made constant.
#pragma once

#include "lua/session.h"

namespace plab::scripts
{

/// Pushes a list of the keys of the (unfrozen) table at `index`: numbers ascending, then texts by bytes. Keys of other
/// types are left out; `others` says whether there were any. Returns the length of the list.
int push_ordered_keys(lua_State* lua, int index, bool& others);

bool is_frozen(lua_State* lua, int index);
/// Pushes the table itself, or what stands behind a frozen one. The argument must be a table.
void push_content(lua_State* lua, int argument);
/// The table at `argument` if it can be changed; an error otherwise.
void check_changeable(lua_State* lua, int argument);

/// Moves the content of the table at `index` behind a proxy that only reads; the table keeps its identity.
void freeze_table(lua_State* lua, int index);

/// Freezes all tables that the functions in the globals table at `index` can reach, and watches all locals that such
/// functions share. Pushes a list of the functions to be pinned to the stack from kFirstWatchedSlot on; returns their
/// number.
int freeze_reachable(lua_State* lua, int globals);

/// The name of a watched local that changed, or null. Functions are on the stack as freeze_reachable said.
const char* find_changed_local(lua_State* lua, const Session& session);

}  // namespace plab::scripts
