/// Script/Lua: an interaction written in Lua.
///
///   drive(step)      once per step: may change its declared state, set parameters, emit events
///   force(t, state)  at every solver stage: adds forces (N), torques (N m) and rates (of quantities) to driven and
///                    between; pure
///
/// Everything that survives a call is in the columns below. Prepare builds the Lua machine from them, and the machine holds
/// nothing that would have to be saved (see README.md).
#pragma once

#include <memory>
#include <string>

#include "lua/machine.h"
#include "plab/context.h"
#include "plab/result.h"
#include "plab/schema.h"
#include "plab/tables.h"
#include "plab/wrenches.h"

namespace plab::scripts
{

struct ScriptRows
{
    Column<std::string> code;
    Column<Entries> parameters;
    Column<std::int64_t> instruction_budget;  // per call
    Column<std::int64_t> memory_limit;        // bytes

    Column<Entries> state;
    Column<std::int64_t> random_state;  // 0: not seeded yet
    Column<bool> quarantined;

    Column<std::int64_t> instructions_used;  // most in one call of the step
    Column<std::int64_t> memory_used;        // bytes at the end of the step

    Column<Ref> driver, driven;
    Column<RefList> between;
    Column<std::unique_ptr<Machine>> machine;

    void describe(Schema& schema);
};

/// Builds the machine again. If that fails, the old one is kept.
Result<void> prepare(const StepContext& context, Row row, ScriptRows& rows);
void drive(const StepContext& context, Rows which, ScriptRows& rows, const Bodies& bodies, const Shafts& shafts,
           const Quantities& quantities);
void force(const StepContext& context, Rows which, const ScriptRows& rows, const Bodies& bodies, const Shafts& shafts,
           const Quantities& quantities, Wrenches& wrenches);
/// Records what force could not: outputs, and the quarantine of a script that failed in it.
void finish(const StepContext& context, Rows which, ScriptRows& rows);

}  // namespace plab::scripts
