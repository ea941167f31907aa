#include "plab/plugin.h"

#include "script.h"

PLAB_PLUGIN("scripts", registrar)
{
    using namespace plab;
    registrar.component<scripts::ScriptRows>("Script/Lua", "an interaction written in Lua")
        .command<scripts::prepare>(Phase::Prepare, "Script/Prepare", "reads the code and runs it once")
        .command<scripts::drive>(Phase::Drive, "Script/Drive", "calls drive(step)")
        .command<scripts::force>(Phase::Force, "Script/Force", "calls force(t, state) and adds its forces")
        .command<scripts::finish>(Phase::Finish, "Script/Finish", "records outputs and failures")
        .cost("one call of Lua per step and per solver stage; about 0.3 microseconds plus 10 ns per instruction")
        .limits("trusted but fallible code: a sandbox against mistakes, not against attackers");
}
